"""Running compiled kernels side by side; they release the interpreter's lock.

Between them work asks whether to go on, where somebody wants to be asked (`asking`).
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from itertools import pairwise
from threading import local
from typing import TypeVar

SHORT = 50
"""Rows that take no longer than to hand them to a thread."""

_here = local()
_ask: ContextVar[Callable[[], None] | None] = ContextVar("ask", default=None)

Item = TypeVar("Item")
Result = TypeVar("Result")


@contextmanager
def asking(ask: Callable[[], None] | None) -> Iterator[None]:
    """While the block lasts, its work asks now and then; what ``ask`` raises ends it."""
    before = _ask.set(ask)
    try:
        yield
    finally:
        _ask.reset(before)


def go_on() -> None:
    """Ask whether to go on, where somebody wants to be asked."""
    if (ask := _ask.get()) is not None:
        ask()


def map_threads(function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
    """``[function(item) for item in items]`` over the available cores, in the same order.

    Before each it is asked whether to go on. What a function maps in its turn, it does alone: all
    cores are at work.
    """
    items, ask = list(items), _ask.get()

    def one(item: Item) -> Result:
        with asking(ask):  # in whichever thread
            go_on()
            return function(item)

    if n_threads() == 1 or len(items) == 1 or getattr(_here, "of_pool", False):
        return [one(item) for item in items]
    pool = _pool()
    try:
        return list(pool.map(one, items))
    except KeyboardInterrupt:
        # A thread that was just being started would wait for work, and the program for it.
        _pool.cache_clear()
        pool.shutdown(wait=False, cancel_futures=True)
        raise


def even_slices(n: int, short: int = SHORT) -> list[slice]:
    """``range(n)`` in slices of like size, a few for each core; fewer where these were short."""
    parts = min(2 * n_threads(), -(-n // short))
    edges = [n * part // parts for part in range(parts + 1)] if parts else []
    return [slice(a, b) for a, b in pairwise(edges)]


@cache
def n_threads() -> int:
    """Cores this process may use; ``KINEME_THREADS`` sets another number."""
    setting = os.environ.get("KINEME_THREADS", "")
    if setting.isdigit() and int(setting):
        return int(setting)
    affinity = getattr(os, "sched_getaffinity", None)  # not on every system
    return len(affinity(0)) if affinity else os.cpu_count() or 1


@cache
def _pool() -> ThreadPoolExecutor:
    def begin() -> None:
        _here.of_pool = True

    return ThreadPoolExecutor(n_threads(), thread_name_prefix="kineme", initializer=begin)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.cache_clear)  # threads do not survive a fork
