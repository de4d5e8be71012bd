"""Define label formats, register them, and find the one that a file is in.

A format is one object (`LabelFormat`), at the end of the module that reads and writes it. The
package's own are named here and imported when first asked for; other packages add theirs
by `register`, or by naming the object in the entry point group ``kineme.label_formats``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Literal, get_args

from kineme._util.checks import Registry, check_one_of, check_suffixes, is_one_of
from kineme.errors import ParameterError, ReadError, WriteError
from kineme.labels.spans import Labels
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

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
        "parquet_table:FORMAT",
        "elan_table:FORMAT",
        "audacity:FORMAT",
        "elan:FORMAT",
        "textgrid:FORMAT",
        "bids:FORMAT",
        "boris:FORMAT",
        "babel:FORMAT",
        "ms_tcn:FORMAT",
        "clip_list:FORMAT",
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


def written_suffixes() -> tuple[str, ...]:
    """Return the suffixes by which `write_segments` knows a format.

    Returns
    -------
    tuple of str
        Lower case, with the dot, each once.

    Examples
    --------
    >>> written_suffixes()[:3]
    ('.csv', '.json', '.parquet')
    """
    writers = [candidate for candidate in label_formats().values() if candidate.write]
    return tuple(dict.fromkeys(candidate.written_suffix.lower() for candidate in writers))


def format_to_read(path: str | PathLike[str], name: str | None = None) -> LabelFormat:
    """Return the format in which a file is read: the one named, else by its content and suffix."""
    if name is not None:
        return _find_named(name)
    suffix = Path(path).suffix.lower()
    fitting = [candidate for candidate in label_formats().values() if suffix in candidate.suffixes]
    if not fitting and not Path(path).exists():
        raise ReadError(path, "there is no such file")
    if not fitting:
        raise ReadError(path, f"segments are stored as {_suffixes_read()}, not {_other(suffix)}")
    fitting.sort(key=lambda candidate: candidate.written_suffix.lower() != suffix)
    return next((candidate for candidate in fitting if _speaks(candidate, Path(path))), fitting[0])


def format_to_write(path: str | PathLike[str], name: str | None = None) -> LabelFormat:
    """Return format in which a file is written: the one named, else the first with its suffix."""
    if name is not None:
        chosen = _find_named(name)
        if chosen.write is None:
            stored = ", ".join(written_suffixes())
            raise WriteError(path, f"{name} is only read: segments go into {stored}")
        return chosen
    suffix = Path(path).suffix.lower()
    fitting = [candidate for candidate in label_formats().values() if suffix in candidate.suffixes]
    writers = [candidate for candidate in fitting if candidate.write]
    for candidate in writers:
        if suffix == candidate.written_suffix.lower():
            return candidate
    if writers:
        return writers[0]
    stored = ", ".join(written_suffixes())
    if fitting:
        raise WriteError(path, f"{fitting[0].name} is only read: segments go into {stored}")
    raise WriteError(path, f"segments are stored as {stored}, not {_other(suffix)}")


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
    suffix = target.suffix.lower()
    fitting = [candidate for candidate in label_formats().values() if suffix in candidate.suffixes]
    return any(_speaks(candidate, target) for candidate in fitting)


def _speaks(candidate: LabelFormat, path: Path) -> bool:
    return candidate.recognises is None or candidate.recognises(path)


def _find_named(name: str) -> LabelFormat:
    formats = label_formats()
    if not is_one_of(name, formats):
        raise ParameterError(f"format must be one of {', '.join(formats)}, not {name!r}")
    return formats[name]


def _other(suffix: str) -> str:
    return repr(suffix) if suffix else "without a suffix"


def _suffixes_read() -> str:
    every = (suffix for candidate in label_formats().values() for suffix in candidate.suffixes)
    return ", ".join(dict.fromkeys(every))
