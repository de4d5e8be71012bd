"""Turn a route through a motion graph into a motion.

Spans of the sources are concatenated, each turned about the vertical and moved on the floor by its
jump. Around a jump both recordings continue for half a window and are blended: rotations by
spherical, translations by linear interpolation, with the weight 3w² - 2w³ (Kovar, Gleicher and
Pighin 2002, section 3.2). Finally foot sliding is removed (after Kovar, Schreiner and Gleicher
2002, Footskate cleanup).

A foot stands while its ankle is low and slow. It is then held at one position on the floor by
two-bone inverse kinematics in closed form for hip, knee and ankle. The direction of the foot and
the height of the ankle stay. The correction fades in before and out after the contact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import as_indices, check_type, format_count
from kineme.errors import EndEffectorError, ParameterError
from kineme.features import end_effectors
from kineme.features.effectors import find_low_and_slow
from kineme.recordings import Motion, Provenance
from kineme.recordings.arrays import list_spans
from kineme.recordings.carriers import (
    find_carriers,
    find_still_joints,
    to_parent_axes,
    to_world_axes,
)
from kineme.recordings.kinematics import (
    compute_local_translations,
    compute_world_rotations,
    forward_kinematics,
)
from kineme.recordings.motion import check_motion
from kineme.synthesis.graph import MotionGraph

Spans = list[tuple[int, int]]
HEIGHT = 0.06
"""Largest height of a standing ankle above its lowest 5 % of the motion, metres."""
SPEED = 0.3
"""Largest speed of a standing ankle, metres per second."""
SHORTEST = 0.1
"""Shortest contact that is corrected, seconds."""
REACH = 0.05
"""Metres of sliding after which a contact is split into a new one."""
FADE = 0.15
"""Seconds over which a correction fades in and out."""
STRAIGHT = 0.999
"""Largest extension of a leg relative to its length."""


@dataclass(frozen=True)
class Placement:
    """A turn about the vertical through the origin, then a move on the floor.

    Parameters
    ----------
    angle : float
        Radians.
    shift : complex
        Metres: x + iz.

    Examples
    --------
    >>> from kineme.synthesis import Placement
    >>> Placement(shift=1 + 2j).of(3 + 0j)
    (4+2j)
    """

    angle: float = 0.0
    shift: complex = 0j

    def after(self, angle: float, shift: tuple[float, float]) -> Placement:
        """Return the placement that applies a turn and shift first, then this placement."""
        # The new turn comes first in space: its shift is turned and moved by this placement.
        return Placement(self.angle + angle, self.of(complex(*shift)))

    def of(self, floor: complex) -> complex:
        """Return a point of the floor after the placement."""
        # Placements turn x + iz by exp(-i angle), as a turn about y does.
        return complex(np.exp(-1j * self.angle)) * floor + self.shift


@dataclass(frozen=True)
class PlacedSpan:
    """Frames [start, stop) of a source, and their placement."""

    source: int
    start: int
    stop: int
    at: Placement


def synthesize(
    graph: MotionGraph,
    motions: Sequence[Motion],
    route: Sequence[int],
    *,
    start: Placement | None = None,
    plant: bool = True,
) -> Motion:
    """Return the motion of a route, with its nodes played in order.

    Parameters
    ----------
    graph : MotionGraph
    motions : sequence of Motion
        Source motions of the graph, in order.
    route : sequence of int
        Node numbers, each connected to the next by an edge; see `kineme.synthesis.routes`.
    start : Placement, optional
        Placement of the first node; as recorded by default.
    plant : bool
        Whether to remove foot sliding.

    Raises
    ------
    ParameterError
        An empty route, nodes without an edge between them, or motions that do not match the
        graph.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> motion = kineme.read(bundled_recording())
    >>> truth = kineme.read_segments(bundled_truth(), fps=motion.fps, n_frames=motion.n_frames)
    >>> graph = kineme.motion_graph([motion], [truth], prune=False)
    >>> kineme.synthesize(graph, [motion], [0, 1, 2]).n_frames == graph.nodes[2].stop
    True
    """
    check_type(graph, MotionGraph, "synthesize", "kineme.motion_graph(motions) gives one")
    check_type(motions, Sequence, "synthesize", "give the motions of the graph")
    for each in motions:
        check_motion(each, "synthesize")
    route = as_indices(route, "the nodes of a route")
    for node in route:
        if not 0 <= node < len(graph.nodes):
            raise ParameterError(
                f"there is no node {node}: give numbers from 0 to {len(graph.nodes) - 1}"
            )
    if start is not None:
        check_type(start, Placement, "start", "leave it out to start as recorded")
    # Frame counts are a cheap check that the motions are those of the graph.
    if [m.n_frames for m in motions] != [s.n_frames for s in graph.sources]:
        raise ParameterError("the graph was built from other motions: build it again")
    spans = place_spans(graph, route, start or Placement())
    rotations, translations = _blend_spans(spans, motions, round(graph.window * graph.fps / 2))
    jumps = len(spans) - 1
    motion = Motion.from_rotations(
        motions[0].skeleton,
        rotations,
        graph.fps,
        translations=translations,
        provenance=Provenance(format="synthesis").noted(
            f"{format_count(len(route), 'primitive')}, {format_count(jumps, 'jump')}"
        ),
    )
    return plant_feet(motion) if plant else motion


def place_spans(graph: MotionGraph, route: Sequence[int], at: Placement) -> list[PlacedSpan]:
    """Return the spans to play; successive nodes of a recording are merged."""
    if not route:
        raise ParameterError("a route needs at least one node")
    first = graph.nodes[route[0]]
    spans = [PlacedSpan(first.source, first.start, first.stop, at)]
    for tail, head in pairwise(route):
        if (tail, head) not in graph.edge_between:
            raise ParameterError(f"no edge leads from node {tail} to node {head}")
        edge, node = graph.edges[graph.edge_between[tail, head]], graph.nodes[head]
        if not edge.jump:
            # The recording's own successor needs no blending: extend the span.
            spans[-1] = replace(spans[-1], stop=node.stop)
            continue
        spans[-1] = replace(spans[-1], stop=edge.leave)
        at = spans[-1].at.after(edge.angle, edge.shift)
        spans.append(PlacedSpan(node.source, edge.enter, node.stop, at))
    return spans


def find_jump_frames(spans: Sequence[PlacedSpan]) -> list[int]:
    """Return the frame of the new motion at each jump."""
    # Ends of all spans but the last.
    return list(accumulate(span.stop - span.start for span in spans))[:-1]


def _blend_spans(
    spans: Sequence[PlacedSpan], motions: Sequence[Motion], half: int
) -> tuple[Floats, Floats]:
    """Return rotations and translations of all spans, blended ``half`` frames around each jump."""
    # Blend what carries the body in world axes, and leave bones above it that stand still alone.
    still = find_still_joints(*motions)
    carriers = find_carriers(motions[0].skeleton, still)
    sources = [to_world_axes(motion, still) for motion in motions]

    def place_span(span: PlacedSpan, start: int, stop: int) -> tuple[Floats, Floats]:
        """Return rotations and translations of frames of a span's source, placed as the span."""
        rotations, shift = (each[start:stop].copy() for each in sources[span.source])
        about_y = rot.rotate_about_y(span.at.angle)
        rotations[:, carriers] = rot.multiply(about_y, rotations[:, carriers])
        shift[:, carriers] = rot.rotate(about_y, shift[:, carriers])
        shift[:, carriers] += [span.at.shift.real, 0, span.at.shift.imag]
        return rotations, shift

    placed_spans = [place_span(span, span.start, span.stop) for span in spans]
    rotations, translations = (np.concatenate(each) for each in zip(*placed_spans, strict=True))
    for t, (a, b) in zip(find_jump_frames(spans), pairwise(spans), strict=True):
        # Blends of neighbouring jumps must not overlap, and need frames of both recordings.
        room = min(a.stop - a.start, b.stop - b.start) // 2
        n = min(half, room, motions[a.source].n_frames - a.stop, b.start)
        # Extend both spans by n frames across the jump, so that 2 n frames overlap.
        before, before_shift = place_span(a, a.stop - n, a.stop + n)
        after, after_shift = place_span(b, b.start - n, b.start + n)
        # Smoothstep weights at the frame centres; the new axes are joints and components.
        w = ((np.arange(2 * n) + 0.5) / max(2 * n, 1))[:, None, None]
        w = w * w * (3 - 2 * w)
        rotations[t - n : t + n] = rot.slerp(before, after, w)
        translations[t - n : t + n] = (1 - w) * before_shift + w * after_shift
    # Bones that stand still may do so elsewhere in each source: they stay as in the first.
    rotations[:, still], translations[:, still] = (each[0, still] for each in sources[0])
    return to_parent_axes(motions[0].skeleton, rotations, translations, still)


