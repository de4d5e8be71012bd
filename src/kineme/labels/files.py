"""write_segments() and read_segments(): any format, by its name, content or suffix."""

from __future__ import annotations

import warnings
from dataclasses import replace
from math import isclose
from os import PathLike
from pathlib import Path

from kineme._util.checks import check_path, check_type, is_number
from kineme._util.files import translate_read_errors
from kineme.errors import KinemeWarning, ParameterError, ReadError, WriteError
from kineme.labels.registry import LabelFormat, format_to_read, format_to_write
from kineme.labels.spans import Labels, as_segmentation, convert_clock_times
from kineme.recordings.clock import Clock
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level


def write_segments(
    segmentation: Segmentation,
    path: str | PathLike[str],
    *,
    format: str | None = None,  # noqa: A002 (what everybody calls it)
    level: Level | None = None,
) -> None:
    """Write a segmentation in a format; all of it, or nothing.

    Parameters
    ----------
    segmentation : Segmentation
        What to write.
    path : path-like
        The file; its suffix tells the format where ``format`` does not.
    format : str, optional
        A name in `kineme.labels.label_formats`.
    level : {"activity", "primitive"}, optional
        Of the segments to write; by default both in formats that hold both, else
        ``activity``. The package's own formats always hold both.

    Raises
    ------
    ParameterError
        No such format or level.
    WriteError
        Unknown suffix, something the format cannot hold, or the file cannot be written.
    MissingDependencyError
        Parquet without pyarrow.

    Examples
    --------
    >>> import kineme, tempfile
    >>> from kineme.datasets import bundled_truth
    >>> segments = kineme.read_segments(bundled_truth())
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     kineme.write_segments(segments, f"{folder}/take.eaf")
    ...     kineme.read_segments(f"{folder}/take.eaf").n_frames
    2898
    """
    check_type(segmentation, Segmentation, "write_segments", "kineme.segment(motion) gives one")
    check_path(path, "write_segments")
    label_format = format_to_write(path, format)
    if label_format.holds == "all" and level is not None:
        raise ParameterError(
            f"{label_format.name} always holds both levels: leave out level={level!r}"
        )
    if level is None and label_format.holds == "level":
        level = "activity"
    rows = list(segmentation if level is None else segmentation.level(level))
    if not rows:
        raise WriteError(path, f"there are no segments of level {level!r}")
    if label_format.write is not None:
        label_format.write(rows, segmentation, Path(path))


def read_segments(
    path: str | PathLike[str],
    *,
    format: str | None = None,  # noqa: A002
    fps: float | None = None,
    n_frames: int | None = None,
    clock: Clock | None = None,
) -> Segmentation:
    """Return the segmentation in a file of any label format.

    Parameters
    ----------
    path : path-like
        The file. Where ``format`` is not given, its suffix tells the format; where several
        share one (a ``.txt`` is Audacity's, or one label per frame), what it holds does.
    format : str, optional
        A name in `kineme.labels.label_formats`.
    fps : float, optional
        Frame rate of the recording, for formats that do not tell it.
    n_frames : int, optional
        Length of the recording, where the last label may end before it.
    clock : Clock, optional
        That of the recording (``provenance.clock``), with `fps` and `n_frames`: labels in seconds
        are by it, and those in a pause or outside the recording are left out.

    Returns
    -------
    Segmentation
        What no label covers is a transition.

    Raises
    ------
    ParameterError
        No such format, or a frame rate or length that is not positive.
    ReadError
        Missing, damaged, of another format, of a newer version; or at odds with ``fps`` or
        ``n_frames``.
    MissingDependencyError
        Parquet without pyarrow.

    Warns
    -----
    KinemeWarning
        Labels were left out or joined; once a file, with everything worth knowing.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> kineme.read_segments(bundled_truth()).activities.label[:3].tolist()
    ['walk', '', 'squat']
    """
    check_path(path, "read_segments")
    if fps is not None and not (is_number(fps) and fps > 0):
        raise ParameterError(f"fps is {fps!r:.60}: give frames per second, above 0")
    if n_frames is not None and not (is_number(n_frames) and n_frames >= 1):
        raise ParameterError(f"n_frames is {n_frames!r:.60}: a recording has at least 1 frame")
    label_format, content = read_content(path, format)
    rate = content.fps
    if isinstance(content, Labels):
        if clock is not None and fps is not None and n_frames is not None:
            content = convert_clock_times(content, clock, length_s=n_frames / fps)
        with translate_read_errors(path):
            content, unusual = as_segmentation(
                content, Path(path), label_format.name, fps=fps, n_frames=n_frames
            )
        if unusual:
            warnings.warn(f"{path}: {'; '.join(unusual)}", KinemeWarning, stacklevel=2)
    if fps is not None and rate is not None and not isclose(rate, fps, rel_tol=1e-6):
        raise ReadError(path, f"says {rate:g} frames per second, but fps is {fps:g}")
    if n_frames is not None and content.n_frames != n_frames:
        raise ReadError(path, f"is of {content.n_frames} frames, but n_frames is {n_frames}")
    if clock is None or "clock" in content.provenance:
        return content
    return replace(content, provenance={**content.provenance, "clock": clock.to_json()})


def read_content(
    path: str | PathLike[str], name: str | None = None
) -> tuple[LabelFormat, Segmentation | Labels]:
    """Return the format of a file and what it holds by itself, before anything is filled in."""
    label_format = format_to_read(path, name)
    with translate_read_errors(path):
        return label_format, label_format.read(Path(path))
