"""Motion graphs over primitives (Kovar, Gleicher and Pighin 2002; the paper's section 6.2).

A node is a primitive, or a transition phase between two activities: a span of
a source recording. An edge says that after one node another can be played:
the recording's own successor, or a *jump* to a similar place. A jump
leaves its node at a frame near the node's end and enters the next one near
its start; the next is then turned about the vertical and moved on the floor.

Nodes of one name (a label, else the number of a cluster) form a super-node,
as in Motion Graphs++ (Min and Chai 2012). Transition phases have no name.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from kineme._util.arrays import Ints
from kineme.errors import ParameterError
from kineme.formats import ReadOptions


@dataclass(frozen=True)
class Source:
    """A recording the graph was built on.

    Parameters
    ----------
    path, sha256 : str or None
        The file, and its digest; None for a motion that came from no file.
    n_frames : int
    options : ReadOptions
        How it was read.

    Examples
    --------
    >>> from kineme.synthesis import Source
    >>> Source("walk.bvh", None, n_frames=600).n_frames
    600
    """

    path: str | None
    sha256: str | None
    n_frames: int
    options: ReadOptions = field(default_factory=ReadOptions)


@dataclass(frozen=True)
class Node:
    """Frames [start, stop) of a source.

    Parameters
    ----------
    source : int
        Its number in the graph.
    start, stop : int
    cluster : int
        Equal clusters are equal movements, whatever their source; -1 for none.
    label : str
        Empty for none.

    Examples
    --------
    >>> from kineme.synthesis import Node
    >>> Node(source=0, start=0, stop=30, cluster=2, label="walk").name
    'walk'
    """

    source: int
    start: int
    stop: int
    cluster: int
    label: str = ""

    @property
    def name(self) -> str:
        """Return the super-node: the label, else the cluster's number; empty for neither."""
        return self.label or (str(self.cluster) if self.cluster >= 0 else "")


@dataclass(frozen=True)
class Edge:
    """From one node to another that can be played after it.

    Parameters
    ----------
    tail, head : int
        Numbers of the nodes.
    leave : int
        The frame after the last played of the tail's source.
    enter : int
        The first frame played of the head's source.
    distance : float
        Of the point clouds, metres; 0 for the recording's own successor.
    angle : float
        To go on from where the tail is, the head's source is turned about the vertical
        by so many radians,
    shift : pair of float
        then moved by so many metres in x and z.
    jump : bool
        Whether the head is not the recording's own successor.

    Examples
    --------
    >>> from kineme.synthesis import Edge
    >>> Edge(0, 1, leave=30, enter=90, distance=0.05).jump
    True
    """

    tail: int
    head: int
    leave: int
    enter: int
    distance: float = 0.0
    angle: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)
    jump: bool = True


@dataclass(frozen=True)
class MotionGraph:
    """Nodes, in the order of sources and time, and the edges between them.

    Parameters
    ----------
    sources : tuple of Source
        Recordings, of one skeleton.
    nodes : tuple of Node
        Spans of them.
    edges : tuple of Edge
        Ordered by tail, then head; at most one for each pair.
    fps : float
        Frames per second of all sources.
    threshold : float
        Largest point-cloud distance of a jump, metres.
    window : float
        Seconds compared and blended around a jump.

    Examples
    --------
    >>> from kineme.synthesis import Edge, MotionGraph, Node, Source
    >>> nodes = Node(0, 0, 30, 0, "walk"), Node(0, 30, 60, 1, "jump")
    >>> edges = Edge(0, 1, 30, 30, jump=False), Edge(1, 0, 60, 0, distance=0.05)
    >>> MotionGraph((Source(None, None, 60),), nodes, edges, 30.0, 0.08, 1 / 3).names
    {'walk': 1, 'jump': 1}
    """

    sources: tuple[Source, ...]
    nodes: tuple[Node, ...]
    edges: tuple[Edge, ...]
    fps: float
    threshold: float
    window: float

    @cached_property
    def names(self) -> dict[str, int]:
        """Super-nodes and how many nodes each has, in order of appearance."""
        return dict(Counter(node.name for node in self.nodes if node.name))

    @cached_property
    def leaving(self) -> tuple[tuple[int, ...], ...]:
        """Return for each node the numbers of the edges that leave it."""
        lists: list[list[int]] = [[] for _ in self.nodes]
        for number, edge in enumerate(self.edges):
            lists[edge.tail].append(number)
        return tuple(map(tuple, lists))

    @cached_property
    def edge_between(self) -> dict[tuple[int, int], int]:
        """Return the number of the edge from one node to another."""
        return {(edge.tail, edge.head): number for number, edge in enumerate(self.edges)}

    def nodes_of(self, name: str) -> list[int]:
        """Return the nodes of a super-node; ParameterError if there is none of that name."""
        if name not in self.names:
            listing = ", ".join(f"{name} ({n})" for name, n in self.names.items())
            raise ParameterError(f"no node is called {name!r}; there are {listing or 'no names'}")
        return [i for i, node in enumerate(self.nodes) if node.name == name]

    def core(self) -> Ints:
        """Return the largest strongly connected component: its nodes all reach each other.

        Ties go to the component of more edges, then to the earlier one. A node alone
        is one only if it can repeat itself; empty if there is none.
        """
        from scipy.sparse.csgraph import connected_components

        component = connected_components(self._adjacency(), connection="strong")[1]
        inner = [edge for edge in self.edges if component[edge.tail] == component[edge.head]]
        # Only components with an edge inside: a node alone counts if it can repeat itself.
        edges = Counter(int(component[edge.tail]) for edge in inner)
        sizes = Counter(component.tolist())
        # The minus makes the earlier component win a tie.
        largest = max(edges, key=lambda p: (sizes[p], edges[p], -p), default=-1)
        return np.flatnonzero(component == largest)

    def pruned(self) -> MotionGraph:
        """Return the graph of the core alone; ParameterError if there is none."""
        kept = self.core().tolist()
        if not kept:
            raise ParameterError(
                f"no node can be reached again with jumps of at most {self.threshold:g} m; "
                "raise the threshold, or give recordings that repeat an action"
            )
        number = {node: i for i, node in enumerate(kept)}
        edges = [
            replace(edge, tail=number[edge.tail], head=number[edge.head])
            for edge in self.edges
            if edge.tail in number and edge.head in number
        ]
        return replace(self, nodes=tuple(self.nodes[i] for i in kept), edges=tuple(edges))

    def _adjacency(self) -> Any:
        from scipy.sparse import csr_array

        # The reshape keeps two columns where there are no edges.
        ends = np.array([(e.tail, e.head) for e in self.edges], np.int64).reshape(-1, 2)
        shape = (len(self.nodes), len(self.nodes))
        return csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=shape)