def plant_feet(motion: Motion) -> Motion:
    """Return the motion with each standing foot held in place; unchanged if no feet are found.

    Parameters
    ----------
    motion : Motion
        With rotations.

    Examples
    --------
    >>> import kineme
    >>> from kineme.recordings.operations import cut
    >>> from kineme.synthesis import plant_feet
    >>> motion = cut(kineme.read(kineme.bundled_recording()), 0, 120)
    >>> plant_feet(motion).n_frames
    120
    """
    try:
        effectors = end_effectors(motion)
    except EndEffectorError:
        return motion
    for ankle in (effectors.left_ankle, effectors.right_ankle):
        knee = motion.skeleton.parents[ankle]
        hip = motion.skeleton.parents[knee] if knee >= 0 else -1
        if hip < 0:
            continue
        path = motion.positions[:, ankle]
        target = path + _compute_corrections(path, find_foot_contacts(path, motion.fps), motion.fps)
        # The second leg starts from the motion that the first one has changed.
        motion = _move_ankle(motion, (hip, knee, ankle), target)
    return motion


def find_foot_contacts(path: Floats, fps: float) -> Spans:
    """Return the spans [start, stop) of frames in which an ankle is low and slow.

    Parameters
    ----------
    path : (frames, 3) array
        Positions of the ankle, metres, y up.
    fps : float
        Frames per second.

    Examples
    --------
    >>> import numpy as np
    >>> from kineme.synthesis import find_foot_contacts
    >>> find_foot_contacts(np.zeros((30, 3)), 30.0)
    [(0, 30)]
    """
    if len(path) < 2:
        return []
    spans = list_spans(find_low_and_slow(path, fps, height=HEIGHT, speed=SPEED))
    return [(start, stop) for start, stop in spans if stop - start >= SHORTEST * fps]


