"""Repetitions of a recording as loops: their quality, and how they play."""

from __future__ import annotations

from base64 import b64encode
from math import isnan

from kineme.clips.shaping import list_ranked_loops, make_preview_loop
from kineme.errors import ParameterError
from kineme.recordings import Motion
from kineme.studio.open_recording import OpenRecording
from kineme.web.display import display_motion
from kineme.web.messages import LoopRow, Loops, PlayedLoop


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
                slide_m_s=None if isnan(loop.quality.slide_m_s) else loop.quality.slide_m_s,
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


def _require_motion(opened: OpenRecording) -> Motion:
    motion = opened.loaded.recording
    if not isinstance(motion, Motion):
        raise ParameterError("signals have no pose to blend, so there are no loops")
    return motion
