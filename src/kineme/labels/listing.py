"""Which files labels are kept in: by suffix and head, without reading them whole."""

from __future__ import annotations

from pathlib import Path

from kineme.formats.files import HEAD, head_of

LABELS = (".csv", ".tsv", ".json", ".parquet", ".txt", ".eaf", ".textgrid")
LABEL_COLUMNS = (b"start_s", b"start_frame", b"onset", b"start", b"behavior", b"behavior type")
LABEL_WORDS = (b'"kineme.segments/', b'"trials"', b'"seq_ann"', b'"frame_ann"', b"seg_id")


def holds_labels(path: Path) -> bool:
    """Whether a file is one that labels are kept in.

    Parameters
    ----------
    path : Path

    Returns
    -------
    bool
        False where the file cannot be read.
    """
    suffix = path.suffix.lower()
    if suffix in (".eaf", ".textgrid", ".txt"):
        return True
    if path.name.endswith(".provenance.json"):  # of the table beside it
        return False
    return suffix in LABELS and _speaks_of_labels(path)


def _speaks_of_labels(path: Path) -> bool:
    head = head_of(path)
    if path.suffix.lower() == ".json":
        return any(word in head for word in LABEL_WORDS)
    if path.suffix.lower() == ".parquet":
        return b"kineme.segments" in _tail(path)
    first = head.removeprefix(b"\xef\xbb\xbf").split(b"\n", 1)[0].lower().replace(b"\t", b",")
    return any(name.strip(b' "\r') in LABEL_COLUMNS for name in first.split(b","))


def _tail(path: Path) -> bytes:
    """The last bytes, where Parquet keeps what it knows of itself."""
    try:
        with path.open("rb") as file:
            file.seek(max(0, path.stat().st_size - 16 * HEAD))
            return file.read()
    except OSError:
        return b""
