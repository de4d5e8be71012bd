"""Which files of a folder are recordings: by suffix, and by head where that tells too little.

No file is read whole, and most are not opened: a folder of hours of recordings
is listed at once. Opened are

- tables, whose rows are frames unless their columns name spans or events (``start_s``,
  ``onset``);
- npz archives, whose directory names ``poses``, ``positions``, a time, a rate or the
  coordinates of a joint;
- JSON and text, which may hold anything and are recordings only if a format knows their
  first bytes, or those and the last ones of JSON: sets of COCO often begin with their images.

A video that lies beside a recording of its name shows that recording, and is none of its own; the
poses that were estimated from a video are read with it.

A file that cannot be judged (damaged, gone, closed to us) is passed over with its name and
the reason; it never ends the listing.
"""

from __future__ import annotations

import os
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from kineme._util.checks import format_count
from kineme._util.files import POSES, read_head, read_tail
from kineme.errors import ReadError
from kineme.formats.columns import list_joints
from kineme.formats.dialects import find_table, recognise_table
from kineme.formats.files import FileContent
from kineme.formats.keypoints.openpose import list_frame_files
from kineme.formats.label_tables import find_label_program
from kineme.formats.registry import is_video, recognises_safely, supported_formats
from kineme.recordings.times import is_timing

SPANS = (b"start_s", b"start_frame", b"onset", b"start", b"behavior", b"behavior type")
"""Columns of tables whose rows are spans or events, in lower case."""

ROWS, COLUMNS = 3, 2
"""Of numbers at least in a text that is listed as a recording."""

_SKELETONS = {".asf"}  # belong to the AMC beside them
_ANYTHING = {".json", ".txt", ".dat"}


@dataclass(frozen=True)
class Listing:
    """What a folder holds: recordings by name, those of a folder before those deeper in it.

    What was passed over, and why, are files and folders that cannot be opened or are damaged, and
    frames beside recordings.
    """

    recordings: list[Path]
    folders: list[Path]  # that were not looked into
    passed_over: list[tuple[Path, str]]


def scan_folder(folder: Path, *, recursive: bool = False) -> Listing:
    """Return the recordings in a folder, and where ``recursive`` in its folders.

    A folder with nothing but the frames of a video, a file each, is one recording.

    Examples
    --------
    >>> from kineme import bundled_recording
    >>> [path.name for path in scan_folder(bundled_recording().parent).recordings]
    ['exercises.bvh']
    """
    found = Listing([], [], [])

    def closed(error: OSError) -> None:
        found.passed_over.append((Path(error.filename), _describe_error(error)))

    for place, names, files in os.walk(folder, onerror=closed):
        names[:] = sorted(name for name in names if not name.startswith("."))
        here = Path(place)
        recordings = drop_duplicates(list(_find_recordings(here, files, found)))
        try:
            frames = list_frame_files(here)
        except OSError as error:
            closed(error)
            frames = []
        if frames:  # a video beside them shows them
            recordings = [path for path in recordings if not is_video(path)]
        if frames and recordings:
            reason = (
                f"{format_count(len(frames), 'frame')} of OpenPose beside other recordings: give "
                "them a folder of their own"
            )
            found.passed_over.append((frames[0][1], reason))
        found.recordings.extend(recordings or ([here] if frames else []))
        if not recursive:
            found.folders.extend(here / name for name in names)
            break
    return found


def list_files(folder: Path) -> list[Path]:
    """Return the files of a folder in the order of their names, without hidden ones."""
    found = [path for path in folder.iterdir() if not path.name.startswith(".")]
    return sorted((path for path in found if path.is_file()), key=lambda path: path.name)


def holds_recording(path: Path) -> bool:
    """Return whether a file is a recording, by suffix and head; none where it is damaged."""
    try:
        return _is_recording(path)
    except Exception:  # noqa: BLE001 (whatever is wrong with a file, it is no recording)
        return False


def _find_recordings(folder: Path, names: list[str], found: Listing) -> Iterator[Path]:
    """Yield the recordings among files; what cannot be judged is noted in ``found``."""
    for name in sorted(names):
        path = folder / name
        if name.startswith("."):
            continue
        try:
            if path.is_symlink() and not path.exists():
                found.passed_over.append((path, "is a link to a file that is not there"))
            elif path.is_file() and _is_recording(path):
                yield path
        except Exception as error:  # noqa: BLE001 (one file never ends a listing)
            found.passed_over.append((path, _describe_error(error)))


def drop_duplicates(recordings: list[Path]) -> list[Path]:
    """Return the recordings without what another one of them shows or holds already.

    These are videos that lie beside a recording of the same name, and poses of a video in the list.
    """
    videos = {path.name for path in recordings if is_video(path)}
    stems = {path.stem for path in recordings if path.name not in videos}
    return [
        path
        for path in recordings
        if not (path.name in videos and path.stem in stems)
        and path.name.removesuffix(POSES) not in videos - {path.name}
    ]


def _is_recording(path: Path) -> bool:
    suffix = path.suffix.lower()
    formats = [each for each in supported_formats() if each.read and suffix in each.suffixes]
    if not formats or suffix in _SKELETONS:
        return False
    if suffix in _ANYTHING:
        ends = read_head(path) + (read_tail(path) if suffix == ".json" else b"")
        is_known = any(recognises_safely(each.name, each.recognises, ends) for each in formats)
        return is_known or (suffix != ".json" and _is_text_table(path))
    if suffix in (".csv", ".tsv"):
        return not _has_span_columns(path)
    if suffix == ".parquet":
        tail = read_tail(path)
        return not any(name in tail for name in SPANS[:2])
    return suffix != ".npz" or _has_motion_arrays(path)


def _is_text_table(path: Path) -> bool:
    """Return whether a text has named columns of numbers, and is no list of labels."""
    if _has_span_columns(path):
        return False
    head = read_head(path)
    try:
        table, dialect = recognise_table(FileContent(path, head[: head.rfind(b"\n") + 1]))
        if dialect:
            return True
        rows, columns = table.numbers().shape
    except ReadError:
        return False
    is_named = not any(name[:1].isdigit() for name in table.names)
    return is_named and rows >= ROWS and columns >= COLUMNS


def _has_span_columns(path: Path) -> bool:
    if find_label_program(read_head(path).decode(errors="replace")):
        return True
    try:
        names = find_table(FileContent(path, read_head(path))).names
    except ReadError:  # not a line: an error for who reads it
        return False
    return any(name.lower().encode() in SPANS for name in names)


def _has_motion_arrays(path: Path) -> bool:
    with path.open("rb") as file, zipfile.ZipFile(file) as archive:
        names = [name.removesuffix(".npy") for name in archive.namelist()]
    return (
        not {"poses", "positions"}.isdisjoint(names)
        or any(map(is_timing, names))
        or bool(list_joints(names))
    )


def _describe_error(error: Exception) -> str:
    if isinstance(error, OSError):
        return f"cannot be opened: {error.strerror or error}"
    return f"is damaged: {' '.join(str(error).split()) or type(error).__name__}"
