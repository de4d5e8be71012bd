"""Which files are recordings, which hold labels, which a knowledge base: by suffix and head.

No file is read whole: a folder of hours of recordings is listed at once.
"""

from __future__ import annotations

import os
import zipfile
from dataclasses import dataclass
from pathlib import Path

from kineme.formats.files import HEAD, head_of
from kineme.formats.keypoints.openpose import frame_files
from kineme.formats.registry import supported_formats

LABELS = (".csv", ".tsv", ".json", ".parquet", ".txt", ".eaf", ".textgrid")
LABEL_COLUMNS = (b"start_s", b"start_frame", b"onset", b"start", b"behavior", b"behavior type")
LABEL_WORDS = (b'"kineme.segments/', b'"trials"', b'"seq_ann"', b'"frame_ann"', b"seg_id")


@dataclass(frozen=True)
class Listing:
    """What a folder holds.

    Parameters
    ----------
    recordings : list of Path
        In the order of their names, those of a folder before those deeper in it.
    folders : list of Path
        Folders in it that were not looked into.
    passed_over : list of (Path, str)
        What was left out, and why: folders that cannot be opened, frames beside recordings.
    """

    recordings: list[Path]
    folders: list[Path]
    passed_over: list[tuple[Path, str]]


def recordings_in(folder: Path, *, recursive: bool = False) -> Listing:
    """The recordings in a folder; with ``recursive`` those of its folders, too.

    A folder with nothing but the frames of a video, a file each, is one recording.
    """
    found = Listing([], [], [])

    def closed(error: OSError) -> None:
        reason = f"cannot be opened: {error.strerror or error}"
        found.passed_over.append((Path(error.filename), reason))

    for place, names, _ in os.walk(folder, onerror=closed):
        names[:] = sorted(name for name in names if not name.startswith("."))
        here = Path(place)
        recordings, frames = [f for f in files_in(here) if holds_motion(f)], frame_files(here)
        if frames and recordings:
            reason = (
                f"{len(frames)} frames of OpenPose beside other recordings: give them a folder "
                "of their own"
            )
            found.passed_over.append((frames[0][1], reason))
        found.recordings.extend(recordings or ([here] if frames else []))
        if not recursive:
            found.folders.extend(here / name for name in names)
            break
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
        return any(known.recognises(head_of(path)) for known in formats)
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
