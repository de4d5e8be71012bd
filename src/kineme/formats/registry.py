"""Which format a file is in, and who reads and writes it.

A format is a name, its suffixes, a test of a file's first bytes, a reader and
writers. A reader takes a `FileContent` and `ReadOptions` and returns a `Motion`
or `Signals`, whichever the file holds; options it has no use for it ignores.
What it had to infer stands in the recording's provenance; `read` warns once of
all that is worth a warning.

Other packages add formats with `register`, or name a `Format` as an entry point
of the group ``kineme.formats``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from kineme._checks import as_texts, check_path, check_type, is_number, is_one_of
from kineme._plugins import plugins
from kineme.errors import MotionError, ParameterError, ReadError, WriteError
from kineme.formats.files import HEAD, FileContent, load, warn
from kineme.formats.units import AXES, UNITS
from kineme.recordings import Motion, Signals

AnyPath = str | PathLike[str]


@dataclass(frozen=True)
class ReadOptions:
    """What the user knows better than the file; None where the file is right.

    Parameters
    ----------
    skeleton : str or PathLike, optional
        The ASF file of an AMC, if it is not found beside it.
    fps : float, optional
        Frames per second.
    unit : str or float, optional
        "m", "cm", "mm", "inch", "cmu" (1/0.45 inch) or the metres in one unit.
    up : str, optional
        The file's vertical axis, "x", "y", "z", "-x", "-y" or "-z".
    person : str, optional
        Which of several people in a file, by name or number.
    confidence : float, optional
        From which a keypoint counts as seen.
    columns : sequence of str, optional
        Take these columns or analog channels as signals, in this order; all if it is empty.
    emg : bool
        Take channels as signals; of the analog channels of a C3D those of muscles.

    Raises
    ------
    ParameterError
        A value that an option does not take.
    """

    skeleton: AnyPath | None = None
    fps: float | None = None
    unit: str | float | None = None
    up: str | None = None
    person: str | None = None
    confidence: float | None = None
    columns: Sequence[str] | None = None
    emg: bool = False

    def __post_init__(self) -> None:
        if self.skeleton is not None:
            check_path(self.skeleton, "skeleton")
        if self.columns is not None:
            object.__setattr__(self, "columns", as_texts(self.columns, "columns"))
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

    @property
    def channels(self) -> bool:
        """Whether channels are asked for, whatever else a file holds."""
        return self.columns is not None or self.emg


@dataclass(frozen=True)
class Format:
    """One file format.

    Parameters
    ----------
    name : str
        As people call it.
    suffixes : tuple of str
        Lower case, with the dot.
    recognises : callable
        Whether a file's first 4096 bytes look like this format.
    read : callable, optional
        From `FileContent` and `ReadOptions` to the recording in it.
    write : callable, optional
        From a motion to a path.
    write_signals : callable, optional
        From signals to a path.
    read_folder : callable, optional
        From a folder of files that are one recording to this recording, None where there
        are none of this format in it.
    channels : bool
        Whether files can hold channels, so that ``read`` minds ``columns`` and ``emg``.
    """

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    read: Callable[[FileContent, ReadOptions], Motion | Signals] | None = None
    write: Callable[[Motion, Path], None] | None = None
    write_signals: Callable[[Signals, Path], None] | None = None
    read_folder: Callable[[Path, ReadOptions], Motion | Signals | None] | None = None
    channels: bool = False


_formats: list[Format] = []


def register(new: Format) -> None:
    """Make a format known to `read` and `write`, ahead of those known before.

    Parameters
    ----------
    new : Format
        Takes the place of a known one of the same name.
    """
    check_type(new, Format, "register", "see kineme.formats.Format")
    _formats[:] = [new, *(known for known in _formats if known.name != new.name)]


def supported_formats() -> tuple[Format, ...]:
    """The known formats, in the order in which they are tried.

    Returns
    -------
    tuple of Format

    Examples
    --------
    >>> {"AMC", "BVH", "C3D"} <= {known.name for known in supported_formats()}
    True
    """
    _add_plugins()
    return tuple(_formats)


def read(
    path: AnyPath,
    *,
    columns: Sequence[str] | None = None,
    emg: bool = False,
    skeleton: AnyPath | None = None,
    fps: float | None = None,
    unit: str | float | None = None,
    up: str | None = None,
    person: str | int | None = None,
    confidence: float | None = None,
) -> Motion | Signals:
    """The recording in a file: a motion in metres with y up, or signals.

    What the file holds decides which of the two: channels without a body are signals.
    What had to be inferred stands in the provenance; one KinemeWarning lists what is
    worth a warning.

    Parameters
    ----------
    path : str or PathLike
        The recording; a folder where it is a file per frame, as OpenPose's.
    columns : sequence of str, optional
        Take these columns or analog channels as signals, by name and in this order; all of
        them if it is empty.
    emg : bool
        Take channels as signals; of the analog channels of a C3D those of muscles, where
        ``columns`` names none. Their envelopes are the part of `kineme.segment`.
    skeleton : str or PathLike, optional
        The ASF file of an AMC, if it is not found beside it.
    fps : float, optional
        Frames per second, in place of the file's.
    unit : str or float, optional
        "m", "cm", "mm", "inch", "cmu" (1/0.45 inch) or the metres in one unit, in place of
        the file's or of what the body's height suggests.
    up : str, optional
        The file's vertical axis, "x", "y", "z", "-x", "-y" or "-z".
    person : str or int, optional
        Which of several people in a file, by name or number.
    confidence : float, optional
        From which a keypoint counts as seen, in place of its format's limit.

    Returns
    -------
    Motion or Signals

    Raises
    ------
    ReadError
        The file is missing, damaged or of no known format, tells no frame rate, or has not
        the channels asked for.
    ParameterError
        An option is outside what it accepts.
    MissingDependencyError
        The format needs a package that is not installed.

    Examples
    --------
    >>> import kineme
    >>> kineme.read(kineme.bundled_recording())
    <Motion of 2898 frames (48.3 s) at 60 Hz: 26 joints, 5 of them end sites>
    """
    who = None if person is None else str(person)
    options = ReadOptions(skeleton, fps, unit, up, who, confidence, columns, emg)
    recording = read_quietly(path, options)
    if said := recording.provenance.warnings:
        warn(f"{path}: {'; '.join(said)}")
    return recording


def read_quietly(path: AnyPath, options: ReadOptions | None = None) -> Motion | Signals:
    """As `read`, without a warning: ``recording.provenance.warnings`` has what it would say.

    Parameters
    ----------
    path : str or PathLike
    options : ReadOptions, optional

    Returns
    -------
    Motion or Signals
    """
    check_path(path, "read")
    options = options or ReadOptions()
    try:
        # Values too large to compute with end up as an error in Motion.
        with np.errstate(over="ignore", invalid="ignore"):
            if Path(path).is_dir():
                return _read_folder(Path(path), options)
            return _read_file(load(path), options)
    except MotionError as error:
        raise ReadError(path, str(error)) from error


def read_motion(path: AnyPath, **options: Any) -> Motion:
    """As `read`, for those who need a body.

    Parameters
    ----------
    path : str or PathLike
    **options
        Those of `read`.

    Returns
    -------
    Motion

    Raises
    ------
    ReadError
        The file holds signals; or as `read`.
    """
    recording = read(path, **options)
    if not isinstance(recording, Motion):
        raise ReadError(path, "holds signals without a skeleton, where a motion is needed")
    return recording


def write(recording: Motion | Signals, path: AnyPath) -> None:
    """Leave a recording in a file of the format its suffix names, whole or not at all.

    Parameters
    ----------
    recording : Motion or Signals
    path : str or PathLike

    Raises
    ------
    WriteError
        Unknown suffix, a recording the format cannot hold, or a place that cannot be
        written.
    """
    check_type(recording, (Motion, Signals), "write", "kineme.read(path) gives one")
    check_path(path, "write")
    target = Path(path)
    writers: dict[str, Callable[[Any, Path], None]] = {}
    for known in supported_formats():
        writer = known.write if isinstance(recording, Motion) else known.write_signals
        if writer is not None:
            writers |= {s: writer for s in known.suffixes if s not in writers}
    if target.suffix.lower() not in writers:
        kind = "a motion" if isinstance(recording, Motion) else "signals"
        raise WriteError(
            path,
            f"no writer of {kind} for the suffix {target.suffix!r}: use one of "
            f"{', '.join(sorted(writers))}",
        )
    writers[target.suffix.lower()](recording, target)


def _read_file(content: FileContent, options: ReadOptions) -> Motion | Signals:
    if not content.data.strip():
        raise content.error("the file is empty")
    known = _recognise(content)
    if known.read is None:
        raise content.error("this format can be written but not read")
    if options.channels and not known.channels:
        raise content.error(
            f"is {known.name}, which is not read as channels (columns, emg): load them as an "
            "array and give it to kineme.Signals"
        )
    return known.read(content, options)


def _read_folder(path: Path, options: ReadOptions) -> Motion | Signals:
    for known in supported_formats():
        recording = known.read_folder(path, options) if known.read_folder else None
        if recording is not None:
            return recording
    raise ReadError(
        path,
        "cannot be opened: a folder without the file for each frame (*_keypoints.json) that "
        "OpenPose leaves; give the files in it one by one",
    )


def _recognise(content: FileContent) -> Format:
    """The format the content speaks for; where several or none do, the suffix decides."""
    head = content.data[:HEAD]
    suffix = content.path.suffix.lower()
    formats = supported_formats()
    by_content = [known for known in formats if known.recognises(head)]
    by_suffix = [known for known in formats if suffix in known.suffixes]
    for known in (*(f for f in by_content if f in by_suffix), *by_content, *by_suffix):
        return known
    suffixes = sorted({s for known in formats for s in known.suffixes})
    raise ReadError(
        content.path,
        f"neither its content nor its suffix {suffix!r} is known: kineme reads "
        f"{', '.join(suffixes)}",
    )


@cache
def _add_plugins() -> None:
    """Register what other packages name as entry points, once."""
    for found in plugins("kineme.formats"):
        register(found)
