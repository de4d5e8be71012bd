"""Register formats, and recognise the format of a file.

A format has a name, suffixes, a test of a file's first bytes, a reader and writers. A reader takes
a `FileContent` and `ReadOptions` and returns a `Motion` or `Signals`, depending on the content. It
ignores options that do not apply. It records what it inferred in the provenance and does not warn.

Other packages add formats with `register`, or declare a `Format` as an entry point of the group
``kineme.formats``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from kineme._util.checks import Registry, check_suffixes, warn
from kineme._util.files import HEAD
from kineme.errors import ReadError
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion, Signals


@dataclass(frozen=True)
class Sketch:
    """A preview of a long file before it is read."""

    motion: Motion  # few frames, evenly spaced
    n_frames: int  # number of frames stated in the file
    fps: float  # frames per second of the file


@dataclass(frozen=True)
class Format:
    """One file format.

    Parameters
    ----------
    name : str
        Name shown to users.
    suffixes : tuple of str
        Lower case, with the dot.
    recognises : callable
        Returns whether a file's first 4096 bytes look like this format.
    read : callable, optional
        Takes `FileContent` and `ReadOptions`, returns the recording.
    write : callable, optional
        Takes a motion and a path.
    write_signals : callable, optional
        Takes signals and a path.
    read_folder : callable, optional
        Takes a folder and `ReadOptions`, and returns the recording whose frames are its files, or
        None if it has no files of this format.
    channels : bool
        Whether files can hold channels, so that ``read`` respects ``columns`` and ``emg``.
    analog : bool
        Whether a file can hold channels next to a motion, such as force plates and muscles;
        ``read`` then returns either.
    sketch : callable, optional
        Takes `FileContent`, `ReadOptions` and a maximum number of frames, and quickly returns a
        `Sketch`, or None if the file cannot be previewed.
    write_animations : callable, optional
        Takes motions of one skeleton by name, and a path; for formats that hold several.
    is_video : bool
        Whether files are videos: ``read`` gets only the first bytes and opens the path. A video
        next to a recording of the same name is not listed as another recording.
    copy_animations : callable, optional
        Takes motions by name, the path of the file that they came from, and a path. Writes a copy
        of that file with these animations instead of its own.

    Examples
    --------
    >>> def levels(content, options):
    ...     return Signals([float(word) for word in content.text.split()], options.fps or 100.0)
    >>> Format("levels", (".lvl",), lambda head: False, levels, channels=True).suffixes
    ('.lvl',)
    """

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    read: Callable[[FileContent, ReadOptions], Motion | Signals] | None = None
    write: Callable[[Motion, Path], None] | None = None
    write_signals: Callable[[Signals, Path], None] | None = None
    read_folder: Callable[[Path, ReadOptions], Motion | Signals | None] | None = None
    channels: bool = False
    analog: bool = False
    sketch: Callable[[FileContent, ReadOptions, int], Sketch | None] | None = None
    write_animations: Callable[[Mapping[str, Motion], Path], None] | None = None
    is_video: bool = False
    copy_animations: Callable[[Mapping[str, Motion], Path, Path], None] | None = None

    def __post_init__(self) -> None:
        check_suffixes(self.suffixes, self.name)


_PACKED = (".usdz", ".gz", ".bz2", ".xz", ".zip", ".7z", ".rar", ".tar", ".tgz")
ADVICE = {
    **dict.fromkeys(
        (".mvn", ".qtm", ".tak", ".x2d"), "export BVH or C3D from the program that made it"
    ),
    **dict.fromkeys((".xlsx", ".xls", ".ods"), "save it as CSV"),
    **dict.fromkeys(_PACKED, "unpack it first"),
}
"""Advice for unsupported files that people try to read, by suffix."""

FORMATS: Registry[Format] = Registry(
    Format,
    "format",
    "kineme.formats",
    home="kineme.formats",
    builtins=(
        "keypoints.pose_json:FORMATS",
        "keypoints.animals:FORMAT",
        "arrays.mat:FORMAT",
        "arrays.numpy_files:FORMATS",
        "tables:FORMATS",
        "markers.trc:FORMAT",
        "markers.c3d:FORMAT",
        "skeletons.bvh:FORMAT",
        "skeletons.amc:FORMAT",
        "skeletons.amc:SKELETON",
        "skeletons.mvnx:FORMAT",
        "scenes.fbx:FORMAT",
        "scenes.gltf:FORMAT",
        "scenes.usd:FORMAT",
        ".pose.estimating:FORMAT",
    ),
    newest_first=True,
)
"""Formats in the order in which they are tried: those of other packages come first."""


def register(new: Format, *, replace: bool = False) -> None:
    """Add a format for `read` and `write`, tried before the existing ones.

    Parameters
    ----------
    new : Format
        The format to add.
    replace : bool
        Whether to replace a format of the same name.

    Raises
    ------
    ParameterError
        A format of this name exists, or ``new`` is not a format.

    Examples
    --------
    >>> register(Format("levels", (".lvl",), lambda head: False))
    >>> supported_formats()[0].name
    'levels'
    >>> FORMATS.remove("levels")
    """
    FORMATS.register(new, replace=replace)


def supported_formats() -> tuple[Format, ...]:
    """Return the formats in the order in which they are tried.

    Returns
    -------
    tuple of Format

    Examples
    --------
    >>> {"AMC", "BVH", "C3D"} <= {candidate.name for candidate in supported_formats()}
    True
    """
    return tuple(FORMATS.values())


def find_writer(suffix: str) -> Format | None:
    """Return the format that writes motions to files of this suffix, or None."""
    writers = (
        candidate
        for candidate in supported_formats()
        if candidate.write and suffix in candidate.suffixes
    )
    return next(writers, None)


def list_motion_suffixes() -> list[str]:
    """Return the suffixes of files to which motions can be written."""
    return sorted({s for each in supported_formats() if each.write for s in each.suffixes})


def is_video(path: Path) -> bool:
    """Return whether a path has the suffix of a video."""
    suffix = path.suffix.lower()
    return any(
        candidate.is_video and suffix in candidate.suffixes for candidate in supported_formats()
    )


def recognise(content: FileContent) -> Format:
    """Return the format of a file by its content; if that is ambiguous, by its suffix."""
    head = content.data[:HEAD]
    suffix = content.path.suffix.lower()
    formats = supported_formats()
    by_content = [
        candidate
        for candidate in formats
        if recognises_safely(candidate.name, candidate.recognises, head)
    ]
    by_suffix = [candidate for candidate in formats if suffix in candidate.suffixes]
    if suffix in ADVICE and not by_suffix:
        raise ReadError(content.path, f"{suffix} is not supported: {ADVICE[suffix]}")
    # Prefer a format that matches both, then the content, then the suffix.
    for candidate in (*(f for f in by_content if f in by_suffix), *by_content, *by_suffix):
        return candidate
    suffixes = sorted({s for candidate in formats for s in candidate.suffixes})
    raise ReadError(
        content.path, f"unknown content and suffix {suffix!r}: kineme reads {', '.join(suffixes)}"
    )


def recognises_safely(name: str, recognises: Callable[..., bool], *evidence: Any) -> bool:
    """Return whether a format or dialect accepts a file; an exception counts as False."""
    try:
        return recognises(*evidence)
    except Exception as error:  # noqa: BLE001 (formats of other packages may raise anything)
        reason = f"{type(error).__name__}: {error}"
        warn(f"the format {name} was skipped, since it failed to recognise files: {reason:.200}")
        return False
