"""Segments as a file to download: written to a folder of its own, which is gone afterwards."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Iterable, Sequence
from io import BytesIO
from pathlib import Path

from kineme._checks import is_text
from kineme.clips.split import split, write_clips
from kineme.errors import ParameterError
from kineme.features import Names
from kineme.labels import label_formats, write_segments
from kineme.recordings import Motion
from kineme.report.page import write_report
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level
from kineme.studio.choices import CLIPS, REPORT
from kineme.studio.http.bodies import safe_name
from kineme.studio.open_recording import OpenRecording
from kineme.web.page_data import Shown


def exported(opened: OpenRecording, kind: str, level: Level | None) -> tuple[str, bytes]:
    """Name and bytes of what is downloaded of a recording.

    ``kind`` is a label format, or one of `kineme.studio.choices`: motion files, a page.
    """
    loaded, stem = opened.loaded, _stem_of(opened)
    if kind == CLIPS:
        return motion_files(loaded.motion, opened.table, stem, level)
    if kind == REPORT:
        return report_file(loaded.recording, opened.table, loaded.path, loaded.effectors)
    return table_file(opened.table, stem, kind, level)


def together(files: Iterable[tuple[str, bytes]], stem: str) -> tuple[str, bytes]:
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
    return f"{stem}.zip", packed.getvalue()


def clip_files(opened: OpenRecording, rows: Sequence[int], *, loops: bool) -> tuple[str, bytes]:
    """Name and bytes of a ZIP with a motion file for each of some rows of the table."""
    table = opened.table
    if not rows or not all(0 <= row < len(table) for row in rows):
        raise ParameterError("choose the segments to write: some of these are not in the table")
    segments = [table.table[row] for row in rows]
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        write_clips(
            [(opened.loaded.recording, segments)], Path(folder) / _stem_of(opened), loops=loops
        )
        return _one_file(Path(folder), _stem_of(opened))


def table_file(
    segmentation: Segmentation, stem: str, name: str, level: Level | None
) -> tuple[str, bytes]:
    """Name and bytes of the segments in a label format; a ZIP where that is several files.

    ``level`` is for formats that do not always hold both.
    """
    label_format = label_formats().get(name)
    if label_format is None or label_format.write is None:
        raise ParameterError(f"there is no format {name!r:.40}")
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        place = Path(folder) / label_format.folder
        place.mkdir(exist_ok=True)
        path = place / f"{stem}{label_format.written_suffix}"
        write_segments(
            segmentation, path, format=name, level=None if label_format.holds == "all" else level
        )
        if not label_format.several:  # other formats hold what else lies there, as provenance
            return path.name, path.read_bytes()
        return _one_file(Path(folder), stem)


def motion_files(
    motion: Motion, segmentation: Segmentation, stem: str, level: Level | None
) -> tuple[str, bytes]:
    """Name and bytes of a ZIP with a motion file for each segment, and their list."""
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        split(motion, segmentation, Path(folder) / stem, level=level or "activity")
        return _one_file(Path(folder), stem)


def report_file(
    recording: Shown, segmentation: Segmentation, file: Path, effectors: Names | None
) -> tuple[str, bytes]:
    """Name and bytes of a page that shows the recording in a file, and its segments."""
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        page = Path(folder) / f"{file.stem}.html"
        write_report(recording, segmentation, page, name=file.name, effectors=effectors)
        return _one_file(Path(folder), file.stem)


def _stem_of(opened: OpenRecording) -> str:
    """What downloads are called after: the recording, in letters that archives can hold."""
    stem = opened.path.stem
    return stem if is_text(stem) else safe_name(stem)


def _one_file(folder: Path, stem: str) -> tuple[str, bytes]:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    if len(files) == 1:
        return files[0].name, files[0].read_bytes()
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as parts:
        for path in files:
            parts.write(path, path.relative_to(folder))
    return f"{stem}.zip", packed.getvalue()
