"""How every kernel is compiled, without the interpreter's lock, and where it is kept on disk.

Kernels copy, add and sort with loops: an array assigned to a slice, an array added to another
or `numpy.sort` in one of them makes the first run ever a second longer.

numba keeps compiled functions beside the sources, else in the user's cache folder. It refuses to
load a function that it can keep in neither: in a container, say, whose packages belong to another
user and where nobody is at home. A folder among the temporary ones will do then.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
VARIABLE = "NUMBA_CACHE_DIR"
COMPILING = "compiling, the first time only"
"""How people are told why nothing seems to go on, for half a minute on a slow machine."""


@contextmanager
def telling_of_compiling(say: Callable[[str], None]) -> Iterator[None]:
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


def find_cache() -> None:
    """Name a folder for compiled functions where numba would find none."""
    beside = Path(__file__).parent / "__pycache__"
    beside = beside if beside.is_dir() else beside.parent  # in which it is made
    if VARIABLE in os.environ or os.access(beside, os.W_OK) or _is_writable(_of_user() / "numba"):
        return
    os.environ[VARIABLE] = folder = _temporary()
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


def _of_user() -> Path:
    """Return the folder in which applications keep what they can make again."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "~")).expanduser()
    if sys.platform == "darwin":
        return Path("~/Library/Caches").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME", "~/.cache")).expanduser()


def _temporary() -> str:
    """Return a folder of this user alone: what lies there is run."""
    import stat
    import tempfile

    user = os.getuid() if hasattr(os, "getuid") else 0
    folder = Path(tempfile.gettempdir(), f"kineme-{user}")
    folder.mkdir(mode=0o700, exist_ok=True)
    found = folder.lstat()
    private = stat.S_ISDIR(found.st_mode) and found.st_uid == user
    if private and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return str(folder)
    return tempfile.mkdtemp(prefix="kineme-")
