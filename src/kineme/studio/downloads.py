"""Segments as a file to take away: written to a folder of its own, which is gone afterwards."""

from __future__ import annotations

import tempfile
import zipfile
from io import BytesIO
from pathlib import Path

from kineme.clips.split import split
from kineme.errors import ParameterError
from kineme.features import Names
from kineme.labels import FORMATS, write_segments
from kineme.recordings import Motion
from kineme.report.page import write_report
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level
from kineme.studio.choices import FORMAT_HELP, SUFFIXES
from kineme.web.recording import Source

PLAIN = {"bids": ".tsv", "ms-tcn": ".txt"}
"""Suffixes of the main file, where what is taken away is several."""


def table_file(
    segmentation: Segmentation, stem: str, name: str, level: Level | None
) -> tuple[str, bytes]:
    """Name and bytes of the segments in a format; of several files a ZIP.

    Parameters
    ----------
    stem : of the recording's file
    name : of the format
    level : of the segments to write, in formats that do not hold both always

    Raises
    ------
    ParameterError : no such format
    """
    if name not in FORMAT_HELP:
        raise ParameterError(f"there is no format {name!r:.40}")
    known = FORMATS[name]
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        # MS-TCN keeps a mapping one folder up, the others keep to their own.
        place = Path(folder) / "groundTruth" if name == "ms-tcn" else Path(folder)
        place.mkdir(exist_ok=True)
        suffix = PLAIN.get(name) or SUFFIXES.get(name) or known.suffixes[0]
        path = place / f"{stem}{suffix}"
        chosen = None if known.holds == "all" else level
        write_segments(segmentation, path, format=name, level=chosen)
        if name == "csv":  # spreadsheets take one file; JSON and Parquet hold the rest
            path.with_suffix(".provenance.json").unlink(missing_ok=True)
        return _one_file(Path(folder), stem)


def motion_files(
    motion: Motion, segmentation: Segmentation, stem: str, level: Level | None
) -> tuple[str, bytes]:
    """Name and bytes of a ZIP with a motion file for each segment, and their list."""
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        split(motion, segmentation, Path(folder) / stem, level=level or "activity")
        return _one_file(Path(folder), stem)


def report_file(
    source: Source, segmentation: Segmentation, recording: Path, effectors: Names | None
) -> tuple[str, bytes]:
    """Name and bytes of a page that shows the recording and its segments."""
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        page = Path(folder) / f"{recording.stem}.html"
        write_report(source, segmentation, page, name=recording.name, effectors=effectors)
        return _one_file(Path(folder), recording.stem)


def _one_file(folder: Path, stem: str) -> tuple[str, bytes]:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    if len(files) == 1:
        return files[0].name, files[0].read_bytes()
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as parts:
        for path in files:
            parts.write(path, path.relative_to(folder))
    return f"{stem}.zip", packed.getvalue()