def _compute_corrections(path: Floats, contacts: Spans, fps: float) -> Floats:
    """Return the horizontal correction of the ankle's path, (frames, 3)."""
    floor = path[:, [0, 2]]
    fade = round(FADE * fps)
    # Knots of the correction: 0 one fade before the first frame.
    frames, values = [-fade], [np.zeros(2)]
    for start, stop in _split_contacts(floor, contacts, round(SHORTEST * fps)):
        # Move to the median position, which is robust against single frames.
        offset = np.median(floor[start:stop], axis=0) - floor[start:stop]
        # Fade to 0 between distant contacts; interpolate directly between close ones.
        if start - frames[-1] > 2 * fade:
            frames += [frames[-1] + fade, start - fade]
            values += [np.zeros(2), np.zeros(2)]
        frames += range(start, stop)
        values += list(offset)
    # 0 one fade after the last hold.
    frames.append(frames[-1] + fade)
    values.append(np.zeros(2))
    at = np.arange(len(path))
    x, z = (np.interp(at, frames, column) for column in np.array(values).T)
    return np.stack([x, np.zeros(len(path)), z], axis=1)


def _split_contacts(floor: Floats, contacts: Spans, gap: int) -> Spans:
    """Split contacts where the foot has slid more than `REACH`, leaving a gap between parts."""
    holds: Spans = []
    for start, stop in contacts:
        first = start
        while first < stop:
            out_of_reach = np.linalg.norm(floor[first:stop] - floor[first], axis=1) > REACH
            # The first frame out of reach: `argmax` finds the first True.
            last = first + int(np.argmax(out_of_reach)) if out_of_reach.any() else stop
            # The gap lets the correction change gradually; each part keeps at least one frame.
            holds.append((first, max(last - gap * (last < stop), first + 1)))
            first = last
    return holds


