"""Options for compiled kernels, and helpers to run work in threads and processes.

Kernels release the GIL. They copy, add and sort with loops, because slice assignments, array
additions or `numpy.sort` in a kernel make its first compilation a second slower.

numba caches compiled functions beside the sources, or else in the user's cache folder. It fails if
it can write to neither, as in a container with packages of another user. `choose_numba_cache` sets
a temporary folder then.
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
"""Number of rows below which starting a thread takes longer than the work."""
OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
VARIABLE = "NUMBA_CACHE_DIR"
COMPILING = "compiling, the first time only"
"""Message during the first compilation, which takes up to half a minute."""
_here = local()
_ask: ContextVar[Callable[[], None] | None] = ContextVar("ask", default=None)
_say: ContextVar[Callable[[str], None] | None] = ContextVar("say", default=None)
Item = TypeVar("Item")
Result = TypeVar("Result")


@contextmanager
def cancellable(ask: Callable[[], None] | None) -> Iterator[None]:
    """Call ``ask`` regularly during the block; an exception that it raises cancels the work."""
    before = _ask.set(ask)
    try:
        yield
    finally:
        _ask.reset(before)


def check_cancelled() -> None:
    """Call the function set by `cancellable`, if any."""
    if (ask := _ask.get()) is not None:
        ask()


@contextmanager
def announce_to(say: Callable[[str], None]) -> Iterator[None]:
    """Pass messages of `announce` to ``say`` during the block."""
    before = _say.set(say)
    try:
        yield
    finally:
        _say.reset(before)


def announce(progress: str) -> None:
    """Report progress to the function set by `announce_to`, if any."""
    if (say := _say.get()) is not None:
        say(progress)


def map_threads(function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
    """Return ``[function(item) for item in items]``, computed by all available cores.

    Checks for cancellation before each item. Nested calls run in the calling thread, since all
    cores are busy.
    """
    items, ask = list(items), _ask.get()
    # A thread of the pool must not wait for others of the pool: deadlock.
    if count_threads() == 1 or len(items) == 1 or getattr(_here, "of_pool", False):
        results = []
        for item in items:
            check_cancelled()
            results.append(function(item))
        return results

    def run(item: Item) -> Result:
        with cancellable(ask):  # context variables are not inherited by threads
            check_cancelled()
            return function(item)

    pool = _get_pool()
    try:
        return list(pool.map(run, items))
    except KeyboardInterrupt:
        # Discard the pool: a thread that was just starting would keep the program alive.
        _get_pool.cache_clear()
        pool.shutdown(wait=False, cancel_futures=True)
        raise


def make_even_slices(n: int) -> list[slice]:
    """Split ``range(n)`` into equal slices, a few per core, with at least `SHORT` rows."""
    # A few parts per core balance uneven work; `-(-n // SHORT)` rounds up.
    parts = min(2 * count_threads(), -(-n // SHORT))
    edges = [n * part // parts for part in range(parts + 1)] if parts else []
    return [slice(a, b) for a, b in pairwise(edges)]


@cache
def count_threads() -> int:
    """Return the number of cores for this process; ``KINEME_THREADS`` overrides it."""
    setting = os.environ.get("KINEME_THREADS", "")
    if setting.isdigit() and int(setting):
        return int(setting)
    affinity = getattr(os, "sched_getaffinity", None)  # not on every system
    return len(affinity(0)) if affinity else os.cpu_count() or 1


@cache
def _get_pool() -> ThreadPoolExecutor:
    from concurrent.futures import ThreadPoolExecutor

    def initialize() -> None:
        _here.of_pool = True

    return ThreadPoolExecutor(count_threads(), thread_name_prefix="kineme", initializer=initialize)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_get_pool.cache_clear)  # threads do not survive a fork


def make_process_pool(processes: int, imports: Sequence[str] = ()) -> ProcessPoolExecutor:
    """Return a pool of processes that share the cores, preload modules and exit with this one."""
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
    """Return the multiprocessing context: fork server on Linux, else spawn.

    A plain fork could deadlock on locks of threads that the child lacks. The fork server has no
    threads, and preloads modules for all processes. It ignores Ctrl+C, which this process handles,
    so that not every child prints a traceback.
    """
    from multiprocessing import forkserver, get_context, resource_tracker

    if sys.platform != "linux":
        return get_context("spawn")
    context = get_context("forkserver")
    context.set_forkserver_preload([*imports])
    resource_tracker.ensure_running()  # unblocks signals, so it must come first
    old_mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, old_mask)
    return context


@contextmanager
def defer_interrupt() -> Iterator[None]:
    """Delay Ctrl+C until the end of the block, in which a process is started."""
    if threading.current_thread() is not threading.main_thread():  # receives no signals
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
    """Limit a worker's threads; exit when the parent process dies."""
    from multiprocessing import parent_process
    from multiprocessing.connection import wait

    # Read by `count_threads` in the worker.
    os.environ["KINEME_THREADS"] = str(threads)
    parent = parent_process()
    if parent is not None:
        sentinel = parent.sentinel

        def watch() -> None:
            # The sentinel becomes ready when the parent ends for any reason.
            wait([sentinel])
            os._exit(1)

        threading.Thread(target=watch, daemon=True).start()


@contextmanager
def announce_compilation(say: Callable[[str], None]) -> Iterator[None]:
    """Call ``say`` once before the first uncached compilation in the block."""
    import numba  # noqa: F401 (waits for imports in other threads, unlike the next line)
    from numba.core.event import Event, Listener, install_listener

    class FirstCompilation(Listener):
        before = False

        def on_start(self, _: Event) -> None:
            if not self.before:
                self.before = True
                say(COMPILING)

        def on_end(self, _: Event) -> None:
            """Ignore the end of a compilation."""

    with install_listener("numba:compile", FirstCompilation()):
        yield


def choose_numba_cache() -> None:
    """Set a temporary cache folder for numba if it has no writable one."""
    beside = Path(__file__).parent / "__pycache__"
    beside = beside if beside.is_dir() else beside.parent  # where it would be created
    if (
        VARIABLE in os.environ
        or os.access(beside, os.W_OK)
        or _is_writable(find_user_cache() / "numba")
    ):
        return
    os.environ[VARIABLE] = folder = _make_temporary_cache()
    loaded: Any = sys.modules.get("numba")
    if loaded is not None:  # it has read the variable already
        loaded.config.CACHE_DIR = folder


def _is_writable(folder: Path) -> bool:
    """Return whether files can be created in a folder; create the folder if missing."""
    probe = folder / f".kineme-{os.getpid()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe.touch()
        probe.unlink()
    except OSError:
        return False
    return True


def find_user_cache() -> Path:
    """Return the user's cache folder of the system."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "~")).expanduser()
    if sys.platform == "darwin":
        return Path("~/Library/Caches").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME", "~/.cache")).expanduser()


def _make_temporary_cache() -> str:
    """Return a temporary folder that only this user can write, since its content is executed."""
    import stat
    import tempfile

    # One folder per user.
    user = os.getuid() if hasattr(os, "getuid") else 0
    folder = Path(tempfile.gettempdir(), f"kineme-{user}")
    folder.mkdir(mode=0o700, exist_ok=True)
    status = folder.lstat()
    private = stat.S_ISDIR(status.st_mode) and status.st_uid == user
    # Another user may have planted the folder: use it only if owned by this user and private.
    if private and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return str(folder)
    return tempfile.mkdtemp(prefix="kineme-")
