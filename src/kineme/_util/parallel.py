"""Compile kernels, and run work in threads and processes.

Kernels release the interpreter's lock. They copy, add and sort with loops: an array assigned to a
slice, an array added to another or `numpy.sort` in one of them makes the first run ever a second
longer.

numba keeps compiled functions beside the sources, else in the user's cache folder. It refuses to
load a function that it can keep in neither, as in a container whose packages belong to another
user. A folder among the temporary ones will do then (`choose_numba_cache`).
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from itertools import pairwise
from pathlib import Path
from threading import local
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
    from multiprocessing.context import BaseContext


SHORT = 50
"""Rows that take no longer than to hand them to a thread."""

_here = local()
_ask: ContextVar[Callable[[], None] | None] = ContextVar("ask", default=None)
_say: ContextVar[Callable[[str], None] | None] = ContextVar("say", default=None)

Item = TypeVar("Item")
Result = TypeVar("Result")


@contextmanager
def cancellable(ask: Callable[[], None] | None) -> Iterator[None]:
    """While the block lasts, its work asks now and then; what ``ask`` raises ends it."""
    before = _ask.set(ask)
    try:
        yield
    finally:
        _ask.reset(before)


def check_cancelled() -> None:
    """Ask whether to go on, where somebody wants to be asked."""
    if (ask := _ask.get()) is not None:
        ask()


@contextmanager
def announce_to(say: Callable[[str], None]) -> Iterator[None]:
    """While the block lasts, what its work announces goes to ``say``."""
    before = _say.set(say)
    try:
        yield
    finally:
        _say.reset(before)


def announce(progress: str) -> None:
    """Say how far long work is, where somebody wants to know."""
    if (say := _say.get()) is not None:
        say(progress)


def map_threads(function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
    """``[function(item) for item in items]`` over the available cores, in the same order.

    Before each it is asked whether to go on. What a function maps in its turn, it does alone: all
    cores are at work.
    """
    items, ask = list(items), _ask.get()

    def one(item: Item) -> Result:
        with cancellable(ask):  # in whichever thread
            check_cancelled()
            return function(item)

    # A thread of the pool must not wait for other threads of the pool.
    if count_threads() == 1 or len(items) == 1 or getattr(_here, "of_pool", False):
        return [one(item) for item in items]
    pool = _get_pool()
    try:
        return list(pool.map(one, items))
    except KeyboardInterrupt:
        # A thread that was just being started would wait for work, and the program for it.
        _get_pool.cache_clear()
        pool.shutdown(wait=False, cancel_futures=True)
        raise


def make_even_slices(n: int, short: int = SHORT) -> list[slice]:
    """``range(n)`` in slices of like size, a few for each core; fewer where these were short."""
    # A few parts for each core even out rows that take longer; division rounded up.
    parts = min(2 * count_threads(), -(-n // short))
    edges = [n * part // parts for part in range(parts + 1)] if parts else []
    return [slice(a, b) for a, b in pairwise(edges)]


@cache
def count_threads() -> int:
    """Cores this process may use; ``KINEME_THREADS`` sets another number."""
    setting = os.environ.get("KINEME_THREADS", "")
    if setting.isdigit() and int(setting):
        return int(setting)
    affinity = getattr(os, "sched_getaffinity", None)  # not on every system
    return len(affinity(0)) if affinity else os.cpu_count() or 1


@cache
def _get_pool() -> ThreadPoolExecutor:
    from concurrent.futures import ThreadPoolExecutor

    def begin() -> None:
        _here.of_pool = True

    return ThreadPoolExecutor(count_threads(), thread_name_prefix="kineme", initializer=begin)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_get_pool.cache_clear)  # threads do not survive a fork


def make_process_pool(processes: int, imports: Sequence[str] = ()) -> ProcessPoolExecutor:
    """So many processes, which share the cores, import these modules and end when this one does."""
    from concurrent.futures import ProcessPoolExecutor

    # All processes together use as many threads as there are cores.
    share = max(1, count_threads() // processes)
    return ProcessPoolExecutor(
        processes,
        mp_context=make_process_context(imports),
        initializer=_prepare_worker,
        initargs=(share,),
    )


def make_process_context(imports: Sequence[str] = ()) -> BaseContext:
    """How processes are started.

    A copy of this one could wait forever for threads that it lacks. Where that can be, they are
    copies of one that has none, and has imported what all need. Ctrl+C is left to this one, which
    ends the others: they would each say where they were.
    """
    from multiprocessing import forkserver, get_context, resource_tracker

    if sys.platform != "linux":
        return get_context("spawn")
    started = get_context("forkserver")
    started.set_forkserver_preload([*imports])
    resource_tracker.ensure_running()  # lets signals through again, so it comes first
    let_through = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, let_through)
    return started


@contextmanager
def defer_interrupt() -> Iterator[None]:
    """Leave Ctrl+C until after the block, in which a process is started: half of one complains."""
    if threading.current_thread() is not threading.main_thread():  # it is not told of any
        yield
        return
    signals: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: signals.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if signals:
        signal.raise_signal(signal.SIGINT)


def _prepare_worker(threads: int) -> None:
    """Make a worker one of several, which ends when the process that started it is gone."""
    from multiprocessing import parent_process
    from multiprocessing.connection import wait

    # Read by `count_threads` in the worker.
    os.environ["KINEME_THREADS"] = str(threads)
    parent = parent_process()
    if parent is not None:
        sentinel = parent.sentinel

        def watch() -> None:
            # Ready when the parent has ended, however it did.
            wait([sentinel])
            os._exit(1)

        threading.Thread(target=watch, daemon=True).start()


OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
VARIABLE = "NUMBA_CACHE_DIR"
COMPILING = "compiling, the first time only"
"""How people are told why nothing seems to go on, for half a minute on a slow machine."""


@contextmanager
def announce_compilation(say: Callable[[str], None]) -> Iterator[None]:
    """While the block lasts, say so before the first kernel is compiled that was never before."""
    import numba  # noqa: F401 (waits for another thread that imports it; the next line would not)
    from numba.core.event import Event, Listener, install_listener

    class Once(Listener):
        before = False

        def on_start(self, _: Event) -> None:
            if not self.before:
                self.before = True
                say(COMPILING)

        def on_end(self, _: Event) -> None:
            """Nothing is to be said."""

    with install_listener("numba:compile", Once()):
        yield


def choose_numba_cache() -> None:
    """Name a folder for compiled functions where numba would find none."""
    beside = Path(__file__).parent / "__pycache__"
    beside = beside if beside.is_dir() else beside.parent  # in which it is made
    if (
        VARIABLE in os.environ
        or os.access(beside, os.W_OK)
        or _is_writable(find_user_cache() / "numba")
    ):
        return
    os.environ[VARIABLE] = folder = _make_temporary_cache()
    loaded: Any = sys.modules.get("numba")
    if loaded is not None:  # it has looked already
        loaded.config.CACHE_DIR = folder


def _is_writable(folder: Path) -> bool:
    """Return whether a file can be left in a folder, which is made if it is not there."""
    probe = folder / f".kineme-{os.getpid()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe.touch()
        probe.unlink()
    except OSError:
        return False
    return True


def find_user_cache() -> Path:
    """Return the folder in which applications keep what they can make again."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "~")).expanduser()
    if sys.platform == "darwin":
        return Path("~/Library/Caches").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME", "~/.cache")).expanduser()


def _make_temporary_cache() -> str:
    """Return a folder of this user alone: what lies there is run."""
    import stat
    import tempfile

    # One folder for each user; what others could write to is not run.
    user = os.getuid() if hasattr(os, "getuid") else 0
    folder = Path(tempfile.gettempdir(), f"kineme-{user}")
    folder.mkdir(mode=0o700, exist_ok=True)
    found = folder.lstat()
    private = stat.S_ISDIR(found.st_mode) and found.st_uid == user
    # The folder may be somebody else's trap: only one of this user, closed to others, is taken.
    if private and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return str(folder)
    return tempfile.mkdtemp(prefix="kineme-")
