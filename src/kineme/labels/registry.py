"""Read and write segments in any label format, selected by name, content or suffix.

A format is a `LabelFormat` object, defined below its functions. Built-in formats are listed here
and imported on first use. Other packages add formats with `register`, or by the entry point group
``kineme.label_formats``.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Literal, get_args

from kineme._util.checks import (
    Registry,
    check_one_of,
    check_path,
    check_suffixes,
    check_type,
    is_number,
    is_one_of,
)
from kineme._util.files import translate_read_errors
from kineme.errors import KinemeWarning, ParameterError, ReadError, WriteError
from kineme.labels.spans import Labels, as_segmentation, check_extent, convert_clock_times
from kineme.recordings.times import Clock
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

Read = Callable[[Path], Segmentation | Labels]
Holds = Literal["all", "levels", "level"]
Write = Callable[[Sequence[Segment], Segmentation, Path], None]


@dataclass(frozen=True)
class LabelFormat:
    """A file format for segments.

    Parameters
    ----------
    name : str
        Name for ``format=`` and the command line.
    help : str
        Short description, shown in lists of formats.
    suffixes : tuple of str
        File suffixes in lower case with the dot, the usual one first. If several formats share a
        suffix, the content of the file decides, see ``recognises``.
    holds : {"all", "levels", "level"}
        What a file stores: the whole segmentation, labels of both levels, or of one level.
    read : callable
        Takes a path and returns a `Segmentation`, or `Labels` if frame rate, length or gaps are
        still to be filled in. Raises `ReadError`; `OSError` and `UnicodeDecodeError` are
        converted to it.
    write : callable, optional
        ``write(segments, segmentation, path)`` writes the given segments of a segmentation to a
        path. None for formats that are only read.
    recognises : callable, optional
        Takes a path with one of the suffixes; returns whether it holds labels in this format and
        is not a recording. None if the suffix is sufficient.
    written_suffix : str, optional
        Suffix for writing, if it is not the first of ``suffixes``.
    several : bool
        Whether it consists of several files; they are zipped for downloads.
    folder : str, optional
        Required name of the folder that contains the file.

    Examples
    --------
    >>> from kineme.labels import label_formats
    >>> textgrid = label_formats()["textgrid"]
    >>> textgrid.suffixes, textgrid.written_suffix, textgrid.download_suffix
    (('.textgrid',), '.TextGrid', '.TextGrid')
    """

    name: str
    help: str
    suffixes: tuple[str, ...]
    holds: Holds
    read: Read
    write: Write | None = None
    recognises: Callable[[Path], bool] | None = None
    written_suffix: str = ""
    several: bool = False
    folder: str = ""

    def __post_init__(self) -> None:
        check_suffixes(self.suffixes, self.name)
        check_one_of(self.holds, get_args(Holds), f"holds of {self.name!r:.60}")
        object.__setattr__(self, "written_suffix", self.written_suffix or self.suffixes[0])

    @property
    def download_suffix(self) -> str:
        """Return the suffix of a download: that of the file, or ``.zip`` for several files."""
        return ".zip" if self.several else self.written_suffix


FORMATS: Registry[LabelFormat] = Registry(
    LabelFormat,
    "label format",
    "kineme.label_formats",
    home="kineme.labels",
    builtins=(
        "csv_table:FORMAT",
        "json_table:FORMAT",
        "json_table:PARQUET",
        "tiers:ELAN_TABLE",
        "line_formats:AUDACITY",
        "tiers:ELAN",
        "tiers:TEXTGRID",
        "event_tables:BIDS",
        "event_tables:BORIS",
        "babel:FORMAT",
        "line_formats:MS_TCN",
        "line_formats:CLIPS",
        "c3d_events:FORMAT",
    ),
)
"""Label formats in the order in which they are listed and tried."""


def label_formats() -> Mapping[str, LabelFormat]:
    """Return the label formats by name, built-in ones first.

    Returns
    -------
    Mapping of str to LabelFormat
        In the order in which they are listed and tried.

    Examples
    --------
    >>> list(label_formats())[:3]
    ['csv', 'json', 'parquet']
    """
    return FORMATS


def register(new: LabelFormat, *, replace: bool = False) -> None:
    """Add a format to `read_segments`, `write_segments`, command line and studio.

    Parameters
    ----------
    new : LabelFormat
        The format.
    replace : bool
        Whether to replace a format with the same name.

    Raises
    ------
    ParameterError
        A format with this name exists, or ``new`` is not a `LabelFormat`.

    Examples
    --------
    >>> register(label_formats()["csv"], replace=True)
    >>> label_formats()["csv"].suffixes
    ('.csv', '.tsv')
    """
    FORMATS.register(new, replace=replace)


def list_written_suffixes() -> tuple[str, ...]:
    """Return the suffixes from which `write_segments` can choose a format.

    Returns
    -------
    tuple of str
        Lower case, with the dot, each once.

    Examples
    --------
    >>> list_written_suffixes()[:3]
    ('.csv', '.json', '.parquet')
    """
    writers = [candidate for candidate in label_formats().values() if candidate.write]
    return tuple(dict.fromkeys(candidate.written_suffix.lower() for candidate in writers))


def write_segments(
    segmentation: Segmentation,
    path: str | PathLike[str],
    *,
    format: str | None = None,  # noqa: A002 (what everybody calls it)
    level: Level | None = None,
) -> None:
    """Write a segmentation to a file atomically.

    Parameters
    ----------
    segmentation : Segmentation
        What to write.
    path : path-like
        The file; its suffix selects the format unless ``format`` is given.
    format : str, optional
        A name in `kineme.labels.label_formats`.
    level : {"activity", "primitive"}, optional
        Level of the segments to write; by default both if the format supports it, else
        ``activity``. Native formats always hold both.

    Raises
    ------
    ParameterError
        Unknown format or level.
    WriteError
        Unknown suffix, content that the format cannot hold, or the file cannot be written.
    MissingDependencyError
        Parquet without pyarrow.

    Examples
    --------
    >>> import kineme, tempfile
    >>> from kineme.datasets import bundled_truth
    >>> segments = kineme.read_segments(bundled_truth())
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     kineme.write_segments(segments, f"{folder}/take.eaf")
    ...     kineme.read_segments(f"{folder}/take.eaf").n_frames
    2898
    """
    check_type(segmentation, Segmentation, "write_segments", "kineme.segment(motion) gives one")
    check_path(path, "write_segments")
    label_format = find_write_format(path, format)
    if label_format.holds == "all" and level is not None:
        raise ParameterError(
            f"{label_format.name} always holds both levels: leave out level={level!r}"
        )
    if level is None and label_format.holds == "level":
        level = "activity"
    rows = list(segmentation if level is None else segmentation.level(level))
    if not rows:
        raise WriteError(path, f"there are no segments of level {level!r}")
    if label_format.write is not None:
        label_format.write(rows, segmentation, Path(path))


def read_segments(
    path: str | PathLike[str],
    *,
    format: str | None = None,  # noqa: A002
    fps: float | None = None,
    n_frames: int | None = None,
    clock: Clock | None = None,
) -> Segmentation:
    """Read a segmentation from a file in any label format.

    Parameters
    ----------
    path : path-like
        The file. Without ``format``, its suffix selects the format; if several formats share the
        suffix (``.txt`` may be Audacity or one label per frame), its content.
    format : str, optional
        A name in `kineme.labels.label_formats`.
    fps : float, optional
        Frame rate of the recording, for formats that do not store it. Labels in seconds are
        converted to this rate, even if their file states another, such as that of a video.
    n_frames : int, optional
        Length of the recording, if the last label may end before it.
    clock : Clock, optional
        Clock of the recording (``provenance.clock``); requires `fps` and `n_frames`. Labels in
        seconds are times of this clock, and those in pauses or outside the recording are left out.

    Returns
    -------
    Segmentation
        Frames without a label are transitions.

    Raises
    ------
    ParameterError
        Unknown format, or a frame rate or length that is not positive.
    ReadError
        The file is missing, damaged, of another format or newer version, or contradicts ``fps``
        or ``n_frames``.
    MissingDependencyError
        Parquet without pyarrow.

    Warns
    -----
    KinemeWarning
        Labels were left out or joined; one warning per file.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> kineme.read_segments(bundled_truth()).activities.label[:3].tolist()
    ['walk', '', 'squat']
    """
    check_path(path, "read_segments")
    if fps is not None and not (is_number(fps) and fps > 0):
        raise ParameterError(f"fps is {fps!r:.60}: give frames per second, above 0")
    if n_frames is not None and not (is_number(n_frames) and n_frames >= 1):
        raise ParameterError(f"n_frames is {n_frames!r:.60}: a recording has at least 1 frame")
    label_format, content = read_content(path, format)
    if isinstance(content, Labels):
        if clock is not None and fps is not None and n_frames is not None:
            content = convert_clock_times(content, clock, length_s=n_frames / fps)
        with translate_read_errors(path):
            content, warning_texts = as_segmentation(
                content, Path(path), label_format.name, fps=fps, n_frames=n_frames
            )
        if warning_texts:
            warnings.warn(f"{path}: {'; '.join(warning_texts)}", KinemeWarning, stacklevel=2)
    check_extent(content, path, fps=fps, n_frames=n_frames)
    if clock is None or "clock" in content.provenance:
        return content
    return replace(content, provenance={**content.provenance, "clock": clock.to_json()})


def read_content(
    path: str | PathLike[str], name: str | None = None
) -> tuple[LabelFormat, Segmentation | Labels]:
    """Return the format and raw content of a file, before missing facts are filled in."""
    label_format = find_read_format(path, name)
    with translate_read_errors(path):
        return label_format, label_format.read(Path(path))


def find_read_format(path: str | PathLike[str], name: str | None = None) -> LabelFormat:
    """Return the format for reading a file: the named one, else by content and suffix."""
    if name is not None:
        return _find_named(name)
    candidates, suffix = _find_by_suffix(path), Path(path).suffix.lower()
    if not candidates and not Path(path).exists():
        raise ReadError(path, "there is no such file")
    if not candidates:
        every = (known for candidate in FORMATS.values() for known in candidate.suffixes)
        stored = ", ".join(dict.fromkeys(every))
        raise ReadError(path, f"segments are stored as {stored}, not {_format_suffix(suffix)}")
    candidates.sort(key=lambda candidate: candidate.written_suffix.lower() != suffix)
    return next((each for each in candidates if _recognises(each, Path(path))), candidates[0])


def find_write_format(path: str | PathLike[str], name: str | None = None) -> LabelFormat:
    """Return the format for writing a file: the named one, else the first with its suffix."""
    candidates = _find_by_suffix(path) if name is None else [_find_named(name)]
    writers = [candidate for candidate in candidates if candidate.write]
    suffix, stored = Path(path).suffix.lower(), ", ".join(list_written_suffixes())
    if writers:
        # Prefer a format that usually writes this suffix over one that also reads it.
        return min(writers, key=lambda candidate: candidate.written_suffix.lower() != suffix)
    if candidates:
        raise WriteError(path, f"{candidates[0].name} can only be read: write segments to {stored}")
    raise WriteError(path, f"segments are stored as {stored}, not {_format_suffix(suffix)}")


def holds_labels(path: str | PathLike[str]) -> bool:
    """Return whether a file holds labels, judging by its suffix and first bytes.

    Parameters
    ----------
    path : path-like
        A file. Recordings in formats that labels also use (CSV, Parquet) do not count.

    Returns
    -------
    bool
        Also False if the file cannot be opened.

    Examples
    --------
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> holds_labels(bundled_truth()), holds_labels(bundled_recording())
    (True, False)
    """
    target = Path(path)
    if target.name.endswith(".provenance.json"):  # belongs to the table beside it
        return False
    return any(_recognises(candidate, target) for candidate in _find_by_suffix(path))


def _find_by_suffix(path: str | PathLike[str]) -> list[LabelFormat]:
    suffix = Path(path).suffix.lower()
    return [candidate for candidate in FORMATS.values() if suffix in candidate.suffixes]


def _recognises(candidate: LabelFormat, path: Path) -> bool:
    return candidate.recognises is None or candidate.recognises(path)


def _find_named(name: str) -> LabelFormat:
    if not is_one_of(name, FORMATS):
        raise ParameterError(f"format must be one of {', '.join(FORMATS)}, not {name!r}")
    return FORMATS[name]


def _format_suffix(suffix: str) -> str:
    return repr(suffix) if suffix else "without a suffix"
