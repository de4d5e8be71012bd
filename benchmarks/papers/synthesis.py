"""Motion graphs of subject 86, and what is played from them, beside figure 8 of the paper.

    python -m benchmarks synthesis [--record]

First each take's graph, not pruned, with nodes from the ``kineme`` preset and
from the published cuts of ACA and HACA; nodes are named by the annotation at
their middle. Then random walks of 60 s through our graph: their time, the
largest step of a joint near jumps against the largest in the source, and how
far standing feet slide with and without planting. Last, a corner followed on the
floor, 4 m and 4 m: how far the root gets from it.
"""

from __future__ import annotations

import json
import time

import numpy as np

import kineme
from _figures import add_option, record
from _options import DATA, command_line, few, needed
from _recordings import TRIALS
from kineme.features import end_effectors
from kineme.recordings import Motion
from kineme.synthesis import (
    MotionGraph,
    Placement,
    line_route,
    motion_graph,
    random_route,
    synthesize,
)
from kineme.synthesis.blending import jump_frames, spans_of
from kineme.synthesis.feet import foot_contacts, slides

FOLDER = DATA / "cmu86"
SEEDS = range(few(3, 1))


def named(found: kineme.Segmentation, trial: str) -> kineme.Segmentation:
    """The primitives with the annotated action at the middle of each as label."""
    rows = json.loads((FOLDER / "annotations.json").read_text())["trials"][trial]
    ends = np.array([row["end_mean"] for row in rows])
    columns = found.table.columns()
    middles = (columns["start_frame"] + columns["stop_frame"]) // 2
    at = np.minimum(np.searchsorted(ends, middles), len(rows) - 1)
    labels = [
        rows[i]["label"] if kind != "transition" else ""
        for i, kind in zip(at, columns["kind"], strict=True)
    ]
    return kineme.Segmentation.from_columns(
        {**columns, "label": labels}, n_frames=found.n_frames, fps=found.fps
    )


def published(trial: str, method: str, motion: Motion) -> kineme.Segmentation:
    """The published segments of ACA or HACA; frame f of 30 Hz, from 1, is frame 4 (f - 1)."""
    tables = json.loads((FOLDER / "published.json").read_text())
    cuts = [4 * (f - 1) for f in tables[f"{method}_cuts_30hz"][trial]]
    borders = [0, *(c for c in cuts if 0 < c < motion.n_frames), motion.n_frames]
    n = len(borders) - 1
    return kineme.Segmentation.from_columns(
        {
            "level": ["activity"] * n,
            "kind": ["activity"] * n,
            "start_frame": borders[:-1],
            "stop_frame": borders[1:],
            "cluster": range(n),
        },
        n_frames=motion.n_frames,
        fps=motion.fps,
    )


def show_graph(method: str, graph: MotionGraph) -> None:
    counts = ", ".join(f"{name} {count}" for name, count in graph.names.items())
    action = next((a for a in ("run", "jog", "walk") if a in graph.names), "")
    first = graph.nodes_of(action)[0]
    inside = sum(graph.nodes[graph.edges[i].head].name == action for i in graph.leaving[first])
    pairs, possible = graph.reachable_pairs(), len(graph.nodes) ** 2
    print(f"  {method:7} nodes {len(graph.nodes):3}: {counts}")
    print(
        f"          from the first {action}: {len(graph.leaving[first])} edges, {inside} to it; "
        f"reachable pairs {pairs} of {possible}; strongly connected {len(graph.core())}"
    )


def steps(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """From frame to frame the farthest move of a joint, m, and the widest turn, degrees."""
    q = np.asarray(motion.rotations)
    half = np.arccos(np.clip(np.abs((q[1:] * q[:-1]).sum(axis=2)), 0, 1))
    moves = np.linalg.norm(np.diff(motion.positions, axis=0), axis=2)
    return moves.max(axis=1), np.degrees(2 * half).max(axis=1)


def sliding(motion: Motion) -> np.ndarray:
    """Centimetres that ankles get away from where they came to stand, one per contact."""
    paths = [motion.positions[:, a] for a in end_effectors(motion).indices[:2]]
    far = [slides(path, foot_contacts(path, motion.fps)) for path in paths]
    return 100 * np.concatenate(far)


def show_walks(graph: MotionGraph, motion: Motion) -> list[float]:
    """Seconds that each walk took."""
    took = []
    own_moves, own_turns = (values.max() for values in steps(motion))
    half = round(graph.window * graph.fps / 2)
    for seed in SEEDS:
        began = time.perf_counter()
        route = random_route(graph, few(60, 10), seed)
        new = synthesize(graph, [motion], route)
        seconds = time.perf_counter() - began
        near = np.zeros(new.n_frames - 1, bool)
        for t in jump_frames(spans_of(graph, route, Placement())):
            near[max(t - half, 0) : t + half] = True
        moves, turns = steps(new)
        slid, bare = sliding(new), sliding(synthesize(graph, [motion], route, plant=False))
        print(
            f"  walk {seed}: {new.duration:.0f} s in {seconds:.2f} s; step at jumps / in source: "
            f"{moves[near].max() / own_moves:.2f} (m), {turns[near].max() / own_turns:.2f} (deg); "
            f"feet slide {slid.mean():.2f} cm per contact ({len(slid)}), "
            f"unplanted {bare.mean():.2f} cm ({len(bare)})"
        )
        took.append(seconds)
    return took


def show_corner(graph: MotionGraph, motion: Motion) -> float:
    """Seconds until the route was found."""
    began = time.perf_counter()
    line = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0)]
    route, start = line_route(graph, [motion], line, tolerance=10)
    seconds = time.perf_counter() - began
    new = synthesize(graph, [motion], route, start=start)
    x, _, z = new.positions[:, 0].T
    last = int(np.hypot(x - 4, z - 4).argmin()) + 1
    first_leg = np.hypot(x - np.clip(x, 0, 4), z)
    off = np.minimum(first_leg, np.hypot(x - 4, z - np.clip(z, 0, 4)))[:last]
    print(
        f"  corner: {new.duration:.0f} s found in {seconds:.2f} s; off the line "
        f"{off.mean():.2f} m in the mean, {off.max():.2f} m at most"
    )
    return seconds


def main() -> None:
    parser = command_line(__doc__)
    add_option(parser)
    parser.parse_args()
    needed("cmu86")
    walks: list[float] = []
    corners: list[float] = []
    print("The paper, 86_03, run only: 9 run nodes and 2 transfers of ours, 4 run nodes of HACA")
    for trial in few(TRIALS, TRIALS[:1]):
        motion = kineme.read(FOLDER / f"{trial}.amc")
        print(trial)
        began = time.perf_counter()
        graph = motion_graph([motion], [named(kineme.segment(motion), trial)], prune=False)
        seconds = time.perf_counter() - began
        show_graph("kineme", graph)
        for method in ("aca", "haca"):
            found = named(published(trial, method, motion), trial)
            show_graph(method, motion_graph([motion], [found], prune=False))
        print(f"  segmented and built in {seconds:.2f} s")
        walks += show_walks(graph, motion)
        corners.append(show_corner(graph, motion))
    record("synthesis.walks.seconds", f"{min(walks):.1f} to {max(walks):.1f}", unit="s")
    record("synthesis.corner.seconds", f"{min(corners):.0f} to {max(corners):.0f}", unit="s")


if __name__ == "__main__":
    main()
