"""Picture of a motion graph: nodes in a circle, jumps as arcs (the paper's figure 8).

Time runs clockwise from the top; nodes are coloured by cluster, transition
phases grey. Fine arcs are jumps in the colour of the node they leave. The
matrix beside it has a dot where an edge leads from the row's node to the
column's, as printed in that figure.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from kineme._util.files import atomic_write
from kineme.segments.colors import get_cluster_color
from kineme.synthesis.graph import MotionGraph


def plot_graph(graph: MotionGraph, path: Path) -> None:
    """Write the picture as PNG, PDF or SVG, by suffix."""
    colors = [get_cluster_color(node.cluster) for node in graph.nodes]
    figure = Figure(figsize=(12, 6), layout="constrained")
    FigureCanvasAgg(figure)
    ring, matrix = figure.subplots(1, 2)
    # Clockwise from the top.
    turn = np.pi / 2 - 2 * np.pi * np.arange(len(colors)) / len(colors)
    at = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    for edge in graph.edges:
        a, b = at[edge.tail], at[edge.head]
        style = {"lw": 0.5, "alpha": 0.5} if edge.jump else {"lw": 2.0, "alpha": 1.0}
        bend = np.linspace(0, 1, 24)[:, None]
        # Control point of a quadratic Bézier curve: jumps are drawn towards the middle of the
        # circle.
        middle = (a + b) / 2 * (0.4 if edge.jump else 1)
        curve = (1 - bend) ** 2 * a + 2 * bend * (1 - bend) * middle + bend**2 * b
        ring.plot(*curve.T, color=colors[edge.tail], zorder=1, **style)
    ring.scatter(*at.T, c=colors, s=60, zorder=2, edgecolors="white")
    ring.set_aspect("equal")
    ring.axis("off")
    shown = {node.name: color for node, color in zip(graph.nodes, colors, strict=True)}
    ring.legend(
        handles=[
            Patch(color=shown[name], label=name or "transition")
            # Names in order, the nameless (transitions) last.
            for name in sorted(shown, key=lambda name: not name)
        ],
        loc="center right",
        bbox_to_anchor=(0, 0.5),  # beside the ring, clear of its edges
        frameon=False,
    )
    ends = np.array([(e.head, e.tail) for e in graph.edges])
    matrix.scatter(*ends.T, c=[colors[e.tail] for e in graph.edges], marker="s", s=8)
    matrix.set(
        # Rows go down, as in a printed matrix.
        xlim=(-0.5, len(colors) - 0.5),
        ylim=(len(colors) - 0.5, -0.5),
        aspect="equal",
        xlabel="to node",
        ylabel="from node",
    )
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=120)
