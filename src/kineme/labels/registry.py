"""Read and write segments in any label format, found by its name, the content or the suffix.

A format is one object (`LabelFormat`), below the functions that read and write it. The
package's own are named here and imported when first asked for; other packages add theirs
by `register`, or by naming the object in the entry point group ``kineme.label_formats``.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isclose
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
from kineme.labels.spans import Labels, as_segmentation, convert_clock_times
from kineme.recordings.clock import Clock
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

Read = Callable[[Path], Segmentation | Labels]
Holds = Literal["all", "levels", "level"]
Write = Callable[[Sequence[Segment], Segmentation, Path], None]


@dataclass(frozen=True)
class LabelFormat:
    """One way of keeping segments in a file.

    Parameters
    ----------
    name : str
        What ``format=`` and the command line call it.
    help : str
        What it is for, in a few words; shown wherever formats are offered.
    suffixes : tuple of str
        Suffixes of such files, in lower case and with the dot, the usual one first. Several
        formats may share one: what a file holds then decides, see ``recognises``.
    holds : {"all", "levels", "level"}
        The whole segmentation; the labels of both levels; or those of one level at a time.
    read : callable
        From a path to a `Segmentation`, or to `Labels` where frame rate, length or gaps
        remain to be filled in. Raises `ReadError`; an `OSError` or `UnicodeDecodeError`
        becomes one.
    write : callable, optional
        ``write(segments, segmentation, path)`` leaves the given segments of a segmentation at
        a path. None: the format is only read.
    recognises : callable, optional
        Whether a file (a path with one of the suffixes) holds labels in this format and is
        no recording. None: the suffix is enough.
    written_suffix : str, optional
        The suffix as it is written, where that is not the first of ``suffixes``.
    several : bool
        Whether it is several files that belong together; to download, they are packed.
    folder : str, optional
        Name of the folder that the file must lie in.

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
        """Suffix of what is taken away: of the file, or of several packed into one."""
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
"""In the order in which they are shown, and tried."""


def label_formats() -> Mapping[str, LabelFormat]:
    """Return the label formats by name, the package's own first.

    Returns
    -------
    Mapping of str to LabelFormat
        In the order in which they are shown, and tried.

    Examples
    --------
    >>> list(label_formats())[:3]
    ['csv', 'json', 'parquet']
    """
    return FORMATS


def register(new: LabelFormat, *, replace: bool = False) -> None:
    """Make a format known to `read_segments`, `write_segments`, command line and studio.

    Parameters
    ----------
    new : LabelFormat
        What is added.
    replace : bool
        Whether it takes the place of a format of the same name.

    Raises
    ------
    ParameterError
        There is a format of this name, or it is none.

    Examples
    --------
    >>> register(label_formats()["csv"], replace=True)
    >>> label_formats()["csv"].suffixes
    ('.csv', '.tsv')
    """
    FORMATS.register(new, replace=replace)


