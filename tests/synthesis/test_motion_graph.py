"""Graphs and ways through them: what is a jump, what is kept, what is found or refused."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import kineme
from kineme.datasets.bundled import bundled_truth
from kineme.errors import ParameterError
from kineme.features.point_clouds import compute_cloud_distances, fit_clouds
from kineme.recordings import Motion
from kineme.recordings.operations import cut, move, turn
from kineme.recordings.posing import add_root
from kineme.synthesis import (
    Edge,
    MotionGraph,
    Node,
    Source,
    action_route,
    check_source,
    find_following,
    load_sources,
    motion_graph,
    parse_actions,
    random_route,
    read_graph,
    write_graph,
)


def make_graph(names: str, edges: list[tuple[int, int]]) -> MotionGraph:
    """One node per letter, a dot for a phase without name; edges all jumps of 1 cm."""
    nodes = [Node(0, 10 * i, 10 * i + 10, -1, n.strip(".")) for i, n in enumerate(names)]
    made = [Edge(a, b, nodes[a].stop, nodes[b].start, 0.01) for a, b in sorted(edges)]
    source = Source(None, None, 10 * len(names))
    return MotionGraph((source,), tuple(nodes), tuple(made), 30, 0.08, 1 / 3)


def test_fitting_undoes_a_turn_and_a_move(exercises: Motion) -> None:
    moved = move(turn(cut(exercises, 0, 40), 0.7), [1.0, 0.0, -2.0])
    points = np.concatenate([exercises.positions[:40], moved.positions])
    at = np.arange(10, 30)
    distances, angles, shifts = fit_clouds(points, at, at + 40, half=3)
    assert np.abs(distances).max() < 1e-9
    back = move(turn(moved, float(angles[0])), [shifts[0, 0], 0, shifts[0, 1]])
    assert np.abs(back.positions - exercises.positions[:40]).max() < 1e-9
    whole = compute_cloud_distances(exercises.positions, slice(10, 30), slice(100, 120), half=3)
    pairs = fit_clouds(exercises.positions, at, at + 90, half=3)[0]
    assert pairs == pytest.approx(np.diag(whole), abs=1e-7)
    # In a single walk cycle no frames are close enough.
    assert all(len(each) == 0 for each in fit_clouds(points, at[:0], at[:0], half=3))


def test_every_way_leads_on_and_every_jump_is_near_its_border(graph: MotionGraph) -> None:
    assert graph.names == {
        "walk": 9, "squat": 4, "arm circles": 5, "jump": 4, "run": 6, "kick": 4,
    }  # fmt: skip
    assert len(graph.core()) == len(graph.nodes)
    assert all(graph.leaving)
    for edge in graph.edges:
        tail, head = graph.nodes[edge.tail], graph.nodes[edge.head]
        assert abs(edge.leave - tail.stop) <= (tail.stop - tail.start) / 4 + 1
        assert abs(edge.enter - head.start) <= (head.stop - head.start) / 4 + 1
        assert edge.distance <= graph.threshold
        if not edge.jump:
            assert (edge.tail + 1, edge.leave, edge.distance) == (edge.head, edge.enter, 0)


def test_edges_carry_the_distance_that_all_pairs_of_frames_have(
    exercises: Motion, graph: MotionGraph
) -> None:
    """The search by neighbours misses little of what comparing every pair finds."""
    points = kineme.resample(exercises, 30).positions
    runs = graph.nodes_of("run")
    for a in runs[:3]:
        for b in runs[:3]:
            leave, enter = graph.nodes[a].stop // 2, graph.nodes[b].start // 2
            reach = min(n.stop - n.start for n in (graph.nodes[a], graph.nodes[b])) // 8 - 1
            every = compute_cloud_distances(
                points,
                slice(leave - reach, leave + reach + 1),
                slice(enter - reach, enter + reach + 1),
                half=5,
            )
            if b != a + 1:
                found = graph.edges[graph.edge_between[a, b]].distance
                assert found <= every.min() + 0.002


def test_a_lower_threshold_leaves_fewer_jumps(exercises: Motion, graph: MotionGraph) -> None:
    truth = [kineme.read_segments(bundled_truth())]
    fewer = motion_graph([exercises], truth, threshold=0.04, prune=False)
    assert 0 < len(fewer.edges) < len(graph.edges)
    with pytest.raises(ParameterError, match="raise the threshold"):
        motion_graph([exercises], truth, threshold=1e-6)


def test_recordings_that_do_not_fit_are_refused(exercises: Motion) -> None:
    with pytest.raises(ParameterError, match="no rotations"):
        motion_graph([replace(exercises, rotations=None)])
    with pytest.raises(ParameterError, match="another skeleton or frame rate"):
        motion_graph([exercises, replace(exercises, fps=30)])
    with pytest.raises(ParameterError, match="do not belong"):
        motion_graph([cut(exercises, 0, 500)], [kineme.read_segments(bundled_truth())])
    with pytest.raises(ParameterError, match="at least one recording"):
        motion_graph([])
    with pytest.raises(ParameterError, match="threshold must be"):
        motion_graph([exercises], threshold=0)


def test_only_offsets_of_joints_that_move_may_differ(exercises: Motion) -> None:
    rooted = add_root(exercises)

    def change(joint: str) -> Motion:
        offsets = np.array(rooted.skeleton.offsets)
        offsets[rooted.skeleton.names.index(joint)] += [0, 0.02, 0]
        return replace(rooted, skeleton=replace(rooted.skeleton, offsets=offsets))

    check_source(change("root"), rooted)
    check_source(change("Hips"), rooted)  # moves over the floor
    with pytest.raises(ParameterError, match="another skeleton"):
        check_source(change("LeftLeg"), rooted)


def test_pruning_keeps_what_reaches_itself() -> None:
    made = make_graph("abcd", [(0, 1), (1, 2), (2, 1), (2, 3)])
    assert made.core().tolist() == [1, 2]
    pruned = made.pruned()
    assert [node.name for node in pruned.nodes] == ["b", "c"]
    assert [(e.tail, e.head) for e in pruned.edges] == [(0, 1), (1, 0)]
    with pytest.raises(ParameterError, match="raise the threshold"):
        make_graph("ab", [(0, 1)]).pruned()


def test_actions_pass_through_nameless_nodes_only() -> None:
    made = make_graph("a.bc", [(0, 1), (1, 2), (2, 3), (0, 0)])
    assert action_route(made, [("a", 2), ("b", 1)]) == [0, 0, 1, 2]
    assert find_following(made, "a") == ["a", "b"]
    with pytest.raises(
        ParameterError, match="'a' can be followed by a, b, and 'c' is reached from b"
    ):
        action_route(made, [("a", 1), ("c", 1)])
    with pytest.raises(ParameterError, match=r"no node is called 'd'; there are a \(1\), b"):
        action_route(made, [("d", 1)])


@given(
    st.sets(st.tuples(st.integers(0, 5), st.integers(0, 5))),
    st.lists(st.sampled_from("ab"), min_size=1, max_size=5),
)
def test_a_route_is_found_exactly_where_there_is_one(
    edges: set[tuple[int, int]], wanted: list[str]
) -> None:
    made = make_graph("ab.ab.", sorted(edges))
    found = {(i, 0) for i, node in enumerate(made.nodes) if node.name == wanted[0]}
    waiting = list(found)
    while waiting:  # every state (node, actions done) that can be reached
        node, done = waiting.pop()
        for tail, head in edges:
            name = made.nodes[head].name
            ahead = done + bool(name)
            fits = not name or (ahead < len(wanted) and name == wanted[ahead])
            if tail == node and fits and (head, ahead) not in found:
                found.add((head, ahead))
                waiting.append((head, ahead))
    actions = [(name, 1) for name in wanted]
    if not any(done == len(wanted) - 1 and made.nodes[node].name for node, done in found):
        with pytest.raises(ParameterError, match="no route leads"):
            action_route(made, actions)
        return
    route = action_route(made, actions)
    assert [made.nodes[node].name for node in route if made.nodes[node].name] == wanted
    assert all(pair in edges for pair in pairwise(route))


def test_a_random_walk_repeats_by_its_seed_and_never_ends_early(graph: MotionGraph) -> None:
    walk = random_route(graph, 30, 7)
    assert walk == random_route(graph, 30, 7) != random_route(graph, 30, 8)
    made = make_graph("abc", [(0, 1), (1, 0), (0, 2)])
    assert set(random_route(made, 20, 0)) == {0, 1}
    with pytest.raises(ParameterError, match="every route through this graph ends"):
        random_route(make_graph("ab", [(0, 1)]), 1, 0)
    with pytest.raises(ParameterError, match="above 0 and below 1e6 s, not -1"):
        random_route(graph, -1, 0)


def test_actions_are_read_with_their_counts() -> None:
    assert parse_actions("walk, arm circles*3 ,2*10") == [
        ("walk", 1), ("arm circles", 3), ("2", 10),
    ]  # fmt: skip
    for text in ("", "walk,,run", "walk*", "walk*0", "walk*-1", "walk*1.5", "*3"):
        with pytest.raises(ParameterError, match="is not an action"):
            parse_actions(text)


def test_what_was_written_is_read_again(graph: MotionGraph, tmp_path: Path) -> None:
    write_graph(graph, tmp_path / "graph.json")
    again = read_graph(tmp_path / "graph.json")
    assert (again.nodes, again.edges) == (graph.nodes, graph.edges)
    assert (again.fps, again.threshold, again.window) == (graph.fps, graph.threshold, graph.window)
    assert load_sources(again)[0].n_frames == graph.sources[0].n_frames


def test_a_graph_of_motions_from_no_file_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="read from files"):
        write_graph(make_graph("a", [(0, 0)]), tmp_path / "graph.json")
    assert not list(tmp_path.iterdir())
