"""Segments as a file to download: written to a folder of its own, which is gone afterwards.

A download is called after the recording and what of it is in it, so that none takes the place of
another: ``walk.segments.csv``, ``walk.activities.boris.csv``, ``walk.loops.zip``.
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

LEVELS: Mapping[Level | None, str] = {
    None: "segments",
    "activity": "activities",
    "primitive": "primitives",
}
PACKED = ".zip"


def export_download(opened: OpenRecording, kind: str, level: Level | None) -> tuple[str, bytes]:
    """Name and bytes of what is downloaded of a recording.

    ``kind`` is a label format, or one of `kineme.studio.choices`: motion files, a page.
    """
    loaded, table, stem = opened.loaded, opened.table, _choose_stem(opened)
    if kind == CLIPS:
        motion, of_level = loaded.motion, level or "activity"
        found = _write_to_bytes(stem, lambda to: split(motion, table, to / stem, level=of_level))
        return _name_download(stem, _describe_content(kind, of_level), found)
    if kind == REPORT:
        name = opened.listed.name
        shown = drop_other_people(loaded.recording)
        page = partial(write_report, shown, table, name=name, effectors=loaded.effectors)
        return _name_download(
            stem, kind, _write_to_bytes(stem, lambda to: page(to / f"{stem}.html"))
        )
    return make_table_file(_add_video(opened), stem, kind, level)


def export_several(
    opened: Sequence[OpenRecording], stem: str, kind: str, level: Level | None
) -> tuple[str, bytes]:
    """Name and bytes of a ZIP with what is downloaded of each of some recordings.

    Of tables as CSV there is one of all of them, too, with a column ``recording``.
    """
    files = [export_download(each, kind, level) for each in opened]
    what = files[0][0].removeprefix(_choose_stem(opened[0])).removesuffix(PACKED)
    if kind == "csv":
        names = [each.listed.called.name for each in opened]
        tables = [content for _, content in files]
        files.append((f"{stem}.all{what}", join_csv_tables(names, tables)))
    return make_archive(files, f"{stem}.checked{what}")


def join_csv_tables(names: Sequence[str], tables: Sequence[bytes]) -> bytes:
    """Tables in CSV as one, the name of its recording in each row."""
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
    """Name and bytes of the segments in a label format; a ZIP where that is several files.

    ``level`` is for formats that do not always hold both.
    """
    found = label_formats().get(name)
    if found is None or found.write is None:
        raise ParameterError(f"there is no format {name!r:.40}")
    file, of_level = f"{stem}{found.written_suffix}", None if found.holds == "all" else level

    def write(to: Path) -> None:
        place = to / found.folder
        place.mkdir(exist_ok=True)
        write_segments(segmentation, place / file, format=name, level=of_level)

    # Where it is one file, that holds as provenance what else lies there.
    content = _write_to_bytes(stem, write, None if found.several else file)
    shown = "activity" if found.holds == "level" and of_level is None else of_level
    return _name_download(stem, _describe_content(name, shown), content)


def make_clip_archive(
    opened: OpenRecording, rows: Sequence[int], *, loops: bool
) -> tuple[str, bytes]:
    """Name and bytes of a ZIP with a motion file for each of some rows of the table."""
    table, stem = opened.table, _choose_stem(opened)
    if not rows or not all(0 <= row < len(table) for row in rows):
        raise ParameterError("choose the segments to write: some of these are not in the table")
    clips = [(opened.loaded.recording, [table.table[row] for row in rows])]
    found = _write_to_bytes(stem, lambda to: write_clips(clips, to / stem, loops=loops))
    return _name_download(stem, "loops" if loops else "clips", found)


def make_archive(files: Iterable[tuple[str, bytes]], stem: str) -> tuple[str, bytes]:
    """Several files as one ZIP; a name that comes again gets a number."""
    packed, names = BytesIO(), set[str]()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as parts:
        for name, content in files:
            path, number = Path(name), 2
            while name in names:
                name = f"{path.stem}_{number}{path.suffix}"  # noqa: PLW2901
                number += 1
            names.add(name)
            parts.writestr(name, content)
    return f"{stem}{PACKED}", packed.getvalue()


def _choose_stem(opened: OpenRecording) -> str:
    """Return what downloads are called after: the recording, in letters that archives can hold."""
    stem = opened.listed.called.stem
    return stem if is_text(stem) else make_safe_name(stem)


def _add_video(opened: OpenRecording) -> Segmentation:
    """Return the table, and in its provenance the video of the recording, if there is one."""
    video = find_video(opened.path)
    if video is None:
        return opened.table
    place = {"path": str(video), "offset_s": read_video_offset(opened.path)}
    return replace(opened.table, provenance={**opened.table.provenance, "video": place})


def _describe_content(kind: str, level: Level | None) -> str:
    """What a download holds: which segments, and the format where its suffix is also another's."""
    formats = label_formats()
    suffix = formats[kind].download_suffix if kind in formats else PACKED
    first = next((name for name, each in formats.items() if each.download_suffix == suffix), kind)
    is_clear = kind == first and suffix != PACKED
    return LEVELS[level] if is_clear else f"{LEVELS[level]}.{kind}"


def _name_download(stem: str, what: str, file: tuple[str, bytes]) -> tuple[str, bytes]:
    """Return the file under the name of a download."""
    name, content = file
    return f"{stem}.{what}{Path(name).suffix}", content


def _write_to_bytes(
    stem: str, write: Callable[[Path], object], name: str | None = None
) -> tuple[str, bytes]:
    """Name and bytes of what is written to a folder, or of the file of that name alone.

    Several files are a ZIP.
    """
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        write(Path(folder))
        found = [path for path in sorted(Path(folder).rglob("*")) if path.is_file()]
        paths = [path for path in found if name in (None, path.name)]
        if len(paths) == 1:
            return paths[0].name, paths[0].read_bytes()
        files = ((path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths)
        return make_archive(files, stem)
