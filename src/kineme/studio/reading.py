"""Recordings from files: those used last stay in memory, with the warnings reading them gave."""

from __future__ import annotations

import threading
import warnings
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kineme.errors import KinemeWarning, ReadError
from kineme.formats import read
from kineme.recordings.motion import Motion

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.recordings.signals import Signals

MOST_IN_MEMORY = 3
"""Recordings; that of an hour can have most of a gigabyte."""
Stamp = tuple[int, int]

_WARNINGS = threading.Lock()
"""Catching warnings is for the whole process, so that one recording is read at a time."""


@dataclass(frozen=True)
class ReadingOptions:
    """What the files do not say themselves.

    Parameters
    ----------
    keywords : mapping
        For :func:`kineme.read`.
    effectors : mapping, optional
        The names of head, hands and feet, as :func:`kineme.features.end_effectors` takes them.
    """

    keywords: Mapping[str, Any] = field(default_factory=dict)
    effectors: Names | None = None


class RecordingCache:
    """The recordings used last, with the warnings that reading them gave.

    Parameters
    ----------
    options : ReadingOptions
    """

    def __init__(self, options: ReadingOptions) -> None:
        self.options = options
        self._lock = threading.Lock()
        self._reading: dict[tuple[Path, Stamp], threading.Lock] = {}
        self._known: OrderedDict[tuple[Path, Stamp], tuple[Motion | Signals, list[str]]]
        self._known = OrderedDict()

    def read(self, path: Path) -> tuple[Motion | Signals, list[str]]:
        """The recording in a file, read if it is not in memory.

        Parameters
        ----------
        path : Path

        Returns
        -------
        recording : Motion or Signals
        warnings : list of str
            One sentence each.

        Raises
        ------
        ReadError
            The file is gone or cannot be read.
        """
        key = path, stamp_of(path)
        with self._lock:
            reading = self._reading.setdefault(key, threading.Lock())
        with reading:
            with self._lock:
                known = self._known.get(key)
            found = known or _read_quietly(path, self.options.keywords)
            with self._lock:
                self._known[key] = found
                self._known.move_to_end(key)
                while len(self._known) > MOST_IN_MEMORY:
                    self._known.popitem(last=False)
                self._reading.pop(key, None)
        return found


def stamp_of(path: Path) -> Stamp:
    """What changes when a file is written.

    Parameters
    ----------
    path : Path

    Returns
    -------
    tuple of int
        Time of the last change in nanoseconds, and length in bytes.

    Raises
    ------
    ReadError
        It is gone.
    """
    try:
        found = path.stat()
    except OSError as error:
        raise ReadError(path, f"cannot be opened: {error.strerror or error}") from error
    return found.st_mtime_ns, found.st_size


def _read_quietly(path: Path, keywords: Mapping[str, Any]) -> tuple[Motion | Signals, list[str]]:
    """What a file holds, and the warnings."""
    with _WARNINGS, warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = _read(path, keywords)
    return found, [str(w.message) for w in caught if issubclass(w.category, KinemeWarning)]


def _read(path: Path, keywords: Mapping[str, Any]) -> Motion | Signals:
    """What a file holds; a table of channels without a body is signals."""
    from kineme.formats.channels.reading import is_signal_file, read_signals

    if is_signal_file(path):
        return read_signals(path, fps=keywords.get("fps"))
    return read(path, **keywords)
