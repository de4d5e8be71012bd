"""A recording and its segments as a page shows them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from kineme.errors import ParameterError
from kineme.features import Names
from kineme.labels.json_table import as_object
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from kineme.web.display import RATE, display_motion
from kineme.web.matrix import Matrix, matrix_of_motion, matrix_of_signal
from kineme.web.messages import MotionHead, Recording, Segments

Source = Motion | Signals | ArrayLike


@dataclass(frozen=True, eq=False)
class Footage:
    """All that a page draws of a recording, whatever becomes of its segments.

    Parameters
    ----------
    n_frames, fps : of the recording
    motion : how to read ``binary``; None for signals
    binary : the poses, see :mod:`kineme.web.display`; empty for signals
    matrix : Matrix
    """

    n_frames: int
    fps: float
    motion: MotionHead | None
    binary: bytes
    matrix: Matrix


def footage(source: Source, *, fps: float | None = None, effectors: Names | None = None) -> Footage:
    """What a page draws of a motion, of signals, or of an array (frames, channels) at ``fps``.

    Raises
    ------
    ParameterError : an array without frame rate, or of another shape
    """
    if isinstance(source, Motion):
        head, binary = display_motion(source, effectors=effectors)
        matrix = matrix_of_motion(source, effectors=effectors)
        return Footage(source.n_frames, source.fps, head, binary, matrix)
    if isinstance(source, Signals):
        values = np.array(source.values)
        for start, stop in source.gaps:
            values[start:stop] = np.nan
        return Footage(len(values), source.fps, None, b"", matrix_of_signal(values, source.fps))
    if fps is None:
        raise ParameterError("an array does not tell its frame rate: give fps")
    matrix = matrix_of_signal(source, fps)
    return Footage(len(np.asarray(source)), float(fps), None, b"", matrix)


def recording(
    shown: Footage, segmentation: Segmentation, *, name: str, band: int | None = None
) -> Recording:
    """The message that goes with the binary parts of a report.

    Parameters
    ----------
    shown : Footage
    segmentation : of the same recording
    name : what people call it
    band : of the tiles that go along, see `Matrix.kept`

    Raises
    ------
    ParameterError : the segments are of a recording of another length or frame rate
    """
    frames, fps = segmentation.n_frames, segmentation.fps
    if frames != shown.n_frames or not np.isclose(fps, shown.fps, rtol=1e-6, atol=0):
        raise ParameterError(
            f"the segments are of {frames} frames at {fps:g} Hz, the recording is of "
            f"{shown.n_frames} frames at {shown.fps:g} Hz: give the table of this recording"
        )
    return {
        "id": "report",
        "name": name,
        "n_frames": shown.n_frames,
        "fps": shown.fps,
        "motion": shown.motion,
        "matrix": shown.matrix.head(band),
        "segmentation": cast(Segments, as_object(segmentation)),
        "revision": 0,
        "can_undo": False,
        "can_redo": False,
        "saved": "",
        "warnings": _warnings(shown),
    }


def _warnings(shown: Footage) -> list[str]:
    motion = shown.motion
    if motion is None or motion["sample_fps"] >= min(RATE, shown.fps):
        return []
    rate = motion["sample_fps"]
    return [f"so that the page stays small, the figure moves {rate:.3g} times a second"]
