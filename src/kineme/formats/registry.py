"""Which format a file is in, and who reads and writes it.

A format is a name, its suffixes, a test of a file's first bytes, a reader and
a writer. A reader takes a `Source` and `ReadOptions` and returns a `Motion`;
options it has no use for it ignores.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np

from kineme._checks import check_path, is_number, is_one_of
from kineme.errors import MotionError, ParameterError, ReadError, WriteError
from kineme.formats.files import Source, load
from kineme.formats.units import AXES, UNITS
from kineme.recordings.motion import Motion, check_motion

AnyPath = str | PathLike[str]


@dataclass(frozen=True)
class ReadOptions:
    """What the user knows better than the file; None where the file is right.

    ``unit`` is a name in `UNITS` or the length of one file unit in metres,
    ``person`` the name or number of one of several, ``confidence`` that from
    which a keypoint counts as seen.
    """

    skeleton: Path | None = None
    fps: float | None = None
    unit: str | float | None = None
    up: str | None = None
    person: str | None = None
    confidence: float | None = None

    def __post_init__(self) -> None:
        if self.fps is not None and not (is_number(self.fps) and self.fps > 0):
            raise ParameterError(f"fps is {self.fps!r:.60}: give frames per second, above 0")
        if isinstance(self.unit, str):
            if self.unit not in UNITS:
                known = ", ".join(UNITS)
                raise ParameterError(f"unit is {self.unit!r}: give metres or one of {known}")
        elif self.unit is not None and not (is_number(self.unit) and self.unit > 0):
            raise ParameterError(f"unit is {self.unit!r:.60}: give the metres in one unit, above 0")
        if self.up is not None and not is_one_of(self.up, AXES):
            raise ParameterError(f"up is {self.up!r}: give one of {', '.join(AXES)}")
        if self.confidence is not None and not is_number(self.confidence):
            raise ParameterError(
                f"confidence is {self.confidence!r:.60}: give a number, such as 0.5"
            )


@dataclass(frozen=True)
class Format:
    """One file format.

    Parameters
    ----------
    name : as people call it
    suffixes : lower case, with the dot
    recognises : whether a file's first 4096 bytes look like this format
    read : from a source to a motion, or None
    write : from a motion to a path, or None
    read_folder : from a folder of files that are one recording to a motion, None where
        there are none of this format in it
    """

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    read: Callable[[Source, ReadOptions], Motion] | None = None
    write: Callable[[Motion, Path], None] | None = None
    read_folder: Callable[[Path, ReadOptions], Motion | None] | None = None


_formats: list[Format] = []


def register(new: Format) -> None:
    """Make a format known to `read` and `write`, ahead of those known before."""
    _formats.insert(0, new)


def supported_formats() -> tuple[Format, ...]:
    """The known formats, in the order in which they are tried."""
    return tuple(_formats)


def read(
    path: AnyPath,
    *,
    skeleton: AnyPath | None = None,
    fps: float | None = None,
    unit: str | float | None = None,
    up: str | None = None,
    person: str | int | None = None,
    confidence: float | None = None,
) -> Motion:
    """The motion in a file: metres, y up, with what was inferred in its provenance.

    Parameters
    ----------
    path : the recording; a folder where it is a file per frame, as OpenPose's
    skeleton : the ASF file of an AMC, if it is not found beside it
    fps : frames per second, in place of the file's
    unit : "m", "cm", "mm", "inch", "cmu" (1/0.45 inch) or the metres in one
        unit, in place of the file's or of what the body's height suggests
    up : the file's vertical axis, "x", "y", "z", "-x", "-y" or "-z"
    person : which of several people in a file, by name or number
    confidence : from which a keypoint counts as seen, in place of its format's limit

    Raises
    ------
    ReadError : the file is missing, damaged or of no known format
    ParameterError : an option is outside what it accepts
    """
    check_path(path, "read")
    if skeleton is not None:
        check_path(skeleton, "skeleton")
    options = ReadOptions(
        skeleton=Path(skeleton) if skeleton is not None else None,
        fps=fps,
        unit=unit,
        up=up,
        person=None if person is None else str(person),
        confidence=confidence,
    )
    try:
        # Values too large to compute with end up as an error in Motion.
        with np.errstate(over="ignore", invalid="ignore"):
            if Path(path).is_dir():
                return _read_folder(Path(path), options)
            return _read_file(load(path), options)
    except MotionError as error:
        raise ReadError(path, str(error)) from error


def write(motion: Motion, path: AnyPath) -> None:
    """Leave ``motion`` in a file of the format its suffix names, whole or not at all.

    Raises
    ------
    WriteError : unknown suffix, a motion the format cannot hold, or a place
        that cannot be written
    """
    check_motion(motion, "write")
    check_path(path, "write")
    target = Path(path)
    for known in _formats:
        if target.suffix.lower() in known.suffixes and known.write is not None:
            return known.write(motion, target)
    suffixes = sorted(s for known in _formats if known.write for s in known.suffixes)
    raise WriteError(
        path, f"no writer for the suffix {target.suffix!r}: use one of {', '.join(suffixes)}"
    )


def _read_file(source: Source, options: ReadOptions) -> Motion:
    if not source.data.strip():
        raise source.error("the file is empty")
    reader = _recognise(source).read
    if reader is None:
        raise source.error("this format can be written but not read")
    return reader(source, options)


def _read_folder(path: Path, options: ReadOptions) -> Motion:
    for known in _formats:
        motion = known.read_folder(path, options) if known.read_folder else None
        if motion is not None:
            return motion
    raise ReadError(
        path,
        "cannot be opened: a folder without the file for each frame (*_keypoints.json) that "
        "OpenPose leaves; give the files in it one by one",
    )


def _recognise(source: Source) -> Format:
    """The format the content speaks for; where several or none do, the suffix decides."""
    head = source.data[:4096]
    suffix = source.path.suffix.lower()
    by_content = [known for known in _formats if known.recognises(head)]
    by_suffix = [known for known in _formats if suffix in known.suffixes]
    for known in (*(f for f in by_content if f in by_suffix), *by_content, *by_suffix):
        return known
    suffixes = sorted({s for known in _formats for s in known.suffixes})
    raise ReadError(
        source.path,
        f"neither its content nor its suffix {suffix!r} is known: kineme reads "
        f"{', '.join(suffixes)}",
    )
