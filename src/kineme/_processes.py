"""Processes beside this one: started from one without threads, and silent when they are ended."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import forkserver, get_context, parent_process, resource_tracker
from multiprocessing.connection import wait as wait_for
from multiprocessing.context import BaseContext

from kineme._threads import n_threads


def pool_of(processes: int, imports: Sequence[str] = ()) -> ProcessPoolExecutor:
    """So many processes, which share the cores, import these modules and end when this one does."""
    share = max(1, n_threads() // processes)
    return ProcessPoolExecutor(
        processes, mp_context=context(imports), initializer=_prepare, initargs=(share,)
    )


def context(imports: Sequence[str] = ()) -> BaseContext:
    """How processes are started.

    A copy of this one could wait forever for threads that it lacks. Where that can be, they are
    copies of one that has none, and has imported what all need. Ctrl+C is left to this one, which
    ends the others: they would each say where they were.
    """
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
def interrupted_later() -> Iterator[None]:
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


def _prepare(threads: int) -> None:
    """Make a worker one of several, which ends when the process that started it is gone."""
    os.environ["KINEME_THREADS"] = str(threads)
    parent = parent_process()
    if parent is not None:
        sentinel = parent.sentinel

        def watch() -> None:
            wait_for([sentinel])
            os._exit(1)

        threading.Thread(target=watch, daemon=True).start()
