"""Segments as a file to download: written to a folder of its own, which is gone afterwards."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from io import BytesIO
from pathlib import Path

from kineme._checks import is_text
from kineme.clips.split import split, write_clips
from kineme.errors import ParameterError
from kineme.labels import label_formats, write_segments
from kineme.report.page import write_report
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level
from kineme.studio.choices import CLIPS, REPORT
from kineme.studio.http.bodies import safe_name
from kineme.studio.open_recording import OpenRecording


def exported(opened: OpenRecording, kind: str, level: Level | None) -> tuple[str, bytes]:
    """Name and bytes of what is downloaded of a recording.

    ``kind`` is a label format, or one of `kineme.studio.choices`: motion files, a page.
    """
    loaded, table, stem = opened.loaded, opened.table, _stem_of(opened)
    if kind == CLIPS:
        motion = loaded.motion
        return _written(stem, lambda to: split(motion, table, to / stem, level=level or "activity"))
    if kind == REPORT:
        stem, name = loaded.path.stem, loaded.path.name
        page = partial(write_report, loaded.recording, table, name=name, effectors=loaded.effectors)
        return _written(stem, lambda to: page(to / f"{stem}.html"))
    return table_file(table, stem, kind, level)


def table_file(
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
    return _written(stem, write, None if found.several else file)


def clip_files(opened: OpenRecording, rows: Sequence[int], *, loops: bool) -> tuple[str, bytes]:
    """Name and bytes of a ZIP with a motion file for each of some rows of the table."""
    table, stem = opened.table, _stem_of(opened)
    if not rows or not all(0 <= row < len(table) for row in rows):
        raise ParameterError("choose the segments to write: some of these are not in the table")
    clips = [(opened.loaded.recording, [table.table[row] for row in rows])]
    return _written(stem, lambda to: write_clips(clips, to / stem, loops=loops))


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


def _stem_of(opened: OpenRecording) -> str:
    """What downloads are called after: the recording, in letters that archives can hold."""
    stem = opened.path.stem
    return stem if is_text(stem) else safe_name(stem)


def _written(
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
        return together(files, stem)
