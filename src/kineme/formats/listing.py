"""Find the recordings in a folder by suffix, and by first bytes if the suffix is ambiguous.

No file is read whole and most are not opened, so a folder with hours of recordings is listed
immediately. Files that are opened:

- tables, whose rows are frames unless their columns are spans or events (``start_s``, ``onset``);
- npz archives, whose directory lists ``poses``, ``positions``, a time, a rate or joint coordinates;
- JSON and text, which are recordings only if a format recognises their first bytes.

A video next to a recording of the same name shows that recording and is not listed itself. Poses
that were estimated from a video are read with the video.

Files that cannot be judged (damaged, deleted or unreadable) are skipped with a reason and never
stop the listing.

Tables of labels by ELAN and BORIS share suffixes with recordings; their first bytes tell.
"""

from __future__ import annotations

import codecs
import os
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from kineme._util.checks import format_count
from kineme._util.files import HEAD, POSES, TAIL, read_head, read_tail
from kineme.errors import ReadError
from kineme.formats.dialects import find_table, recognise_table
from kineme.formats.files import FileContent
from kineme.formats.keypoints.openpose import list_frame_files
from kineme.formats.label_columns import holds_spans
from kineme.formats.registry import is_video, recognises_safely, supported_formats
from kineme.recordings.column_names import group_axes
from kineme.recordings.times import is_timing

SEGMENT_COLUMNS = (b"start_s", b"start_frame")
"""Columns of kineme's tables of segments."""

EVENT_COLUMNS = ("start_s", "start_frame", "onset", "start", "behavior", "behavior type")
"""Columns of which one shows that rows are spans or events, even without stops and labels."""

MIN_ROWS, MIN_COLUMNS = 3, 2
"""Minimum size of a table of numbers in a text file that is listed as a recording."""

_SKELETONS = {".asf"}  # belong to the AMC next to them
_AMBIGUOUS = {".json", ".txt", ".dat"}  # may hold anything
_ELAN_HEADER = re.compile(r"(?:begin|end) time - (?:hh:mm:ss\.ms|ss\.msec|msec|\S+)", re.IGNORECASE)
_CLOCK_TIME = r"\d+:\d\d:\d\d\.\d{1,3}"
_SECONDS = r"\d+(?:\.\d+)?"
_ELAN_ROW = re.compile(
    # tier, participant (may be empty), begin, end, duration (optional), text
    rf"(?!{_SECONDS}\t)[^\t]+\t[^\t]*(?:\t(?:{_CLOCK_TIME}|{_SECONDS})){{2,}}\t[^\t]*[^\d\s][^\t]*"
)


@dataclass(frozen=True)
class Listing:
    """Recordings in a folder by name; those of a folder come before those of its subfolders.

    ``passed_over`` lists skipped paths with the reason: files and folders that cannot be opened or
    are damaged, and frames next to recordings.
    """

    recordings: list[Path]
    folders: list[Path]  # not searched
    passed_over: list[tuple[Path, str]]


def scan_folder(folder: Path, *, recursive: bool = False) -> Listing:
    """Return the recordings in a folder and, if ``recursive``, in its subfolders.

    A folder that holds only the frames of a video, one file each, is one recording.

    Examples
    --------
    >>> from kineme import bundled_recording
    >>> [path.name for path in scan_folder(bundled_recording().parent).recordings]
    ['exercises.bvh']
    """
    listing = Listing([], [], [])

    def skip(error: OSError) -> None:
        listing.passed_over.append((Path(error.filename), _describe_error(error)))

    for folder_path, names, files in os.walk(folder, onerror=skip):
        names[:] = sorted(name for name in names if not name.startswith("."))
        current = Path(folder_path)
        recordings = drop_duplicates(list(_find_recordings(current, files, listing)))
        try:
            frames = list_frame_files(current)
        except OSError as error:
            skip(error)
            frames = []
        if frames:  # a video next to them shows the same recording
            recordings = [path for path in recordings if not is_video(path)]
        if frames and recordings:
            reason = (
                f"{format_count(len(frames), 'frame')} of OpenPose next to other "
                "recordings: put them into their own folder"
            )
            listing.passed_over.append((frames[0][1], reason))
        listing.recordings.extend(recordings or ([current] if frames else []))
        if not recursive:
            listing.folders.extend(current / name for name in names)
            break
    return listing


def list_files(folder: Path) -> list[Path]:
    """Return the files of a folder ordered by name, without hidden ones."""
    paths = [path for path in folder.iterdir() if not path.name.startswith(".")]
    return sorted((path for path in paths if path.is_file()), key=lambda path: path.name)


def holds_recording(path: Path) -> bool:
    """Return whether a file is a recording, by suffix and first bytes; False if it is damaged."""
    try:
        return _is_recording(path)
    except Exception:  # noqa: BLE001 (a damaged file is not a recording)
        return False


