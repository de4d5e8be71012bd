"""Segments as a file to download: written to a folder of its own, which is gone afterwards."""

from __future__ import annotations

import tempfile
import zipfile
from io import BytesIO
from pathlib import Path

from kineme.clips.split import split
from kineme.errors import ParameterError
from kineme.features import Names
from kineme.labels import label_formats, write_segments
from kineme.recordings import Motion
from kineme.report.page import write_report
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level
from kineme.web.page_data import Shown


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
    known = label_formats().get(name)
    if known is None or known.write is None:
        raise ParameterError(f"there is no format {name!r:.40}")
    with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
        place = Path(folder) / known.folder
        place.mkdir(exist_ok=True)
        path = place / f"{stem}{known.written_suffix}"
        write_segments(
            segmentation, path, format=name, level=None if known.holds == "all" else level
        )
        if not known.several:  # what else lies there, as a CSV's provenance, other formats hold
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


def _one_file(folder: Path, stem: str) -> tuple[str, bytes]:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    if len(files) == 1:
        return files[0].name, files[0].read_bytes()
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as parts:
        for path in files:
            parts.write(path, path.relative_to(folder))
    return f"{stem}.zip", packed.getvalue()
