"""Downloads of segments, clips and reports, and the repetitions of a recording played as loops.

Each download is written to a temporary folder. Its name holds the recording and the content, so
that downloads do not overwrite each other: ``walk.segments.csv``, ``walk.activities.boris.csv``,
``walk.loops.zip``.
"""

from __future__ import annotations

import csv
import tempfile
import zipfile
from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from io import BytesIO, StringIO
from pathlib import Path

from kineme._util.checks import is_text
from kineme._util.files import find_video
from kineme.clips.shaping import list_ranked_loops, make_preview_loop
from kineme.clips.split import split, write_clips
from kineme.errors import ParameterError
from kineme.formats.delimited import as_text
from kineme.labels import label_formats, write_segments
from kineme.recordings import Motion
from kineme.report.page import write_report
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level
from kineme.studio.choices import CLIPS, REPORT
from kineme.studio.http.bodies import make_safe_name
from kineme.studio.open_recording import OpenRecording
from kineme.studio.storage.sidecars import read_video_offset
from kineme.web.display import display_motion
from kineme.web.messages import LoopRow, Loops, PlayedLoop

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
        what = _describe_content(kind, clip_level)
        return _write_download(
            stem, what, lambda to: split(motion, table, to / stem, level=clip_level)
        )
    if kind == REPORT:
        write_page = partial(
            write_report,
            loaded.recording,
            table,
            name=opened.listed.name,
            effectors=loaded.effectors,
        )
        return _write_download(stem, kind, lambda to: write_page(to / f"{stem}.html"))
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

    default_level: Level | None = "activity" if label_format.holds == "level" else None
    what = _describe_content(name, written_level or default_level)
    # A format of one file may write its provenance to a second one, which is left out.
    return _write_download(stem, what, write, None if label_format.several else file)


def make_clip_archive(
    opened: OpenRecording, rows: Sequence[int], *, loops: bool
) -> tuple[str, bytes]:
    """Return name and bytes of a ZIP with a motion file for each of these rows of the table."""
    table, stem = opened.table, _choose_stem(opened)
    if not rows or not all(0 <= row < len(table) for row in rows):
        raise ParameterError("choose the segments to export: some of these are not in the table")
    clips = [(opened.loaded.recording, [table.table[row] for row in rows])]
    what = "loops" if loops else "clips"
    return _write_download(stem, what, lambda to: write_clips(clips, to / stem, loops=loops))


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


def _write_download(
    stem: str, what: str, write: Callable[[Path], object], name: str | None = None
) -> tuple[str, bytes]:
    """Write to a temporary folder; return name and bytes of the download.

    It is the file of that ``name``, or all files; several are packed into a ZIP.
    """
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        write(Path(folder))
        all_files = [path for path in sorted(Path(folder).rglob("*")) if path.is_file()]
        paths = [path for path in all_files if name in (None, path.name)]
        if len(paths) == 1:
            return f"{stem}.{what}{paths[0].suffix}", paths[0].read_bytes()
        files = ((path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths)
        return make_archive(files, f"{stem}.{what}")


def _require_motion(opened: OpenRecording) -> Motion:
    if not opened.loaded.is_motion:
        raise ParameterError("signals have no pose to blend, so there are no loops")
    return opened.loaded.motion


def rank_loops(opened: OpenRecording) -> Loops:
    """Return the quality of each repetition as a loop."""
    table, motion = opened.table, _require_motion(opened)
    numbers = [number for number, row in enumerate(table.table) if row.level == "primitive"]
    ranked = list_ranked_loops(motion, [table.table[number] for number in numbers])
    return Loops(
        loops=[
            LoopRow(
                number=numbers[loop.index],
                rank=loop.rank,
                cost=loop.quality.cost,
                pose_m=loop.quality.pose_m,
                slide_m_s=loop.quality.slide_m_s,  # nan becomes null in JSON
                turn_deg=loop.quality.turn_deg,
                speed_m_s=loop.speed_m_s,
            )
            for loop in ranked
        ]
    )


def make_played_loop(opened: OpenRecording, number: int) -> PlayedLoop:
    """Return the loop that a row of the table would be exported as."""
    table, motion = opened.table, _require_motion(opened)
    if not 0 <= number < len(table):
        raise ParameterError("choose the segment to play: this one is not in the table")
    closed, carry = make_preview_loop(motion, table.table[number])
    head, poses = display_motion(closed, effectors=opened.loaded.effectors, rate=closed.fps)
    numbers = b64encode(poses).decode()
    return PlayedLoop(motion=head, numbers=numbers, turn=carry.turn, x=carry.x, z=carry.z)
