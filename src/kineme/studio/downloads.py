"""Segments as a file to download: written to a folder of its own, which is gone afterwards."""

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
from kineme.studio.choices import download_suffix
from kineme.web.page_data import Shown

MAIN_SUFFIX = {"bids": ".tsv", "ms-tcn": ".txt"}
"""Of the main file, where what is downloaded is several."""


def table_file(
    segmentation: Segmentation, stem: str, name: str, level: Level | None
) -> tuple[str, bytes]:
    """The segments in a label format.

    Parameters
    ----------
    segmentation : Segmentation
    stem : str
        Of the recording's file.
    name : str
        Of the format.
    level : {"activity", "primitive"}, optional
        Of the segments to write, in formats that do not always hold both.

    Returns
    -------
    name : str
        Of the file.
    content : bytes
        A ZIP where the format is several files.

    Raises
    ------
    ParameterError
        No such format.
    """
    if name not in FORMATS or not FORMATS[name].writes:
        raise ParameterError(f"there is no format {name!r:.40}")
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        # MS-TCN writes a mapping one folder up, the others stay in their own.
        place = Path(folder) / "groundTruth" if name == "ms-tcn" else Path(folder)
        place.mkdir(exist_ok=True)
        path = place / f"{stem}{MAIN_SUFFIX.get(name) or download_suffix(name)}"
        chosen = None if FORMATS[name].holds == "all" else level
        write_segments(segmentation, path, format=name, level=chosen)
        if name == "csv":  # spreadsheets read one file; JSON and Parquet hold the rest
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
    recording: Shown, segmentation: Segmentation, file: Path, effectors: Names | None
) -> tuple[str, bytes]:
    """Name and bytes of a page that shows the recording in a file, and its segments."""
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        page = Path(folder) / f"{file.stem}.html"
        write_report(recording, segmentation, page, name=file.name, effectors=effectors)
        return _one_file(Path(folder), file.stem)


def _one_file(folder: Path, stem: str) -> tuple[str, bytes]:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    if len(files) == 1:
        return files[0].name, files[0].read_bytes()
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as parts:
        for path in files:
            parts.write(path, path.relative_to(folder))
    return f"{stem}.zip", packed.getvalue()