def _move_ankle(motion: Motion, leg: tuple[int, int, int], target: Floats) -> Motion:
    """Return the motion with the ankle at ``target``, or as near as the leg reaches.

    First the knee bends until the distance from hip to ankle fits, then the leg turns about
    the hip.
    """
    world = compute_world_rotations(motion.skeleton, motion.rotations)
    hip, knee, ankle = (motion.positions[:, j] for j in leg)
    # Frames without a correction must stay exactly equal.
    moved = np.linalg.norm(target - ankle, axis=1) > 1e-9
    if not moved.any():
        return motion
    thigh, shin = knee - hip, ankle - knee
    a, b = np.linalg.norm(thigh, axis=1), np.linalg.norm(shin, axis=1)
    length = np.linalg.norm(target - hip, axis=1)
    # A triangle needs its third side between the difference and the sum of the others.
    length = np.clip(length, np.abs(a - b) / STRAIGHT, (a + b) * STRAIGHT)
    # Angle between the directions of thigh and shin, 0 for a straight leg.
    bent = np.arccos(np.clip((thigh * shin).sum(1) / (a * b), -1, 1))
    # Law of cosines for the length wanted.
    angle = np.arccos(np.clip((length**2 - a**2 - b**2) / (2 * a * b), -1, 1))
    hinge = _find_hinge(thigh, shin, world[:, leg[0]])
    bend = rot.from_rotation_vectors(hinge * (angle - bent)[:, None])
    reached = thigh + rot.rotate(bend, shin)
    # The bent leg turns about the hip so that the ankle points to the target.
    swing = _rotate_onto(reached, target - hip)
    bend, swing = (np.where(moved[:, None], q, rot.IDENTITY) for q in (bend, swing))
    # New world rotations: the thigh swings, the shin bends and swings, the foot keeps its own.
    turned = {
        leg[0]: rot.multiply(swing, world[:, leg[0]]),
        leg[1]: rot.multiply(swing, rot.multiply(bend, world[:, leg[1]])),
        leg[2]: world[:, leg[2]],
    }
    rotations = np.array(motion.rotations)
    for joint, turn in turned.items():
        parent = motion.skeleton.parents[joint]
        # Relative to the parent's new rotation, which may have changed as well.
        above = turned.get(parent, world[:, parent])
        rotations[:, joint] = rot.multiply(rot.conjugate(above), turn)
    positions = forward_kinematics(
        motion.skeleton,
        rotations,
        translations=compute_local_translations(
            motion.skeleton, motion.positions, motion.rotations
        ),
    )
    return replace(motion, rotations=rotations, positions=positions)


def _find_hinge(thigh: Floats, shin: Floats, above: Floats) -> Floats:
    """Return the knee's world axis; for a straight leg, its usual axis in the motion."""
    axis = np.cross(thigh, shin)
    size = np.linalg.norm(axis, axis=1, keepdims=True)
    # The usual axis in the frame of the thigh; bent frames weigh more, by their longer products.
    usual = rot.rotate(rot.conjugate(above), axis).sum(axis=0)
    usual /= max(float(np.linalg.norm(usual)), 1e-12)
    # In a straight leg the product is too short to have a direction.
    clear = size > 0.02 * np.linalg.norm(thigh, axis=1, keepdims=True) ** 2
    hinge: Floats = np.where(clear, axis / np.maximum(size, 1e-12), rot.rotate(above, usual))
    return hinge


def _rotate_onto(a: Floats, b: Floats) -> Floats:
    """Return the smallest rotations from the directions of ``a`` to those of ``b``."""
    a, b = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (a, b))
    # (1 + cos, sin axis) is twice cos(half) times the quaternion: normalised, it is the half angle.
    q = np.concatenate([1 + (a * b).sum(1, keepdims=True), np.cross(a, b)], axis=1)
    arc: Floats = q / np.linalg.norm(q, axis=1, keepdims=True)
    return arc
