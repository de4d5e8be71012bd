"""Find routes through a motion graph: for a sequence of actions, or at random.

A route is a list of node numbers, each connected to the next by an edge; see
`kineme.synthesize`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import is_whole_number
from kineme.errors import ParameterError
from kineme.synthesis.graph import MotionGraph

EDGE_COST = 1e-3
"""Cost of each edge in metres besides its distance, which favours shorter routes."""


def parse_actions(text: str) -> list[tuple[str, int]]:
    """Parse names of super-nodes with counts from text.

    Parameters
    ----------
    text : str

    Raises
    ------
    ParameterError
        The text has another format.

    Examples
    --------
    >>> from kineme.synthesis import parse_actions
    >>> parse_actions("walk,run*3")
    [('walk', 1), ('run', 3)]
    """
    actions = []
    for part in text.split(","):
        found = re.fullmatch(r"\s*([^*]*[^*\s])\s*(?:\*\s*([1-9]\d{0,4}))?\s*", part)
        if found is None:
            raise ParameterError(
                f"{part.strip()!r} is not an action: give names with counts, as in walk,run*3"
            )
        actions.append((found[1], int(found[2] or 1)))
    return actions


def action_route(graph: MotionGraph, actions: Sequence[tuple[str, int]]) -> list[int]:
    """Return the route with the smallest total distance that plays the named primitives in order.

    Only transitions, which have no name, may come between them.

    Parameters
    ----------
    graph : MotionGraph
    actions : sequence of (str, int)
        Names of super-nodes with the number of repetitions.

    Raises
    ------
    ParameterError
        Unknown name, or no route exists; the message lists possible continuations.

    Examples
    --------
    >>> from kineme.synthesis import Edge, MotionGraph, Node, Source, action_route
    >>> nodes = Node(0, 0, 30, 0, "walk"), Node(0, 30, 60, 1, "jump")
    >>> edges = Edge(0, 1, 30, 30, jump=False), Edge(1, 0, 60, 0, distance=0.05)
    >>> graph = MotionGraph((Source(None, None, 60),), nodes, edges, 30.0, 0.08, 1 / 3)
    >>> action_route(graph, [("walk", 1), ("jump", 1), ("walk", 1)])
    [0, 1, 0]
    """
    names = [name for name, count in actions for _ in range(count)]
    if not names:
        raise ParameterError("no actions: give names with counts, as in walk,run*3")
    # One layer for each action to play, with all nodes of that name.
    layers = [graph.nodes_of(name) for name in names]
    cost, before = _find_cheapest_paths(graph)
    total = np.zeros(len(layers[0]))
    chosen = []
    for i in range(1, len(layers)):
        # (nodes before, nodes after): total cost via each node before.
        through = total[:, None] + cost[np.ix_(layers[i - 1], layers[i])]
        chosen.append(through.argmin(axis=0))
        total = through.min(axis=0)
        if not np.isfinite(total).any():
            raise ParameterError(_explain_missing_route(graph, names[: i + 1], cost))
    at = int(total.argmin())
    route = [layers[-1][at]]
    # From the last action back to the first.
    for i in range(len(chosen) - 1, -1, -1):
        at = int(chosen[i][at])
        route = [*_trace_path(before, layers[i][at], route[0]), *route]
    return route


def random_route(graph: MotionGraph, duration: float, seed: int) -> list[int]:
    """Return a random walk of at least ``duration`` seconds without dead ends.

    All edges of a node are equally likely; the same seed gives the same walk.

    Parameters
    ----------
    graph : MotionGraph
    duration : float
        Seconds.
    seed : int

    Raises
    ------
    ParameterError
        A duration not above 0, a negative seed, or a graph without a strongly connected component.

    Examples
    --------
    >>> from kineme.synthesis import Edge, MotionGraph, Node, Source, random_route
    >>> nodes = Node(0, 0, 30, 0, "walk"), Node(0, 30, 60, 1, "jump")
    >>> edges = Edge(0, 1, 30, 30, jump=False), Edge(1, 0, 60, 0, distance=0.05)
    >>> graph = MotionGraph((Source(None, None, 60),), nodes, edges, 30.0, 0.08, 1 / 3)
    >>> len(random_route(graph, 3.0, seed=0))
    3
    """
    if not 0 < duration < 1e6:
        raise ParameterError(f"the duration must be above 0 and below 1e6 s, not {duration}")
    if not is_whole_number(seed, 0):
        raise ParameterError(f"the seed must be a whole number from 0, not {seed!r:.60}")
    rng = np.random.default_rng(seed)
    core = graph.core().tolist()
    if not core:
        raise ParameterError("every route through this graph ends: build it with more recordings")
    inside = set(core)
    route = [int(rng.choice(core))]
    frames = float(graph.nodes[route[0]].stop - graph.nodes[route[0]].start)
    while frames < duration * graph.fps:
        edges = [graph.edges[i] for i in graph.leaving[route[-1]]]
        # Stay in the strongly connected component, which has no dead ends.
        edge = edges[int(rng.choice([i for i, e in enumerate(edges) if e.head in inside]))]
        # A jump may leave before the end of a node and enter after the start of the next.
        frames += edge.leave - graph.nodes[edge.tail].stop
        frames += graph.nodes[edge.head].stop - edge.enter
        route.append(edge.head)
    return route


def find_following(graph: MotionGraph, name: str) -> list[str]:
    """Return the super-nodes that can follow a super-node.

    Parameters
    ----------
    graph : MotionGraph
    name : str

    Raises
    ------
    ParameterError
        No node has the name.

    Examples
    --------
    >>> from kineme.synthesis import Edge, MotionGraph, Node, Source, find_following
    >>> nodes = Node(0, 0, 30, 0, "walk"), Node(0, 30, 60, 1, "jump")
    >>> edges = Edge(0, 1, 30, 30, jump=False), Edge(1, 0, 60, 0, distance=0.05)
    >>> graph = MotionGraph((Source("walk.bvh", None, 60),), nodes, edges, 30.0, 0.08, 1 / 3)
    >>> find_following(graph, "walk")
    ['jump']
    """
    return _list_marked_names(
        graph, np.isfinite(_find_cheapest_paths(graph)[0][graph.nodes_of(name)]).any(axis=0)
    )


def _find_cheapest_paths(graph: MotionGraph) -> tuple[Floats, NDArray[np.int32]]:
    """Return the least costs between nodes via nameless nodes, and predecessors on these paths.

    Every node is in the search graph twice: as a start (i), and as a destination (n + i). Only
    nameless nodes can be left again from their second copy.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    n = len(graph.nodes)
    rows, columns, costs = [], [], []
    for edge in graph.edges:
        # Edges of a nameless node also leave its second copy, so that paths pass through it.
        for tail in (edge.tail, *([] if graph.nodes[edge.tail].name else [n + edge.tail])):
            rows.append(tail)
            # Edges lead to the second copy, where paths may end.
            columns.append(n + edge.head)
            costs.append(edge.distance + EDGE_COST)
    matrix: Any = csr_array((costs, (rows, columns)), shape=(2 * n, 2 * n))
    cost, before = dijkstra(matrix, indices=np.arange(n), return_predecessors=True)
    # Keep the columns of destinations.
    return cost[:, n:], before


