"""Write a Rerun recording with the skeleton in 3D, and a lane of states for each level.

``body/joints`` and ``body/bones`` hold the skeleton, in metres with y up. ``segments/activity`` and
``segments/primitive`` change state at the start of each segment, with its text and the colour of
its cluster. The timelines are ``time`` in seconds and ``frame``. The text ``provenance`` holds the
provenance of the segments.

Source: https://rerun.io/docs, archetypes Points3D, LineStrips3D, StateChange; rerun-sdk 0.41.
"""

from __future__ import annotations

import json
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from kineme._util.checks import require_extra
from kineme._util.files import atomic_write
from kineme.labels.spans import format_text
from kineme.recordings import Motion
from kineme.recordings.arrays import mark_spans
from kineme.segments.display import get_cluster_color
from kineme.segments.segmentation import check_same_length
from kineme.segments.table import Level

if TYPE_CHECKING:
    from kineme.segments.segmentation import Segmentation

JOINT_RADIUS, BONE_RADIUS = 0.015, 0.008
"""Radii in metres."""


def write_rerun(
    motion: Motion, segmentation: Segmentation | None, path: str | PathLike[str]
) -> None:
    """Write a Rerun recording (``.rrd``) atomically.

    Parameters
    ----------
    motion : Motion
    segmentation : Segmentation or None
        Segments of this motion; None for the skeleton only.
    path : str or PathLike
        The file.

    Raises
    ------
    ParameterError
        The segmentation has another length.
    WriteError
        The file cannot be written.
    MissingDependencyError
        Rerun-sdk is not installed.

    Examples
    --------
    >>> import kineme
    >>> from kineme.interop.rerun_recording import write_rerun
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> write_rerun(motion, kineme.segment(motion), "walk.rrd")  # doctest: +SKIP
    """
    with require_extra("rerun-sdk", "rerun"):
        import rerun as rr
    if segmentation is not None:
        check_same_length(segmentation, motion.n_frames)
    with atomic_write(path) as draft:
        recording = rr.RecordingStream("kineme", recording_id=Path(path).stem)
        recording.save(draft, default_blueprint=_make_blueprint(segmentation is not None))
        _send_body(recording, motion)
        if segmentation is not None:
            for level in get_args(Level):
                _send_lane(recording, segmentation, level)
            text = json.dumps(segmentation.provenance, indent=1)
            recording.log("provenance", rr.TextDocument(text), static=True)
        recording.disconnect()


def _send_body(recording: Any, motion: Motion) -> None:
    """Send joints and bones of all recorded frames at once."""
    import rerun as rr

    recording.log("body", rr.ViewCoordinates.RIGHT_HAND_Y_UP, static=True)
    names = rr.Points3D.from_fields(
        radii=JOINT_RADIUS, labels=list(motion.skeleton.names), show_labels=False
    )
    recording.log("body/joints", names, static=True)
    recording.log("body/bones", rr.LineStrips3D.from_fields(radii=BONE_RADIUS), static=True)
    frames = np.flatnonzero(~mark_spans(motion.gaps, motion.n_frames))
    positions = motion.positions[frames].astype(np.float32)
    # A flat list of points, which is partitioned into frames below.
    joints = rr.Points3D.columns(positions=positions.reshape(-1, 3))
    times = _make_time_columns(frames, motion.fps)
    counts = np.full(len(frames), motion.skeleton.n_joints)
    recording.send_columns("body/joints", times, joints.partition(counts))
    children = [j for j, parent in enumerate(motion.skeleton.parents) if parent >= 0]
    if children:
        parents = [motion.skeleton.parents[j] for j in children]
        # Frames, bones, both ends, axes.
        ends = np.stack([positions[:, parents], positions[:, children]], axis=2)
        bones = rr.LineStrips3D.columns(strips=ends.reshape(-1, 2, 3))
        counts = np.full(len(frames), len(children))
        recording.send_columns("body/bones", times, bones.partition(counts))


def _send_lane(recording: Any, segmentation: Segmentation, level: Level) -> None:
    """Send the states of one level: one per segment, displayed with its text."""
    import rerun as rr

    rows = segmentation.level(level)
    if not len(rows):
        return
    values = [f"{level} {number}" for number in range(len(rows))]
    style = rr.StateConfiguration(
        values=values,
        labels=list(map(format_text, rows)),
        # RGBA as one number.
        colors=[int(get_cluster_color(row.cluster)[1:] + "FF", 16) for row in rows],
    )
    recording.log(f"segments/{level}", style, static=True)
    times = _make_time_columns(rows.start_frame, segmentation.fps)
    states = rr.StateChange.columns(state=values)
    recording.send_columns(f"segments/{level}", times, states)


def _make_time_columns(frames: Any, fps: float) -> list[Any]:
    import rerun as rr

    frames = np.asarray(frames, np.int64)
    time = rr.TimeColumn("time", duration=frames / fps)
    return [time, rr.TimeColumn("frame", sequence=frames)]


def _make_blueprint(lanes: bool) -> Any:
    import rerun.blueprint as rrb

    body = rrb.Spatial3DView(origin="body", name="body")
    if not lanes:
        return rrb.Blueprint(body)
    states = rrb.StateTimelineView(origin="segments", name="segments")
    return rrb.Blueprint(rrb.Vertical(body, states, row_shares=[3, 1]))
