"""From a route through the graph to a motion.

Spans of the sources are laid end to end, each turned about the vertical and moved on the floor as
its jump says. Around a jump both recordings go on for half a window, and the motion goes over from
the one to the other. Joint rotations go along the sphere, translations in a line, with the smooth
weight 3w² - 2w³ (Kovar, Gleicher and Pighin 2002, section 3.2). Last, feet that stand are kept from
sliding (see `kineme.synthesis.feet`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import as_indices, check_type, format_count
from kineme.errors import ParameterError
from kineme.recordings import Motion, Provenance
from kineme.recordings.kinematics import local_translations
from kineme.recordings.motion import check_motion
from kineme.synthesis.feet import plant_feet
from kineme.synthesis.graph import MotionGraph


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
        """Return the placement of what is itself turned and moved before."""
        # The new turn comes first in space: its shift is turned and moved by this placement.
        return Placement(self.angle + angle, self.of(complex(*shift)))

    def of(self, floor: complex) -> complex:
        """Where a point of the floor comes to lie."""
        # Placements turn x + iz by exp(-i angle), as a turn about y does.
        return complex(np.exp(-1j * self.angle)) * floor + self.shift


@dataclass(frozen=True)
class PlacedSpan:
    """Frames [start, stop) of a source, and where they are laid."""

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
    """Return the motion of a route: its nodes played one after the other.

    Parameters
    ----------
    graph : MotionGraph
    motions : sequence of Motion
        Those it was built on, in order.
    route : sequence of int
        Node numbers, each joined to the next by an edge; see `kineme.synthesis.routes`.
    start : Placement, optional
        Where the first node is laid; as it was recorded by default.
    plant : bool
        Whether standing feet are kept from sliding.

    Returns
    -------
    Motion

    Raises
    ------
    ParameterError
        An empty route, nodes without an edge between them, or other motions than the
        graph's.

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
            raise ParameterError(f"no node {node} in a graph of {len(graph.nodes)}")
    if start is not None:
        check_type(start, Placement, "start", "leave it out to start as recorded")
    # Frame counts are a cheap check that the motions are those of the graph.
    if [m.n_frames for m in motions] != [s.n_frames for s in graph.sources]:
        raise ParameterError("the motions are not those the graph was built on: build it anew")
    spans = spans_of(graph, route, start or Placement())
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


def spans_of(graph: MotionGraph, route: Sequence[int], at: Placement) -> list[PlacedSpan]:
    """Return the spans to play; nodes that follow each other in a recording are one."""
    if not route:
        raise ParameterError("a route needs at least one node")
    first = graph.nodes[route[0]]
    spans = [PlacedSpan(first.source, first.start, first.stop, at)]
    for tail, head in pairwise(route):
        if (tail, head) not in graph.edge_between:
            raise ParameterError(f"no edge leads from node {tail} to node {head}")
        edge, node = graph.edges[graph.edge_between[tail, head]], graph.nodes[head]
        if not edge.jump:
            # The recording's own successor needs no blending: its span goes on.
            spans[-1] = replace(spans[-1], stop=node.stop)
            continue
        spans[-1] = replace(spans[-1], stop=edge.leave)
        at = spans[-1].at.after(edge.angle, edge.shift)
        spans.append(PlacedSpan(node.source, edge.enter, node.stop, at))
    return spans


def jump_frames(spans: Sequence[PlacedSpan]) -> list[int]:
    """Return the frame of the new motion at the middle of each jump."""
    # Ends of all spans but the last.
    return list(accumulate(span.stop - span.start for span in spans))[:-1]


def _blend_spans(
    spans: Sequence[PlacedSpan], motions: Sequence[Motion], half: int
) -> tuple[Floats, Floats]:
    """Rotations and translations of all spans, blended over ``half`` frames about each jump."""
    shifts = [
        local_translations(motion.skeleton, motion.positions, motion.rotations)
        for motion in motions
    ]

    def placed(span: PlacedSpan, start: int, stop: int) -> tuple[Floats, Floats]:
        motion = motions[span.source]
        rotations = np.array(motion.rotations)[start:stop]
        return _placed_motion(motion, rotations, shifts[span.source][start:stop], span.at)

    placed_spans = [placed(span, span.start, span.stop) for span in spans]
    rotations, translations = (np.concatenate(each) for each in zip(*placed_spans, strict=True))
    for t, (a, b) in zip(jump_frames(spans), pairwise(spans), strict=True):
        # Blends of neighbouring jumps must not overlap, and need frames of both recordings.
        room = min(a.stop - a.start, b.stop - b.start) // 2
        n = min(half, room, motions[a.source].n_frames - a.stop, b.start)
        # Extend both spans by n frames across the jump, so that 2 n frames overlap.
        before, before_shift = placed(a, a.stop - n, a.stop + n)
        after, after_shift = placed(b, b.start - n, b.start + n)
        # Smoothstep weights at the frame centres; the new axes are joints and components.
        w = ((np.arange(2 * n) + 0.5) / max(2 * n, 1))[:, None, None]
        w = w * w * (3 - 2 * w)
        rotations[t - n : t + n] = rot.slerp(before, after, w)
        translations[t - n : t + n] = (1 - w) * before_shift + w * after_shift
    return rotations, translations


def _placed_motion(
    motion: Motion, rotations: Floats, shifts: Floats, at: Placement
) -> tuple[Floats, Floats]:
    roots = [j for j, parent in enumerate(motion.skeleton.parents) if parent < 0]
    about_y = rot.rotate_about_y(at.angle)
    rotations, shifts = rotations.copy(), shifts.copy()
    # Roots only: all other joints are relative to their parents.
    rotations[:, roots] = rot.multiply(about_y, rotations[:, roots])
    shifts[:, roots] = rot.rotate(about_y, shifts[:, roots])
    shifts[:, roots] += [at.shift.real, 0, at.shift.imag]
    return rotations, shifts
