"""What there is to open: the files of a folder, each known to the page by an id.

An id says nothing and is good for nothing but to find one of the files that
are listed at that moment, so that no request can name any other.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterable
from hashlib import blake2b
from pathlib import Path

from kineme.formats import supported_formats
from kineme.studio.storage import usual_tables

LABELS = (".csv", ".tsv", ".json", ".parquet", ".txt", ".eaf", ".textgrid")
LABEL_COLUMNS = (b"start_s", b"start_frame", b"onset", b"start", b"behavior", b"behavior type")
LABEL_WORDS = (b'"kineme.segments/', b'"trials"', b'"seq_ann"', b'"frame_ann"', b"seg_id")
HEAD = 4096


def file_id(path: Path) -> str:
    """The id of a file: the same for as long as it lies there."""
    return blake2b(str(path.absolute()).encode(errors="surrogateescape"), digest_size=9).hexdigest()


class Folder:
    """A folder, or some files of it.

    Parameters
    ----------
    root : where uploads go and where labels are looked for
    files : the recordings to list; None for all that lie in the folder
    """

    def __init__(self, root: Path, files: Iterable[Path] | None = None):
        self.root = root
        self._files = None if files is None else list(files)

    def add(self, path: Path) -> None:
        """List a file that came later."""
        if self._files is not None and path not in self._files:
            self._files.append(path)

    def recordings(self) -> dict[str, Path]:
        """The recordings by id, in the order of their names, or as given."""
        if self._files is not None:
            return {file_id(path): path for path in self._files if path.is_file()}
        return {file_id(path): path for path in self._listed() if holds_motion(path)}

    def knowledge_bases(self) -> dict[str, Path]:
        """The knowledge bases by id."""
        return {file_id(path): path for path in self._listed() if holds_knowledge(path)}

    def annotations(self) -> dict[str, Path]:
        """The label files by id, without the tables that the studio itself keeps."""
        own = {table for path in self.recordings().values() for table in usual_tables(path)}
        found = [path for path in self._listed() if path not in own and holds_labels(path)]
        return {file_id(path): path for path in found}

    def _listed(self) -> list[Path]:
        try:
            found = [path for path in self.root.iterdir() if not path.name.startswith(".")]
        except OSError:
            return []
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
