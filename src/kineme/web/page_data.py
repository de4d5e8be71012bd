"""Collect what a page shows of a recording and its segments."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from kineme.errors import ParameterError
from kineme.features import Names
from kineme.features.similarity import SimilarityMatrix, compare_frames, compare_frames_of_signal
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from kineme.web.display import RATE, display_motion
from kineme.web.matrix import make_head
from kineme.web.messages import MotionHead, Recording, TableAtDetail
from kineme.web.tables import find_marks, make_rows, make_segments_message

MAX_ROWS = 12_000
"""Rows of all detail tables in a report, about 200 bytes each."""
Shown = Motion | Signals | ArrayLike


@dataclass(frozen=True, eq=False)
class PageData:
    """Everything that a page draws of a recording except the segments.

    ``motion`` tells how to read the poses in ``binary`` (`kineme.web.display`); signals have
    neither.
    """

    n_frames: int
    fps: float
    motion: MotionHead | None
    binary: bytes
    matrix: SimilarityMatrix
    warnings: list[str] = field(default_factory=list)


def make_page_data(
    recording: Shown, *, fps: float | None = None, effectors: Names | None = None
) -> PageData:
    """Return the page data of a motion, signals, or an array (frames, channels) with its rate.

    ParameterError for an array without a frame rate or with another shape.

    Examples
    --------
    >>> make_page_data([[0.0], [1.0], [0.0]], fps=10.0).n_frames
    3
    """
    if isinstance(recording, Motion | Signals):
        head, binary = None, b""
        if isinstance(recording, Motion):
            head, binary = display_motion(recording, effectors=effectors)
        matrix = compare_frames(recording, effectors=effectors)
        warned = [str(note) for note in recording.provenance.warnings]
        return PageData(
            recording.n_frames,
            recording.fps,
            motion=head,
            binary=binary,
            matrix=matrix,
            warnings=warned,
        )
    if fps is None:
        raise ParameterError("an array has no frame rate: give fps")
    matrix = compare_frames_of_signal(recording, fps)
    return PageData(len(np.asarray(recording)), float(fps), motion=None, binary=b"", matrix=matrix)


def make_recording_message(
    data: PageData, segmentation: Segmentation, *, name: str, levels: bool = False
) -> Recording:
    """Return the message about a recording and its segments.

    With ``levels`` it includes the tables at all details, unless they are too long. ParameterError
    if the segments have another length or frame rate than the recording.
    """
    frames, fps = segmentation.n_frames, segmentation.fps
    if frames != data.n_frames or not np.isclose(fps, data.fps, rtol=1e-6, atol=0):
        raise ParameterError(
            f"the segments have {frames} frames at {fps:g} Hz, but the recording has "
            f"{data.n_frames} frames at {data.fps:g} Hz: give the table of this recording"
        )
    return Recording(
        id="report",
        name=name,
        n_frames=data.n_frames,
        fps=data.fps,
        motion=data.motion,
        matrix=make_head(data.matrix),
        segmentation=make_segments_message(segmentation),
        levels=_list_detail_tables(segmentation) if levels else [],
        video=None,
        read_options={},
        revision=0,
        can_undo=False,
        can_redo=False,
        saved="",
        warnings=_list_warnings(data),
    )


def _list_detail_tables(segmentation: Segmentation) -> list[TableAtDetail]:
    """Return the tables at all details; empty if there is one only, or if they are too long."""
    hierarchy = segmentation.hierarchy
    if hierarchy is None or sum(map(len, hierarchy.tables)) > MAX_ROWS:
        return []
    note = segmentation.annotation
    tables = zip(hierarchy.details, hierarchy.tables, strict=True)
    return [
        TableAtDetail(detail=detail, segments=make_rows(table, find_marks(table, note)))
        for detail, table in tables
    ]


def _list_warnings(data: PageData) -> list[str]:
    motion = data.motion
    if motion is None or motion.sample_fps >= min(RATE, data.fps):
        return data.warnings
    rate = motion.sample_fps
    slow = f"to keep the page small, the figure moves {rate:.3g} times per second"
    return [*data.warnings, slow]
