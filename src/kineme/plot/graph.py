"""Plot a motion graph: nodes on a circle, jumps as arcs (figure 8 of the paper).

Time runs clockwise from the top. Nodes are coloured by cluster; transitions are grey. Thin arcs are
jumps in the colour of the node they leave. The matrix has a dot where an edge leads from the node
of the row to that of the column, as in that figure.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from kineme._util.files import atomic_write
from kineme.segments.display import get_cluster_color
from kineme.synthesis.graph import MotionGraph


def plot_graph(graph: MotionGraph, path: Path) -> None:
    """Write the ring of nodes and the matrix of edges as PNG, PDF or SVG, by suffix."""
    colors = [get_cluster_color(node.cluster) for node in graph.nodes]
    figure = Figure(figsize=(12, 6), layout="constrained")
    ring, matrix = figure.subplots(1, 2)
    # Clockwise from the top.
    angle = np.pi / 2 - 2 * np.pi * np.arange(len(colors)) / len(colors)
    positions = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for edge in graph.edges:
        a, b = positions[edge.tail], positions[edge.head]
        style = {"lw": 0.5, "alpha": 0.5} if edge.jump else {"lw": 2.0, "alpha": 1.0}
        t = np.linspace(0, 1, 24)[:, None]
        # Control point of a quadratic Bézier curve: jumps bend towards the centre.
        middle = (a + b) / 2 * (0.4 if edge.jump else 1)
        curve = (1 - t) ** 2 * a + 2 * t * (1 - t) * middle + t**2 * b
        ring.plot(*curve.T, color=colors[edge.tail], zorder=1, **style)
    ring.scatter(*positions.T, c=colors, s=60, zorder=2, edgecolors="white")
    ring.set_aspect("equal")
    ring.axis("off")
    color_by_name = {node.name: color for node, color in zip(graph.nodes, colors, strict=True)}
    ring.legend(
        handles=[
            Patch(color=color_by_name[name], label=name or "transition")
            # Nodes without a name (transitions) last.
            for name in sorted(color_by_name, key=lambda name: not name)
        ],
        loc="center right",
        bbox_to_anchor=(0, 0.5),  # beside the ring, without overlap
        frameon=False,
    )
    ends = np.array([(e.head, e.tail) for e in graph.edges])
    matrix.scatter(*ends.T, c=[colors[e.tail] for e in graph.edges], marker="s", s=8)
    matrix.set(
        # Row 0 is at the top.
        xlim=(-0.5, len(colors) - 0.5),
        ylim=(len(colors) - 0.5, -0.5),
        aspect="equal",
        xlabel="to node",
        ylabel="from node",
    )
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=120)