def _find_recordings(folder: Path, names: list[str], listing: Listing) -> Iterator[Path]:
    """Yield the recordings among files; add files that cannot be judged to ``listing``."""
    for name in sorted(names):
        path = folder / name
        if name.startswith("."):
            continue
        try:
            if path.is_symlink() and not path.exists():
                listing.passed_over.append((path, "is a link to a missing file"))
            elif path.is_file() and _is_recording(path):
                yield path
        except Exception as error:  # noqa: BLE001 (one file must not stop the listing)
            listing.passed_over.append((path, _describe_error(error)))


def drop_duplicates(recordings: list[Path]) -> list[Path]:
    """Return the recordings without videos and poses of recordings that are listed already.

    These are videos next to a recording of the same name, and poses of a listed video.
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
    """Return whether a file is a recording, by its suffix or, if that is ambiguous, its bytes."""
    suffix = path.suffix.lower()
    formats = [each for each in supported_formats() if each.read and suffix in each.suffixes]
    if not formats or suffix in _SKELETONS:
        return False
    if suffix in _AMBIGUOUS:
        head = read_head(path)
        is_known = any(recognises_safely(each.name, each.recognises, head) for each in formats)
        return is_known or (suffix != ".json" and _is_text_table(path))
    # Tables and archives also hold labels and other arrays.
    if suffix in (".csv", ".tsv"):
        return not _has_span_columns(path)
    if suffix == ".parquet":
        # The names of its columns are at the end of the file.
        tail = read_tail(path)
        return not any(name in tail for name in SEGMENT_COLUMNS)
    return suffix != ".npz" or _has_motion_arrays(path)


def _is_text_table(path: Path) -> bool:
    """Return whether a text has named columns of numbers and is not a table of labels."""
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
    return is_named and rows >= MIN_ROWS and columns >= MIN_COLUMNS


def _has_span_columns(path: Path) -> bool:
    if find_label_program(read_head(path).decode(errors="replace")):
        return True
    try:
        names = find_table(FileContent(path, read_head(path))).names
    except ReadError:  # an empty file: reading it reports the error
        return False
    return holds_spans(names) or any(name.lower() in EVENT_COLUMNS for name in names)


def _has_motion_arrays(path: Path) -> bool:
    with path.open("rb") as file, zipfile.ZipFile(file) as archive:
        names = [name.removesuffix(".npy") for name in archive.namelist()]
    return (
        not {"poses", "positions"}.isdisjoint(names)
        or any(map(is_timing, names))
        or bool(group_axes(names))
    )


def _describe_error(error: Exception) -> str:
    if isinstance(error, OSError):
        return f"cannot be opened: {error.strerror or error}"
    return f"is damaged: {' '.join(str(error).split()) or type(error).__name__}"


def is_elan_table(head: str) -> bool:
    """Return whether a text starts like a tab-delimited export of ELAN, with or without names."""
    lines = [line.strip("\r") for line in head.splitlines() if line.strip()]
    lines = [line for line in lines if not line.startswith('"#')]
    if not lines:
        return False
    return len(_ELAN_HEADER.findall(lines[0])) >= 2 or all(map(_ELAN_ROW.fullmatch, lines[:2]))


def is_boris_table(head: str) -> bool:
    """Return whether a text starts like an export of events from BORIS."""
    cells = {cell.strip('"') for cell in re.split(r"[,\t\r\n]", head)}
    return "Behavior" in cells and ("Time" in cells or {"Start (s)", "Stop (s)"} <= cells)


def find_label_program(head: str) -> str | None:
    """Return the program whose table of labels starts with this text, or None."""
    return "ELAN" if is_elan_table(head) else "BORIS" if is_boris_table(head) else None


def refuse_segments(content: FileContent) -> None:
    """Raise ReadError if a file holds segments: kineme's own tables, or tiers of ELAN or Praat."""
    head = content.data[:HEAD].removeprefix(codecs.BOM_UTF8)
    first_line = head.partition(b"\n")[0]
    names = {name.strip(b'" \r') for name in re.split(rb"[,;\t]", first_line)}
    if (
        names >= {b"start_frame", b"stop_frame", b"level", b"cluster"}
        or b'"kineme.segments/' in head
        or (head.startswith(b"PAR1") and b"kineme.segments/" in content.data[-TAIL:])
        or content.path.suffix.lower() in (".eaf", ".textgrid")
    ):
        raise content.error(
            "is a table of segments, not a recording: give the recording instead. Commands such "
            "as report, cycles and split take this file with --segments"
        )


def refuse_labels(content: FileContent) -> None:
    """Raise ReadError if a text file holds labels."""
    if program := find_label_program(content.text[:HEAD]):
        raise content.error(
            f"holds labels of {program}, not a recording: read it with "
            "kineme.read_segments, or use kineme convert with --fps"
        )
