"""Read and write recordings of any format."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from kineme._util.checks import check_path, check_type, warn
from kineme._util.files import AnyPath, translate_read_errors
from kineme.errors import ReadError, SeveralPeopleError, WriteError
from kineme.formats.files import FileContent, load, load_head
from kineme.formats.listing import refuse_segments
from kineme.formats.options import ReadOptions
from kineme.formats.plausibility import check_bone_lengths, check_posture
from kineme.formats.registry import Sketch, is_video, recognise, supported_formats
from kineme.recordings import Motion, Signals

_BLANK = re.compile(rb"(\xef\xbb\xbf)?\s*\Z")


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
    take: str | int | None = None,
) -> Motion | Signals:
    """Return the recording in a file: a motion in metres with y up, or signals.

    The content of the file decides between the two: channels without a body are signals. The
    provenance records what had to be inferred; one KinemeWarning lists the doubtful parts.

    Parameters
    ----------
    path : str or PathLike
        The recording; a folder if each frame is a file, as in OpenPose's output.
    columns : sequence of str, optional
        Read these columns or analog channels as signals, by name or pattern (``acc_*``), in this
        order; all of them if the sequence is empty.
    emg : bool
        Read channels as signals. Of a C3D's analog channels these are the muscles' unless
        ``columns`` names others. `kineme.segment` computes their envelopes.
    skeleton : str or PathLike, optional
        The ASF file of an AMC, if it is not found next to it.
    fps : float, optional
        Frames per second; overrides the file's.
    unit : str or float, optional
        "m", "cm", "mm", "inch", "cmu" (1/0.45 inch) or the metres in one unit; overrides the
        file's unit and the one inferred from the body's height.
    up : str, optional
        The file's vertical axis, "x", "y", "z", "-x", "-y" or "-z".
    person : str or int, optional
        Which of several people in a file to read, by name or number.
    confidence : float, optional
        Minimum confidence of a keypoint that counts as seen; overrides the format's limit.
    take : str or int, optional
        Which of several animations in a scene (FBX, glTF, USD) to read, by name or number; by
        default the first, with a warning.

    Returns
    -------
    Motion or Signals

    Raises
    ------
    ReadError
        The file is missing, damaged or of unknown format, has no frame rate, or lacks the
        requested channels.
    ParameterError
        The value of an option is invalid.
    MissingDependencyError
        The format needs a package that is not installed.

    Examples
    --------
    >>> import kineme
    >>> kineme.read(kineme.bundled_recording())
    <Motion of 2898 frames (48.3 s) at 60 Hz: 26 joints, 5 of them end sites>
    """
    if skeleton is not None:
        check_path(skeleton, "skeleton")
    skeleton_path, person_name, take_name = (
        None if value is None else str(value) for value in (skeleton, person, take)
    )
    options = ReadOptions(
        skeleton_path,
        fps,
        unit=unit,
        up=up,
        person=person_name,
        confidence=confidence,
        columns=columns,
        emg=emg,
        take=take_name,
    )
    recording = read_quietly(path, options)
    if warnings := recording.provenance.warnings:
        warn(f"{path}: {'; '.join(warnings)}")
    return recording


def read_quietly(path: AnyPath, options: ReadOptions | None = None) -> Motion | Signals:
    """Read like `read`, without a warning; ``recording.provenance.warnings`` has its content.

    Parameters
    ----------
    path : str or PathLike
    options : ReadOptions, optional

    Returns
    -------
    Motion or Signals

    Examples
    --------
    >>> import kineme
    >>> read_quietly(kineme.bundled_recording()).provenance.warnings
    ()
    """
    check_path(path, "read")
    options = options or ReadOptions()
    with translate_read_errors(path):
        if Path(path).is_dir():
            return _read_folder(Path(path), options)
        return _read_file(_load(path), options)


def list_people(path: AnyPath, options: ReadOptions | None = None) -> tuple[str, ...]:
    """Return the names of the people in a file if there are several.

    People seen only briefly are left out. The file is read; raise ReadError if that fails.

    Examples
    --------
    >>> import kineme
    >>> list_people(kineme.bundled_recording())
    ()
    """
    try:
        recording = read_quietly(path, replace(options or ReadOptions(), person=None))
    except SeveralPeopleError as error:
        return error.people if len(error.people) > 1 else ()
    people = recording.provenance.people
    return people if len(people) > 1 else ()


def list_takes(path: AnyPath, options: ReadOptions | None = None) -> tuple[str, ...]:
    """Return the names of the takes that move a skeleton if a scene has several.

    The file is read; raise ReadError if that fails.

    Examples
    --------
    >>> import kineme
    >>> list_takes(kineme.bundled_recording())
    ()
    """
    try:
        takes = read_quietly(path, replace(options or ReadOptions(), take=None)).provenance.takes
    except SeveralPeopleError as error:
        # All people of a scene have the same takes.
        options_of_first = replace(options or ReadOptions(), take=None, person=error.people[0])
        takes = read_quietly(path, options_of_first).provenance.takes
    return takes if len(takes) > 1 else ()


def read_analog(path: AnyPath, options: ReadOptions) -> Signals | None:
    """Return the analog channels next to the motion in a file, such as force plates and muscles.

    Parameters
    ----------
    path : str or PathLike
    options : ReadOptions
        Options used for the motion.

    Returns
    -------
    Signals or None
        All channels at their own rate; None if there are none.

    Examples
    --------
    >>> import kineme
    >>> read_analog(kineme.bundled_recording(), ReadOptions()) is None
    True
    """
    with translate_read_errors(path):
        if Path(path).is_dir():
            return None
        content = _load(path)
        candidate = recognise(content)
        if candidate.read is None or not candidate.analog:
            return None
        try:
            recording = candidate.read(content, replace(options, columns=()))
        except ReadError:  # the file has no channels
            return None
        return recording if isinstance(recording, Signals) else None


def sketch(path: AnyPath, options: ReadOptions, most: int) -> Sketch | None:
    """Return evenly spaced poses of a long file, to show while it is read.

    Parameters
    ----------
    path : str or PathLike
    options : ReadOptions
        Options used for reading.
    most : int
        Maximum number of poses.

    Returns
    -------
    Sketch or None
        None if the format does not support it, or the file has no more frames than that.

    Examples
    --------
    >>> import kineme
    >>> shown = sketch(kineme.bundled_recording(), ReadOptions(), 10)
    >>> shown.motion.n_frames, shown.n_frames
    (10, 2898)
    """
    with translate_read_errors(path):
        if Path(path).is_dir():
            return None
        content = _load(path)
        candidate = recognise(content)
        return candidate.sketch(content, options, most) if candidate.sketch else None


def read_motion(path: AnyPath, **options: Any) -> Motion:
    """Read a motion like `read`, and raise ReadError if the file holds signals.

    Parameters
    ----------
    path : str or PathLike
    **options
        Options of `read`.

    Returns
    -------
    Motion

    Raises
    ------
    ReadError
        The file holds signals, or `read` fails.

    Examples
    --------
    >>> import kineme
    >>> read_motion(kineme.bundled_recording()).skeleton
    <Skeleton of 26 joints, 5 of them end sites>
    """
    recording = read(path, **options)
    if not isinstance(recording, Motion):
        raise ReadError(path, "holds signals without a skeleton, but a motion is needed")
    return recording


def write(recording: Motion | Signals, path: AnyPath) -> None:
    """Write a recording atomically to a file whose suffix selects the format.

    Parameters
    ----------
    recording : Motion or Signals
    path : str or PathLike

    Raises
    ------
    WriteError
        The suffix is unknown, the format cannot hold the recording, or the path is not
        writable.

    Examples
    --------
    >>> import kineme
    >>> kineme.write(kineme.read(kineme.bundled_recording())[:60], "second.bvh")
    >>> kineme.read("second.bvh").duration
    1.0
    """
    check_type(recording, (Motion, Signals), "write", "kineme.read(path) gives one")
    check_path(path, "write")
    target = Path(path)
    is_motion = isinstance(recording, Motion)
    writers = {
        suffix: writer
        for candidate in reversed(supported_formats())  # the first format of a suffix wins
        for suffix in candidate.suffixes
        if (writer := candidate.write if is_motion else candidate.write_signals)
    }
    if target.suffix.lower() not in writers:
        kind = "a motion" if is_motion else "signals"
        raise WriteError(
            path,
            f"cannot write {kind} with the suffix {target.suffix!r}: use one of "
            f"{', '.join(sorted(writers))}",
        )
    write_file: Callable[[Any, Path], None] = writers[target.suffix.lower()]
    write_file(recording, target)


def _load(path: AnyPath) -> FileContent:
    """Return the content of a file; of a video, which may be too large, only the first bytes."""
    return load_head(path) if is_video(Path(path)) else load(path)


def _read_file(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """Return the recording in a file, and check what its reader returned."""
    if _BLANK.match(content.data):
        raise content.error("the file is empty")
    refuse_segments(content)
    candidate = recognise(content)
    if candidate.read is None:
        raise content.error("this format can only be written, not read")
    if options.channels and not candidate.channels:
        raise content.error(
            f"is {candidate.name}, which cannot be read as channels (columns, emg): load "
            "them as an array and pass it to kineme.Signals"
        )
    recording: object = candidate.read(content, options)  # may be another package's reader
    if not isinstance(recording, Motion | Signals):
        kind = type(recording).__name__
        raise content.error(f"the reader of {candidate.name} gave no Motion or Signals, but {kind}")
    # Number 0 is accepted everywhere, so that one command reads files of several formats.
    # Signals, also those beside a motion, belong to nobody.
    for what in ("take", "person") if isinstance(recording, Motion) else ("take",):
        value = getattr(options, what)
        if value not in (None, "0") and getattr(recording.provenance, what) is None:
            raise content.error(
                f"there is no {what} {value!r}: it names no {what}, so leave out {what}= (--{what})"
            )
    if isinstance(recording, Motion):
        recording = check_bone_lengths(recording)
        return check_posture(recording) if options.up is None else recording
    return recording


def _read_folder(path: Path, options: ReadOptions) -> Motion | Signals:
    for candidate in supported_formats():
        recording = candidate.read_folder(path, options) if candidate.read_folder else None
        if recording is not None:
            return recording
    raise ReadError(
        path,
        "is a folder without OpenPose files (*_keypoints.json): give the files in it one by one",
    )
