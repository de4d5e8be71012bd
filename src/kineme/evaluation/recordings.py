"""Recordings to evaluate: which files of a folder they are, and how each is read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fnmatch import filter as filter_names
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from kineme.errors import ParameterError, ReadError
from kineme.recordings.motion import Motion
from kineme.recordings.signals import Signals

UNMET = "has no column like"
"""How a note on a pattern begins that no column of a recording fits, such as a mistyped one."""


@dataclass(frozen=True)
class Reading:
    """How recordings are read, the same for all.

    Parameters
    ----------
    columns : tuple of str
        Patterns (``acc*``) of the columns to take as signals; none: what the file says.
    without : tuple of str
        Patterns of columns to leave out of signals.
    options : dict
        For `kineme.read`, such as ``fps``, ``unit`` and ``up``.
    """

    columns: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    options: dict[str, Any] = field(default_factory=dict)

    def read(self, path: Path) -> Motion | Signals:
        """The recording in a file.

        Parameters
        ----------
        path : Path

        Returns
        -------
        Motion or Signals

        Raises
        ------
        ReadError
            Missing or damaged.
        ParameterError
            No column is left.
        """
        from kineme.formats import read

        if not (self.columns or self.without):
            return read(path, **self.options)
        signals = read(path, columns=(), **self.options)
        if not isinstance(signals, Signals):
            raise ParameterError(f"{path}: has no columns to choose from")
        kept = [name for name in signals.names if self.takes(name)]
        if not kept:
            names = ", ".join(signals.names)
            raise ParameterError(f"{path}: no column is left of {names:.200}")
        return signals.select(kept).noted(*self._unmet(signals.names))

    def _unmet(self, names: Sequence[str]) -> list[str]:
        """What is said of patterns that no column fits."""
        lower = [name.lower() for name in names]
        unmet = [p for p in (*self.columns, *self.without) if not filter_names(lower, p.lower())]
        return [f"{UNMET} {pattern!r:.60}" for pattern in unmet]

    def takes(self, name: str) -> bool:
        """Whether a column is one of those wanted; capitals and small letters are the same."""
        small = name.lower()
        wanted = not self.columns or any(fnmatchcase(small, p.lower()) for p in self.columns)
        return wanted and not any(fnmatchcase(small, p.lower()) for p in self.without)


def recordings_below(folder: Path) -> list[Path]:
    """The recordings in a folder and in the folders in it.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    list of Path
        In the order of their names, those of a folder before those deeper in it.

    Raises
    ------
    ReadError
        There are none.
    """
    from kineme.formats.listing import recordings_in

    found = recordings_in(folder, recursive=True).recordings
    if not found:
        raise ReadError(folder, "there is no recording in this folder")
    return found
