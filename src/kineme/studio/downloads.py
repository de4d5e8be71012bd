"""Downloads of segments, clips and reports; each is written to a temporary folder.

The name holds the recording and the content, so that downloads do not overwrite each other:
``walk.segments.csv``, ``walk.activities.boris.csv``, ``walk.loops.zip``.
"""

from __future__ import annotations

import csv
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from io import BytesIO, StringIO
from pathlib import Path

from kineme._util.checks import is_text
from kineme._util.files import find_video
from kineme.clips.split import split, write_clips
from kineme.errors import ParameterError
from kineme.formats.delimited import as_text
from kineme.labels import label_formats, write_segments
from kineme.report.page import write_report
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level
from kineme.studio.choices import CLIPS, REPORT
from kineme.studio.http.bodies import make_safe_name
from kineme.studio.loading import drop_other_people
from kineme.studio.open_recording import OpenRecording
from kineme.studio.storage.sidecars import read_video_offset

LEVEL_NAMES: Mapping[Level | None, str] = {
    None: "segments",
    "activity": "activities",
    "primitive": "primitives",
}
"""Part of a download's name by the level of its segments."""
ZIP = ".zip"


def export_download(opened: OpenRecording, kind: str, level: Level | None) -> tuple[str, bytes]:
    """Return name and bytes of a download of a recording.

    ``kind`` is a label format, or one of `kineme.studio.choices`: motion files or a report.
    """
    loaded, table, stem = opened.loaded, opened.table, _choose_stem(opened)
    if kind == CLIPS:
        motion, clip_level = loaded.motion, level or "activity"
        file = _write_to_bytes(stem, lambda to: split(motion, table, to / stem, level=clip_level))
        return _name_download(stem, _describe_content(kind, clip_level), file)
    if kind == REPORT:
        name = opened.listed.name
        own_recording = drop_other_people(loaded.recording)
        write_page = partial(
            write_report, own_recording, table, name=name, effectors=loaded.effectors
        )
        return _name_download(
            stem, kind, _write_to_bytes(stem, lambda to: write_page(to / f"{stem}.html"))
        )
    return make_table_file(_add_video(opened), stem, kind, level)


def export_several(
    opened: Sequence[OpenRecording], stem: str, kind: str, level: Level | None
) -> tuple[str, bytes]:
    """Return name and bytes of a ZIP with one download per recording.

    For CSV the ZIP also has one table of all recordings, with a column ``recording``.
    """
    files = [export_download(recording, kind, level) for recording in opened]
    what = files[0][0].removeprefix(_choose_stem(opened[0])).removesuffix(ZIP)
    if kind == "csv":
        names = [recording.listed.person_path.name for recording in opened]
        tables = [content for _, content in files]
        files.append((f"{stem}.all{what}", join_csv_tables(names, tables)))
    return make_archive(files, f"{stem}.checked{what}")


def join_csv_tables(names: Sequence[str], tables: Sequence[bytes]) -> bytes:
    """Join CSV tables into one, with the name of its recording in each row."""
    joined = StringIO()
    writer = csv.writer(joined, lineterminator="\n")
    for number, (name, table) in enumerate(zip(names, tables, strict=True)):
        head, *rows = csv.reader(StringIO(table.decode("utf-8-sig")))
        writer.writerows([["recording", *head]] if not number else [])
        writer.writerows([as_text(name), *row] for row in rows)
    return joined.getvalue().encode()


def make_table_file(
    segmentation: Segmentation, stem: str, name: str, level: Level | None
) -> tuple[str, bytes]:
    """Return name and bytes of the segments in a label format; several files become a ZIP.

    ``level`` applies to formats that hold either one level or both.
    """
    label_format = label_formats().get(name)
    if label_format is None or label_format.write is None:
        raise ParameterError(f"there is no format {name!r:.40}")
    file = f"{stem}{label_format.written_suffix}"
    written_level = None if label_format.holds == "all" else level

    def write(to: Path) -> None:
        folder = to / label_format.folder
        folder.mkdir(exist_ok=True)
        write_segments(segmentation, folder / file, format=name, level=written_level)

    # A format of one file may write its provenance to a second one, which is left out.
    content = _write_to_bytes(stem, write, None if label_format.several else file)
    shown_level = (
        "activity" if label_format.holds == "level" and written_level is None else written_level
    )
    return _name_download(stem, _describe_content(name, shown_level), content)


def make_clip_archive(
    opened: OpenRecording, rows: Sequence[int], *, loops: bool
) -> tuple[str, bytes]:
    """Return name and bytes of a ZIP with a motion file for each of these rows of the table."""
    table, stem = opened.table, _choose_stem(opened)
    if not rows or not all(0 <= row < len(table) for row in rows):
        raise ParameterError("choose the segments to export: some of these are not in the table")
    clips = [(opened.loaded.recording, [table.table[row] for row in rows])]
    archive = _write_to_bytes(stem, lambda to: write_clips(clips, to / stem, loops=loops))
    return _name_download(stem, "loops" if loops else "clips", archive)


def make_archive(files: Iterable[tuple[str, bytes]], stem: str) -> tuple[str, bytes]:
    """Pack files into a ZIP; a name that occurs again gets a number."""
    packed, names = BytesIO(), set[str]()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as parts:
        for name, content in files:
            path, number = Path(name), 2
            while name in names:
                name = f"{path.stem}_{number}{path.suffix}"  # noqa: PLW2901
                number += 1
            names.add(name)
            parts.writestr(name, content)
    return f"{stem}{ZIP}", packed.getvalue()


def _choose_stem(opened: OpenRecording) -> str:
    """Return the stem of downloads: the recording's name, in characters that ZIP can hold."""
    stem = opened.listed.person_path.stem
    return stem if is_text(stem) else make_safe_name(stem)


def _add_video(opened: OpenRecording) -> Segmentation:
    """Return the table with the recording's video in its provenance, if there is one."""
    video = find_video(opened.path)
    if video is None:
        return opened.table
    entry = {"path": str(video), "offset_s": read_video_offset(opened.path)}
    return replace(opened.table, provenance={**opened.table.provenance, "video": entry})


def _describe_content(kind: str, level: Level | None) -> str:
    """Return the content part of a name: the level, and the format if its suffix is ambiguous."""
    formats = label_formats()
    suffix = formats[kind].download_suffix if kind in formats else ZIP
    first = next((name for name, each in formats.items() if each.download_suffix == suffix), kind)
    is_clear = kind == first and suffix != ZIP
    return LEVEL_NAMES[level] if is_clear else f"{LEVEL_NAMES[level]}.{kind}"


def _name_download(stem: str, what: str, file: tuple[str, bytes]) -> tuple[str, bytes]:
    """Return the file with the name of a download."""
    name, content = file
    return f"{stem}.{what}{Path(name).suffix}", content


def _write_to_bytes(
    stem: str, write: Callable[[Path], object], name: str | None = None
) -> tuple[str, bytes]:
    """Write to a temporary folder; return name and bytes of the file of that name, or of all files.

    Several files are packed into a ZIP.
    """
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        write(Path(folder))
        all_files = [path for path in sorted(Path(folder).rglob("*")) if path.is_file()]
        paths = [path for path in all_files if name in (None, path.name)]
        if len(paths) == 1:
            return paths[0].name, paths[0].read_bytes()
        files = ((path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths)
        return make_archive(files, stem)