def list_written_suffixes() -> tuple[str, ...]:
    """Return the suffixes by which `write_segments` knows a format.

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
    """Write a segmentation in a format; all of it, or nothing.

    Parameters
    ----------
    segmentation : Segmentation
        What to write.
    path : path-like
        The file; its suffix tells the format where ``format`` does not.
    format : str, optional
        A name in `kineme.labels.label_formats`.
    level : {"activity", "primitive"}, optional
        Of the segments to write; by default both in formats that hold both, else
        ``activity``. The package's own formats always hold both.

    Raises
    ------
    ParameterError
        No such format or level.
    WriteError
        Unknown suffix, something the format cannot hold, or the file cannot be written.
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
    """Return the segmentation in a file of any label format.

    Parameters
    ----------
    path : path-like
        The file. Where ``format`` is not given, its suffix tells the format; where several
        share one (a ``.txt`` is Audacity's, or one label per frame), what it holds does.
    format : str, optional
        A name in `kineme.labels.label_formats`.
    fps : float, optional
        Frame rate of the recording, for formats that do not tell it.
    n_frames : int, optional
        Length of the recording, where the last label may end before it.
    clock : Clock, optional
        That of the recording (``provenance.clock``), with `fps` and `n_frames`: labels in seconds
        are by it, and those in a pause or outside the recording are left out.

    Returns
    -------
    Segmentation
        What no label covers is a transition.

    Raises
    ------
    ParameterError
        No such format, or a frame rate or length that is not positive.
    ReadError
        Missing, damaged, of another format, of a newer version; or at odds with ``fps`` or
        ``n_frames``.
    MissingDependencyError
        Parquet without pyarrow.

    Warns
    -----
    KinemeWarning
        Labels were left out or joined; once a file, with everything worth knowing.

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
    rate = content.fps
    if isinstance(content, Labels):
        if clock is not None and fps is not None and n_frames is not None:
            content = convert_clock_times(content, clock, length_s=n_frames / fps)
        with translate_read_errors(path):
            content, unusual = as_segmentation(
                content, Path(path), label_format.name, fps=fps, n_frames=n_frames
            )
        if unusual:
            warnings.warn(f"{path}: {'; '.join(unusual)}", KinemeWarning, stacklevel=2)
    if fps is not None and rate is not None and not isclose(rate, fps, rel_tol=1e-6):
        raise ReadError(path, f"says {rate:g} frames per second, but fps is {fps:g}")
    if n_frames is not None and content.n_frames != n_frames:
        raise ReadError(path, f"is of {content.n_frames} frames, but n_frames is {n_frames}")
    if clock is None or "clock" in content.provenance:
        return content
    return replace(content, provenance={**content.provenance, "clock": clock.to_json()})


def read_content(
    path: str | PathLike[str], name: str | None = None
) -> tuple[LabelFormat, Segmentation | Labels]:
    """Return the format of a file and what it holds by itself, before anything is filled in."""
    label_format = find_read_format(path, name)
    with translate_read_errors(path):
        return label_format, label_format.read(Path(path))


def find_read_format(path: str | PathLike[str], name: str | None = None) -> LabelFormat:
    """Return the format in which a file is read: the one named, else by its content and suffix."""
    if name is not None:
        return _find_named(name)
    fitting, suffix = _find_by_suffix(path), Path(path).suffix.lower()
    if not fitting and not Path(path).exists():
        raise ReadError(path, "there is no such file")
    if not fitting:
        every = (known for candidate in FORMATS.values() for known in candidate.suffixes)
        stored = ", ".join(dict.fromkeys(every))
        raise ReadError(path, f"segments are stored as {stored}, not {_format_suffix(suffix)}")
    fitting.sort(key=lambda candidate: candidate.written_suffix.lower() != suffix)
    return next((each for each in fitting if _recognises(each, Path(path))), fitting[0])


def find_write_format(path: str | PathLike[str], name: str | None = None) -> LabelFormat:
    """Return format in which a file is written: the one named, else the first with its suffix."""
    fitting = _find_by_suffix(path) if name is None else [_find_named(name)]
    writers = [candidate for candidate in fitting if candidate.write]
    suffix, stored = Path(path).suffix.lower(), ", ".join(list_written_suffixes())
    if writers:
        # One that writes this suffix comes before one that only reads it.
        return min(writers, key=lambda candidate: candidate.written_suffix.lower() != suffix)
    if fitting:
        raise WriteError(path, f"{fitting[0].name} is only read: segments go into {stored}")
    raise WriteError(path, f"segments are stored as {stored}, not {_format_suffix(suffix)}")


def holds_labels(path: str | PathLike[str]) -> bool:
    """Return whether a file is one that labels are kept in, by its suffix and its first bytes.

    Parameters
    ----------
    path : path-like
        A file; a recording in a format that labels share (CSV, Parquet) is none.

    Returns
    -------
    bool
        False, too, where the file cannot be opened.

    Examples
    --------
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> holds_labels(bundled_truth()), holds_labels(bundled_recording())
    (True, False)
    """
    target = Path(path)
    if target.name.endswith(".provenance.json"):  # of the table beside it
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
