"""Which label formats there are, and which of them a file is in.

The package's own are named here and imported when first asked for; other packages add theirs
by `register`, or by naming the object in the entry point group ``kineme.label_formats``.
"""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path

from kineme._util.checks import Registry, is_one_of
from kineme.errors import ParameterError, ReadError, WriteError
from kineme.labels.label_format import LabelFormat

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
