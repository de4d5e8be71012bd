"""Ways along a line on the floor: they stay near it, begin where it begins, or are refused."""

from __future__ import annotations

import numpy as np
import pytest

import kineme
from kineme.datasets.bundled import bundled_truth
from kineme.errors import ParameterError
from kineme.recordings import Motion
from kineme.synthesis import MotionGraph, line_route, motion_graph, parse_line, synthesize


def measure_distances(motion: Motion, line: list[tuple[float, float]]) -> np.ndarray:
    """Metres from the root to the nearest point of the line, frame by frame."""
    corners = np.array(line)
    at = np.linspace(0, len(line) - 1, 2000)
    points = np.stack([np.interp(at, range(len(line)), corners[:, i]) for i in (0, 1)], axis=1)
    floor = motion.positions[:, 0][:, [0, 2]]
    return np.linalg.norm(floor[:, None] - points, axis=2).min(axis=1)


def test_a_straight_line_is_walked(exercises: Motion, graph: MotionGraph) -> None:
    line = parse_line("1,-2;1,3")
    route, start = line_route(graph, [exercises], line, actions=["walk"])
    assert {graph.nodes[node].name for node in route} <= {"walk", ""}
    motion = synthesize(graph, [exercises], route, start=start)
    floor = motion.positions[:, 0][:, [0, 2]]
    assert np.linalg.norm(floor[0] - line[0]) < 0.05
    ends = np.linalg.norm(floor - line[-1], axis=1)
    assert ends.min() < 0.5
    assert measure_distances(motion, line)[: ends.argmin()].max() < 0.5


def test_a_corner_to_the_side_to_which_somebody_turned(
    exercises: Motion, graph: MotionGraph
) -> None:
    route, start = line_route(graph, [exercises], [(0, 0), (4, 0), (4, -4)], actions=["walk"])
    new = synthesize(graph, [exercises], route, start=start)
    floor = new.positions[:, 0][:, [0, 2]]
    assert np.linalg.norm(floor - [4, -4], axis=1).min() < 0.5
    with pytest.raises(ParameterError, match=r"m off the line near .*tolerance of \d|goes along"):
        line_route(graph, [exercises], [(0, 0), (4, 0), (4, 4)], actions=["walk"])


def test_with_its_mirror_image_a_recording_turns_to_the_other_side_too(exercises: Motion) -> None:
    both = [exercises, kineme.mirror(exercises)]
    graph = motion_graph(both, [kineme.read_segments(bundled_truth())] * 2)
    route, start = line_route(graph, both, [(0, 0), (4, 0), (4, 4)], actions=["walk"])
    floor = synthesize(graph, both, route, start=start).positions[:, 0][:, [0, 2]]
    assert np.linalg.norm(floor - [4, 4], axis=1).min() < 0.5


def test_turning_the_line_turns_the_walk(exercises: Motion, graph: MotionGraph) -> None:
    route, start = line_route(graph, [exercises], [(0, 0), (2, 0)], actions=["walk"])
    turned, other = line_route(graph, [exercises], [(0, 0), (0, 2)], actions=["walk"])
    assert turned == route
    a = synthesize(graph, [exercises], route, start=start).positions[:, 0]
    b = synthesize(graph, [exercises], turned, start=other).positions[:, 0]
    assert np.abs(b[:, 2] - a[:, 0]).max() < 1e-6
    assert np.abs(b[:, 0] + a[:, 2]).max() < 1e-6


@pytest.mark.parametrize("text", ["", "1", "0,0", "0,0;x,1", "0,0;1,2,3", "0,0;nan,1"])
def test_what_is_no_line(text: str) -> None:
    with pytest.raises(ParameterError, match="not a line on the floor"):
        parse_line(text)
