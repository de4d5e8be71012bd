"""Find a route through a motion graph that follows a line on the floor.

The cost of a route is the integral over time of the squared distance of the root from the line,
plus a small cost of time, which avoids detours. A deterministic beam search finds the cheapest
route: among candidates with equal progress along the line (to a quarter of a metre), the cheapest
are continued, one for each node and direction, up to a maximum number.

Source: Kovar, Gleicher and Pighin 2002, section 5. They compare with the point at equal arc
length; the nearest point ahead, used here, tolerates swaying.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import count
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ParameterError
from kineme.recordings import Motion
from kineme.synthesis.blending import Placement
from kineme.synthesis.graph import MotionGraph

Complex = NDArray[np.complex128]
SPACING = 0.05
"""Distance in metres between the points that sample the line."""
FAR = 0.25
"""Metres of progress that count as equal; also the shortest line."""
TOLERANCE = 0.5
"""Largest distance of the root from the line, metres."""
AHEAD = 0.6
"""Length of the line in which the next nearest point is searched, metres."""
STEP = 0.1
"""Seconds between compared poses."""
TIME = 0.1
"""Cost per second in m²: equals a distance of 32 cm for that time."""
TURN = np.pi / 12
"""Radians of direction that count as equal."""
WIDTH = 400
"""Beam width: candidates kept among those with equal progress."""


def parse_line(text: str) -> list[tuple[float, float]]:
    """Parse points (x, z) on the floor in metres from text.

    Parameters
    ----------
    text : str

    Raises
    ------
    ParameterError
        The text has another format.

    Examples
    --------
    >>> from kineme.synthesis import parse_line
    >>> parse_line("0,0;2,0;2,3")
    [(0.0, 0.0), (2.0, 0.0), (2.0, 3.0)]
    """
    try:
        points = [tuple(float(number) for number in point.split(",")) for point in text.split(";")]
    except ValueError:
        points = []
    if len(points) < 2 or any(len(p) != 2 or not all(map(isfinite, p)) for p in points):
        raise ParameterError(
            f"{text!r} is not a line on the floor: give two or more points x,z in metres, "
            "as in 0,0;2,0;2,3"
        )
    return [(x, z) for x, z in points]


def line_route(
    graph: MotionGraph,
    motions: Sequence[Motion],
    line: Sequence[tuple[float, float]],
    *,
    actions: Collection[str] = (),
    tolerance: float = TOLERANCE,
) -> tuple[list[int], Placement]:
    """Return the route whose root follows a line best, and the placement of its first node.

    Parameters
    ----------
    graph : MotionGraph
    motions : sequence of Motion
        Source motions of the graph, in order.
    line : sequence of (float, float)
        Two or more points (x, z) on the floor, metres, joined by straight lines.
    actions : collection of str
        Names of the super-nodes that may be played; all by default.
    tolerance : float
        Largest distance of the root from the line, metres.

    Returns
    -------
    route : list of int
    start : Placement

    Raises
    ------
    ParameterError
        The line is too short, an action is unknown, or no route stays within the tolerance; the
        message contains the best distance.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> from kineme.synthesis import line_route
    >>> motion = kineme.read(bundled_recording())
    >>> truth = kineme.read_segments(bundled_truth(), fps=motion.fps, n_frames=motion.n_frames)
    >>> graph = kineme.motion_graph([motion], [truth])
    >>> route, start = line_route(graph, [motion], [(0, 0), (4, 0)])
    >>> graph.nodes[route[0]].name
    'run'
    """
    if not tolerance > 0:
        raise ParameterError(f"the tolerance must be above 0 metres, not {tolerance}")
    # Points of the line as complex numbers x + iz.
    points = space_evenly(line)
    hips = [motion.positions[:, motion.skeleton.carrier] for motion in motions]
    floors = [path[:, 0] + 1j * path[:, 2] for path in hips]
    found = _search_route(graph, floors, points, _find_allowed(graph, actions))
    if found is None:
        raise ParameterError(
            "no route through the graph follows this line: add recordings of walking or "
            "name other actions"
        )
    last, progress = found
    if progress.worst > tolerance:
        off = points[progress.worst_at]
        raise ParameterError(
            f"the best route is {np.ceil(progress.worst * 100) / 100:g} m off the line near "
            f"{off.real:.1f},{off.imag:.1f}: give a line with wider turns, recordings with more "
            f"of them, or a tolerance of {np.ceil(progress.worst * 10) / 10:g} m"
        )
    route = last.route()
    return route, _place_start(graph, floors, route[0], points)


def space_evenly(line: Sequence[tuple[float, float]]) -> Complex:
    """Return equidistant points of a line as complex numbers x + iz."""
    corners = np.array([complex(x, z) for x, z in line])
    lengths = np.abs(np.diff(corners))
    total = lengths.sum()
    if len(corners) < 2 or not FAR <= total < 1e4:
        raise ParameterError(
            f"the line is {total:g} m long: it must have a length from {FAR} m to 10 km"
        )
    # Length of the line up to each corner.
    at = np.concatenate([[0], np.cumsum(lengths)])
    places = np.linspace(0, total, round(total / SPACING) + 1)
    x, z = (np.interp(places, at, part) for part in (corners.real, corners.imag))
    return np.asarray(x + 1j * z, np.complex128)


@dataclass(frozen=True)
class _Progress:
    """Progress of a candidate: point reached, cost, largest distance and its point."""

    point: int = 0
    cost: float = 0.0
    worst: float = 0.0
    worst_at: int = 0


@dataclass(frozen=True)
class _Candidate:
    """A route up to a node that is entered at a frame but not yet played."""

    node: int
    enter: int
    at: Placement
    progress: _Progress
    before: _Candidate | None = None

    def route(self) -> list[int]:
        route, last = [self.node], self
        while last.before is not None:
            last = last.before
            route.append(last.node)
        return route[::-1]


def _search_route(
    graph: MotionGraph, floors: Sequence[Complex], points: Complex, nodes: set[int]
) -> tuple[_Candidate, _Progress] | None:
    """Return the cheapest candidate that reaches the end of the line, or None."""
    heap: list[tuple[int, float, int, _Candidate]] = []
    done: list[tuple[_Candidate, _Progress]] = []
    visited: set[tuple[int, int, int]] = set()
    counts: Counter[int] = Counter()
    number = count()  # breaks ties in the order of discovery

    def push(candidate: _Candidate) -> None:
        # Candidates with equal progress share a bucket and compete by cost.
        bucket = candidate.progress.point // round(FAR / SPACING)
        heappush(heap, (bucket, candidate.progress.cost, next(number), candidate))

    for node in sorted(nodes):
        at = _place_start(graph, floors, node, points)
        push(_Candidate(node, graph.nodes[node].start, at, _Progress()))
    while heap:
        bucket, _, _, candidate = heappop(heap)
        # Quantise the direction; the modulo makes it circular.
        direction = round(candidate.at.angle / TURN) % round(2 * np.pi / TURN)
        if counts[bucket] == WIDTH or (bucket, candidate.node, direction) in visited:
            continue
        visited.add((bucket, candidate.node, direction))
        counts[bucket] += 1
        reached, onward = _expand(graph, floors, points, nodes, candidate)
        # The last node reaches the end of the line.
        if reached.point == len(points) - 1:
            done.append((candidate, reached))
        else:
            for longer in onward:
                push(longer)
    return min(done, key=lambda found: found[1].cost, default=None)


def _expand(
    graph: MotionGraph,
    floors: Sequence[Complex],
    points: Complex,
    nodes: set[int],
    candidate: _Candidate,
) -> tuple[_Progress, list[_Candidate]]:
    """Play the last node of a candidate: return its progress, and the candidates that follow."""
    step = max(round(STEP * graph.fps), 1)
    node = graph.nodes[candidate.node]
    edges = [graph.edges[number] for number in graph.leaving[candidate.node]]
    edges = [edge for edge in edges if edge.head in nodes]
    stop = max([node.stop, *(edge.leave for edge in edges)])
    # Hip positions in the node, one per step.
    floor = floors[node.source][candidate.enter : stop : step]
    reached = _measure_progress(candidate, floor, points, step / graph.fps)
    onward = []
    for edge in edges:
        # The successor in the recording keeps its placement.
        at = candidate.at.after(edge.angle, edge.shift) if edge.jump else candidate.at
        # Progress up to the frame at which the edge leaves the node.
        travel = reached[_count_poses(candidate.enter, edge.leave, step)]
        onward.append(_Candidate(edge.head, edge.enter, at, travel, candidate))
    return reached[_count_poses(candidate.enter, node.stop, step)], onward


def _count_poses(start: int, stop: int, step: int) -> int:
    """Return the number of poses in frames [start, stop)."""
    # Division rounded up.
    return -(-(stop - start) // step)


def _measure_progress(
    candidate: _Candidate, floor: Complex, points: Complex, seconds: float
) -> list[_Progress]:
    """Return the progress before each pose and after the last; poses are ``seconds`` apart.

    ``floor`` are the hips on the floor as recorded, ``points`` the line, as complex numbers.
    """
    now = candidate.progress
    reached = [now]
    ahead = round(AHEAD / SPACING)
    # Turn and move the hips to the candidate's placement.
    for place in np.exp(-1j * candidate.at.angle) * floor + candidate.at.shift:
        if now.point < len(points) - 1:
            # Only search ahead, so that progress never decreases.
            distances = np.abs(points[now.point : now.point + ahead] - place)
            nearest = int(distances.argmin())
            point, distance = now.point + nearest, float(distances[nearest])
            # Integral of the squared distance plus the price of time.
            cost = now.cost + (distance**2 + TIME) * seconds
            # Tuples compare by distance first and keep the point of the largest one.
            worst, worst_at = max((now.worst, now.worst_at), (distance, point))
            now = _Progress(point, cost, worst, worst_at)
        reached.append(now)
    return reached


def _find_allowed(graph: MotionGraph, actions: Collection[str]) -> set[int]:
    """Return the nodes that may be played: those named, and transitions."""
    if not actions:
        return set(range(len(graph.nodes)))
    named = {node for name in actions for node in graph.nodes_of(name)}
    return named | {i for i, node in enumerate(graph.nodes) if not node.name}


def _place_start(
    graph: MotionGraph, floors: Sequence[Complex], node: int, points: Complex
) -> Placement:
    """Return the placement with which a node starts at the line's first point, along the line."""
    span = graph.nodes[node]
    floor = floors[span.source]
    travel = floor[min(span.stop, len(floor) - 1)] - floor[span.start]
    # The direction of the line over as much length as the node travels.
    ahead = points[min(round(max(abs(travel), FAR) / SPACING), len(points) - 1)] - points[0]
    # Placements turn by exp(-i angle).
    angle = float(np.angle(travel) - np.angle(ahead)) if abs(travel) > 0 else 0.0
    turned = Placement(angle)
    return Placement(angle, complex(points[0]) - turned.of(complex(floor[span.start])))
