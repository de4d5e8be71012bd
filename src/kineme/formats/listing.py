"""Which files are recordings, which hold labels, which a knowledge base: by suffix and head.

No file is read whole: a folder of hours of recordings is listed at once.
"""

from __future__ import annotations

import zipfile
from pathlib import Path

from kineme.errors import ReadError
from kineme.formats.keypoints.openpose import frame_files
from kineme.formats.registry import supported_formats

LABELS = (".csv", ".tsv", ".json", ".parquet", ".txt", ".eaf", ".textgrid")
LABEL_COLUMNS = (b"start_s", b"start_frame", b"onset", b"start", b"behavior", b"behavior type")
LABEL_WORDS = (b'"kineme.segments/', b'"trials"', b'"seq_ann"', b'"frame_ann"', b"seg_id")
HEAD = 4096


def recordings_in(folder: Path) -> list[Path]:
    """The recordings in a folder, in the order of their names, not those deeper in it.

    The folder itself where it is one recording, with a file for each frame.

    Raises
    ------
    ReadError : there are none, or the folder cannot be opened
    """
    try:
        if frame_files(folder):
            return [folder]
        found = [path for path in files_in(folder) if holds_motion(path)]
    except OSError as error:
        raise ReadError(folder, f"cannot be opened: {error.strerror or error}") from error
    if not found:
        raise ReadError(folder, "there is no recording in this folder")
    return found


def files_in(folder: Path) -> list[Path]:
    """The files of a folder in the order of their names, without hidden ones."""
    found = [path for path in folder.iterdir() if not path.name.startswith(".")]
    return sorted((path for path in found if path.is_file()), key=lambda path: path.name)


def holds_motion(path: Path) -> bool:
    """Whether a file is a recording: by its suffix, and where labels have the same, its head."""
    suffix = path.suffix.lower()
    formats = [known for known in supported_formats() if known.read and suffix in known.suffixes]
    if not formats or suffix == ".asf":  # the skeleton of an AMC beside it
        return False
    if suffix == ".json":  # which may hold anything
        return any(known.recognises(_head(path)) for known in formats)
    if suffix in LABELS:
        return not _speaks_of_labels(path)
    return not (suffix == ".npz" and holds_knowledge(path))


def holds_labels(path: Path) -> bool:
    """Whether a file is one that labels are kept in."""
    suffix = path.suffix.lower()
    if suffix in (".eaf", ".textgrid", ".txt"):
        return True
    if path.name.endswith(".provenance.json"):  # of the table beside it
        return False
    return suffix in LABELS and _speaks_of_labels(path)


def holds_knowledge(path: Path) -> bool:
    """Whether a file is a knowledge base of :mod:`kineme.transfer`."""
    if path.suffix.lower() != ".npz":
        return False
    try:
        with zipfile.ZipFile(path) as parts:
            return {"head.npy", "lengths.npy", "labels.npy"} <= set(parts.namelist())
    except (OSError, zipfile.BadZipFile):
        return False


def _speaks_of_labels(path: Path) -> bool:
    head = _head(path)
    if path.suffix.lower() == ".json":
        return any(word in head for word in LABEL_WORDS)
    if path.suffix.lower() == ".parquet":
        return b"kineme.segments" in _tail(path)
    first = head.removeprefix(b"\xef\xbb\xbf").split(b"\n", 1)[0].lower().replace(b"\t", b",")
    return any(name.strip(b' "\r') in LABEL_COLUMNS for name in first.split(b","))


def _head(path: Path) -> bytes:
    """The first bytes of a file; none if it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(HEAD)
    except OSError:
        return b""


def _tail(path: Path) -> bytes:
    """The last bytes, where Parquet keeps what it knows of itself."""
    try:
        with path.open("rb") as file:
            file.seek(max(0, path.stat().st_size - 16 * HEAD))
            return file.read()
    except OSError:
        return b""