def _trace_path(before: NDArray[np.int32], start: int, stop: int) -> list[int]:
    """Return the nodes on the path from start to stop, without stop."""
    n = len(before)
    # Backwards from the second copy of the last node.
    path = [int(before[start, n + stop])]
    while path[0] != start:
        path.insert(0, int(before[start, path[0]]))
    # Both copies are the same node.
    return [node % n for node in path]


def _explain_missing_route(graph: MotionGraph, names: Sequence[str], cost: Floats) -> str:
    shown = ", ".join(f"{name}*{len(list(same))}" for name, same in groupby(names))
    tail, head = names[-2:]
    # Marks the nodes from which any node of that name can be reached.
    reaches_head = np.isfinite(cost[:, graph.nodes_of(head)]).any(axis=1)
    return (
        f"no route leads through {shown}: {tail!r} can be followed by "
        f"{_join_names(find_following(graph, tail))}, and {head!r} is reached from "
        f"{_join_names(_list_marked_names(graph, reaches_head))}; put another action between, or "
        "build the graph with a higher threshold"
    )


def _list_marked_names(graph: MotionGraph, is_marked: Any) -> list[str]:
    """Return the names of the marked nodes, each once, without nameless nodes."""
    chosen = (node.name for node, marked in zip(graph.nodes, is_marked, strict=True) if marked)
    return list(dict.fromkeys(name for name in chosen if name))


def _join_names(names: list[str]) -> str:
    return ", ".join(names) or "nowhere"
