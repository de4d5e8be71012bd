"""Turn segments into clips: cut, loop, rank, and move root motion."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np

from kineme._util.arrays import Masks
from kineme._util.checks import check_flag, is_number, is_one_of
from kineme.clips import RootMotionMode
from kineme.clips.loops import (
    Carry,
    LoopQuality,
    find_carry,
    make_loop,
    measure_distances,
    measure_loop,
    measure_usual_steps,
    repeat_first_frame,
)
from kineme.clips.root_motion import (
    RootMotion,
    Tag,
    extract_root_motion,
    measure_root_motion,
    measure_travel,
    remove_root_motion,
    straighten,
)
from kineme.cycles.contacts import stands_from_positions
from kineme.cycles.joints import find_feet
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import PARTS, compute_body_frame, end_effectors
from kineme.recordings import Motion
from kineme.recordings.arrays import list_spans, mark_spans, to_samples
from kineme.recordings.carriers import find_still_joints
from kineme.recordings.operations import cut, resample
from kineme.segments.table import Segment

Feet = Mapping[str, tuple[tuple[int, ...], Masks]]
"""Points of each foot, and a mask of the frames in which it is planted, by side."""


@dataclass(frozen=True)
class Shape:
    """Options for processing clips after cutting; `kineme.clips.split.split` documents them."""

    loops: bool = False
    best: int | None = None
    root_motion: RootMotionMode = "keep"
    straight: bool = False
    mirror: bool = False
    close: bool = False
    fps: float | None = None

    def __post_init__(self) -> None:
        for name in ("loops", "straight", "mirror", "close"):
            check_flag(getattr(self, name), name)
        if not is_one_of(self.root_motion, get_args(RootMotionMode)):
            modes = ", ".join(get_args(RootMotionMode))
            raise ParameterError(f"root_motion is {self.root_motion!r:.60}: choose from {modes}")
        best = self.best
        if best is not None:
            if not is_number(best) or best != int(best) or best < 1:
                raise ParameterError(f"best is {best!r:.60}: give a number of loops, at least 1")
            if not self.loops:
                raise ParameterError("best needs loops: add loops (--loop)")
        if self.close and not self.loops:
            raise ParameterError("closed needs loops: add loops (--loop)")
        if self.fps is not None and not (is_number(self.fps) and self.fps > 0):
            raise ParameterError(f"fps is {self.fps!r:.60}: give frames per second, above 0")

    @property
    def changes(self) -> tuple[str, ...]:
        """Return the names of the changes in the manifest."""
        applied = (
            ("in place", self.root_motion == "in-place"),
            ("root bone", self.root_motion == "extract"),
            ("straight", self.straight),
            ("mirror", self.mirror),
            ("close", self.close),
        )
        return tuple(name for name, done in applied if done)


@dataclass(frozen=True)
class ClipDetails:
    """What is known of a clip; ``index`` is that of its segment.

    Only loops have a ``carry``, ``quality`` and ``rank``. Clips of signals have no other optional
    fields either.
    """

    index: int
    segment: Segment
    n_frames: int
    fps: float
    carry: Carry | None = None
    quality: LoopQuality | None = None
    rank: int | None = None
    root: RootMotion | None = None
    planted: Mapping[str, Sequence[tuple[int, int]]] | None = None
    poses: Mapping[str, Mapping[str, Any]] | None = None
    tags: tuple[Tag, ...] = ()


@dataclass(frozen=True)
class RankedLoop:
    """A possible loop: index of its segment, rank in its cluster, and quality."""

    index: int
    rank: int
    quality: LoopQuality
    speed_m_s: float = 0.0


def shape_clips(
    motion: Motion, rows: Sequence[Segment], shape: Shape, loops: Sequence[RankedLoop] | None = None
) -> Iterator[tuple[ClipDetails, Motion]]:
    """Yield the clips of the segments, in their order.

    Only the best loops are included if requested. With ``loops``, already ranked, only these are.
    """
    motion, spans = _resample_rows(motion, rows, shape.fps)
    feet, travel = find_planted_feet(motion), measure_travel(motion)
    if loops is None:
        qualities = measure_loops(motion, spans, feet) if shape.loops else {}
        # Rank all candidates of a cluster, even if only the best are written.
        ranks = _rank_candidates(spans, qualities)
    else:
        qualities = {each.index: each.quality for each in loops}
        ranks = {each.index: each.rank for each in loops}
    for index, (row, span) in enumerate(zip(rows, spans, strict=True)):
        rank = ranks.get(index)
        wanted = shape.best is None or (rank is not None and rank <= shape.best)
        if not wanted or (loops is not None and rank is None):
            continue
        clip, carry, root = _shape_motion(motion, span, shape, is_loop=index in qualities)
        # Computed before the first frame is repeated, so that `last` is the end of the round.
        poses = _describe_end_poses(clip)
        if shape.close and carry is not None:
            clip = repeat_first_frame(clip, carry)
        start, stop = span.start_frame, span.stop_frame
        # Spans of frames of the clip in which each foot is planted.
        planted = {side: list_spans(mask[start:stop]) for side, (_, mask) in feet.items()}
        details = ClipDetails(
            index,
            row,
            n_frames=clip.n_frames,
            fps=clip.fps,
            carry=carry,
            quality=qualities.get(index),
            rank=rank,
            root=root,
            planted=planted or None,
            poses=poses,
            tags=travel.tags(start, stop) if travel else (),
        )
        yield details, clip


def _resample_rows(
    motion: Motion, rows: Sequence[Segment], fps: float | None
) -> tuple[Motion, Sequence[Segment]]:
    """Return the motion at a rate, and the segments in its frames, at least one frame each.

    Borders are rounded to whole frames, so that loops have a whole number of frames.
    """
    if fps is None or fps == motion.fps:
        return motion, rows
    ratio, motion = fps / motion.fps, resample(motion, fps)
    spans = []
    for row in rows:
        start, stop = to_samples((row.start_frame, row.stop_frame), ratio, motion.n_frames)
        spans.append(replace(row, start_frame=start, stop_frame=stop))
    return motion, spans


def list_ranked_loops(motion: Motion, rows: Sequence[Segment]) -> list[RankedLoop]:
    """Return all possible loops, grouped by cluster and sorted by rank."""
    qualities = measure_loops(motion, rows, find_planted_feet(motion))
    loops = []
    for index, rank in _rank_candidates(rows, qualities).items():
        clip = cut(motion, rows[index].start_frame, rows[index].stop_frame)
        speed = measure_root_motion(clip, find_carry(clip)).speed
        loops.append(RankedLoop(index, rank, qualities[index], speed))
    return loops


def make_preview_loop(motion: Motion, row: Segment) -> tuple[Motion, Carry]:
    """Return one round of a segment as a loop with its first frame repeated, and its carry.

    Equals the written loop without further options.
    """
    closed, carry = make_loop(cut(motion, row.start_frame, row.stop_frame))
    return repeat_first_frame(closed, carry), carry


def measure_loops(motion: Motion, rows: Sequence[Segment], feet: Feet) -> dict[int, LoopQuality]:
    """Return the quality of each possible loop by index of its segment."""
    body = list(motion.skeleton.body)  # exclude root bones, which may not move
    # The usual steps are those of the whole recording, not of the clip.
    usual, found = measure_usual_steps(motion.positions[:, body]), dict[int, LoopQuality]()
    for members in _group_candidates(rows).values():
        clips = [cut(motion, rows[index].start_frame, rows[index].stop_frame) for index in members]
        # In place, so that candidates with different paths can be compared.
        still = [remove_root_motion(clip, find_carry(clip))[0] for clip in clips]
        distances = measure_distances([clip.positions[:, body] for clip in still])
        for index, clip, unlike in zip(members, clips, distances, strict=True):
            row = rows[index]
            closed, carry = make_loop(clip)
            of_clip = [
                # Joints are counted within the body, and frames within the clip.
                ([body.index(point) for point in points], mask[row.start_frame : row.stop_frame])
                for points, mask in feet.values()
            ]
            found[index] = measure_loop(
                clip.positions[:, body],
                closed.positions[:, body],
                carry,
                motion.fps,
                usual=usual,
                feet=of_clip,
                unlike=unlike,
            )
    return found


def find_planted_feet(motion: Motion) -> Feet:
    """Return the frames in which each foot is planted; empty if no foot is found."""
    feet: dict[str, tuple[tuple[int, ...], Masks]] = {}
    for side, points in find_feet(motion).items():
        stands = stands_from_positions([motion.positions[:, j] for j in points], motion.fps)
        frames = np.rint(stands * motion.fps).astype(int).tolist()
        feet[side] = points, mark_spans(frames, motion.n_frames)
    return feet


def _group_candidates(rows: Sequence[Segment]) -> dict[Hashable, list[int]]:
    """Return the indices of segments that can become loops, grouped by cluster or label."""
    groups: defaultdict[Hashable, list[int]] = defaultdict(list)
    for index, row in enumerate(rows):
        # A loop needs two frames for a speed at the seam.
        if row.kind != "transition" and row.stop_frame - row.start_frame >= 2:
            groups[row.label if row.cluster < 0 else row.cluster].append(index)
    return groups


def _rank_candidates(
    rows: Sequence[Segment], qualities: Mapping[int, LoopQuality]
) -> dict[int, int]:
    """Return the rank of each loop in its cluster, by index of its segment: 1 for the best."""
    ranks: dict[int, int] = {}
    for members in _group_candidates(rows).values() if qualities else ():
        # The stable sort keeps earlier candidates first at equal cost.
        ranked = sorted(members, key=lambda index: qualities[index].cost)
        ranks |= {index: rank for rank, index in enumerate(ranked, 1)}
    return ranks


def _shape_motion(
    motion: Motion, span: Segment, shape: Shape, *, is_loop: bool
) -> tuple[Motion, Carry | None, RootMotion]:
    """Return the clip of a segment in the requested shape, its carry if it is a loop, its root."""
    clip, carry = cut(motion, span.start_frame, span.stop_frame), None
    if is_loop:
        # Loops have a carry of exactly one round after blending.
        clip, carry = make_loop(clip)
    root = measure_root_motion(clip, carry)
    if shape.straight:
        clip, carry = straighten(clip, carry)
        # The path changed, and with it the root motion.
        root = measure_root_motion(clip, carry)
    if shape.root_motion == "extract":
        clip = extract_root_motion(clip, carry)
    elif shape.root_motion == "in-place":
        # A root bone that moves elsewhere in the recording is moved with the body here too.
        clip, root = remove_root_motion(clip, carry, find_still_joints(motion))
        carry = carry and Carry(0.0, 0.0, 0.0)
    return clip, carry, root


def _describe_end_poses(clip: Motion) -> dict[str, dict[str, Any]] | None:
    """Return first and last pose: head, hands, feet relative to the pelvis, and its height."""
    try:
        ends = end_effectors(clip)
        # First and last frame only.
        relative = compute_body_frame(clip, ends.indices)[[0, -1]]
    except (EndEffectorError, MotionError):
        return None
    heights = clip.positions[[0, -1], clip.skeleton.carrier, 1]
    return {
        name: {"height_m": float(height), **dict(zip(PARTS, pose.tolist(), strict=True))}
        for name, height, pose in zip(("first", "last"), heights, relative, strict=True)
    }
