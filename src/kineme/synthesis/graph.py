"""Motion graphs over primitives (Kovar, Gleicher and Pighin 2002; the paper's section 6.2).

A node is a span of a source recording: a primitive, or a transition between two activities. An
edge leads to a node that can be played next: the successor in the recording, or a *jump* to a
similar pose. A jump leaves its node near the end and enters the next one near its start; the
next one is then turned about the vertical and moved on the floor.

Nodes with one name (label, else cluster number) form a super-node, as in Motion Graphs++ (Min
and Chai 2012). Transitions have no name.

Files are JSON with the schema ``kineme.motion-graph/1``. One object:

    {
      "schema": "kineme.motion-graph/1",
      "fps": 120.0, "threshold": 0.08, "window": 0.333,    as in MotionGraph
      "sources": [{"path": "86_10.amc", "sha256": "...", "n_frames": 7583, "options": {}}],
      "nodes": [{"source": 0, "start": 0, "stop": 312, "cluster": 0, "label": ""}],
      "edges": [{"tail": 0, "head": 1, "leave": 312, "enter": 312, "distance": 0.0,
                 "angle": 0.0, "shift": [0.0, 0.0], "jump": false}]
    }

Paths are relative to the graph's folder. The recordings are not in the file: they are read
again with ``options``, and must be identical. Readers must ignore unknown names except in
``options``; the number in the schema increases with changes that old readers would misread.
"""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.arrays import Ints
from kineme._util.files import atomic_write, translate_read_errors
from kineme._util.json import convert_json, load_json, options_from_json, options_to_json
from kineme.errors import ParameterError, ReadError
from kineme.formats import ReadOptions, read_motion
from kineme.recordings import Motion

SCHEMA = "kineme.motion-graph/1"
_MOST = 1e9  # metres, radians
_FASTEST = 1e6  # frames per second; also metres and seconds


@dataclass(frozen=True)
class Source:
    """A source recording of a graph.

    Parameters
    ----------
    path, sha256 : str or None
        The file and its digest; None for a motion without a file.
    n_frames : int
    options : ReadOptions
        Options with which it was read.

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
        Index of the source in the graph.
    start, stop : int
    cluster : int
        Equal numbers are equal movements, across sources; -1 for none.
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
        """Return the name of the super-node: label, else cluster number, else empty."""
        return self.label or (str(self.cluster) if self.cluster >= 0 else "")


@dataclass(frozen=True)
class Edge:
    """A transition from one node to another that can be played next.

    Parameters
    ----------
    tail, head : int
        Indices of the nodes.
    leave : int
        Frame after the last one played of the tail's source.
    enter : int
        First frame played of the head's source.
    distance : float
        Distance of the point clouds, metres; 0 for the successor in the recording.
    angle : float
        Turn of the head's source about the vertical, relative to the tail, radians.
    shift : pair of float
        Shift of the head's source in x and z after the turn, metres.
    jump : bool
        False for the successor in the recording.

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
    """Nodes, sorted by source and time, and the edges between them.

    Parameters
    ----------
    sources : tuple of Source
        Recordings with one skeleton.
    nodes : tuple of Node
        Spans of the sources.
    edges : tuple of Edge
        Sorted by tail, then head; at most one for each pair.
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
        """Return the number of nodes of each super-node, in order of appearance."""
        return dict(Counter(node.name for node in self.nodes if node.name))

    @cached_property
    def leaving(self) -> tuple[tuple[int, ...], ...]:
        """Return the indices of the edges that leave each node."""
        lists: list[list[int]] = [[] for _ in self.nodes]
        for number, edge in enumerate(self.edges):
            lists[edge.tail].append(number)
        return tuple(map(tuple, lists))

    @cached_property
    def edge_between(self) -> dict[tuple[int, int], int]:
        """Return the index of the edge for each connected pair of nodes."""
        return {(edge.tail, edge.head): number for number, edge in enumerate(self.edges)}

    def nodes_of(self, name: str) -> list[int]:
        """Return the nodes of a super-node; raise ParameterError if it does not exist."""
        if name not in self.names:
            available = ", ".join(f"{name} ({n})" for name, n in self.names.items())
            raise ParameterError(f"no node is called {name!r}; there are {available or 'no names'}")
        return [i for i, node in enumerate(self.nodes) if node.name == name]

    def core(self) -> Ints:
        """Return the largest strongly connected component, whose nodes all reach each other.

        Ties go to the component with more edges, then to the earlier one. A single node counts
        only if it has an edge to itself. Empty if there is no component.
        """
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import connected_components

        # The reshape keeps two columns if there are no edges.
        ends = np.array([(e.tail, e.head) for e in self.edges], np.int64).reshape(-1, 2)
        shape = (len(self.nodes), len(self.nodes))
        adjacency: Any = csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=shape)
        component = connected_components(adjacency, connection="strong")[1]
        inner = [edge for edge in self.edges if component[edge.tail] == component[edge.head]]
        # Only components with an internal edge count.
        edges = Counter(int(component[edge.tail]) for edge in inner)
        sizes = Counter(component.tolist())
        # The minus makes the earlier component win a tie.
        largest = max(edges, key=lambda p: (sizes[p], edges[p], -p), default=-1)
        return np.flatnonzero(component == largest)

    def pruned(self) -> MotionGraph:
        """Return the graph reduced to its core; raise ParameterError if there is none."""
        nodes = self.core().tolist()
        if not nodes:
            raise ParameterError(
                f"no node can be reached again with jumps of at most {self.threshold:g} m; "
                "raise the threshold, or give recordings that repeat an action"
            )
        number = {node: i for i, node in enumerate(nodes)}
        edges = [
            replace(edge, tail=number[edge.tail], head=number[edge.head])
            for edge in self.edges
            if edge.tail in number and edge.head in number
        ]
        return replace(self, nodes=tuple(self.nodes[i] for i in nodes), edges=tuple(edges))


def write_graph(graph: MotionGraph, path: str | os.PathLike[str]) -> None:
    """Write a graph to a JSON file.

    Parameters
    ----------
    graph : MotionGraph
    path : path-like

    Raises
    ------
    ParameterError
        A source was not read from a file, so it could not be read again.
    WriteError
        The file cannot be written.

    Examples
    --------
    >>> from kineme.synthesis import Edge, MotionGraph, Node, Source, read_graph, write_graph
    >>> nodes = Node(0, 0, 30, 0, "walk"), Node(0, 30, 60, 1, "jump")
    >>> edges = Edge(0, 1, 30, 30, jump=False), Edge(1, 0, 60, 0, distance=0.05)
    >>> graph = MotionGraph((Source("walk.bvh", "0" * 64, 60),), nodes, edges, 30.0, 0.08, 1 / 3)
    >>> write_graph(graph, "moves.json")
    >>> read_graph("moves.json").nodes == graph.nodes
    True
    """
    folder = Path(path).absolute().parent
    head = {
        "schema": SCHEMA,
        "fps": graph.fps,
        "threshold": graph.threshold,
        "window": graph.window,
        "sources": [_format_source(source, folder) for source in graph.sources],
    }
    # Rows are appended one per line below, so remove the closing brace.
    text = json.dumps(head, indent=2).removesuffix("\n}")
    for name, rows in (("nodes", graph.nodes), ("edges", graph.edges)):
        lines = ",\n".join(f"    {json.dumps(asdict(row))}" for row in rows)
        text += f',\n  "{name}": [\n{lines}\n  ]'
    with atomic_write(path) as draft:
        draft.write_text(text + "\n}\n", encoding="utf-8")


def read_graph(path: str | os.PathLike[str]) -> MotionGraph:
    """Read a graph from a JSON file.

    Parameters
    ----------
    path : path-like

    Raises
    ------
    ReadError
        The file is missing, damaged or of another version.

    Examples
    --------
    >>> from kineme.synthesis import Edge, MotionGraph, Node, Source, read_graph, write_graph
    >>> nodes = Node(0, 0, 30, 0, "walk"), Node(0, 30, 60, 1, "jump")
    >>> edges = Edge(0, 1, 30, 30, jump=False), Edge(1, 0, 60, 0, distance=0.05)
    >>> graph = MotionGraph((Source("walk.bvh", "0" * 64, 60),), nodes, edges, 30.0, 0.08, 1 / 3)
    >>> write_graph(graph, "moves.json")
    >>> len(read_graph("moves.json").edges)
    2
    """
    home = Path(path).absolute().parent
    data = load_json(Path(path))
    schema = data.get("schema") if isinstance(data, dict) else None
    if not str(schema).startswith("kineme.motion-graph/"):
        raise ReadError(path, "is not a motion graph: make one with kineme graph FILES")
    if schema != SCHEMA:
        raise ReadError(path, f"has schema {schema!r}, but this version reads {SCHEMA!r}")
    try:
        graph = _parse_graph(data)
    except ValueError as error:
        reason = f"is damaged ({error!s:.120}): build it again with kineme graph"
        raise ReadError(path, reason) from error
    return replace(graph, sources=tuple(_resolve_source(source, home) for source in graph.sources))


def load_sources(graph: MotionGraph) -> list[Motion]:
    """Read the source recordings of a graph, in order.

    Parameters
    ----------
    graph : MotionGraph

    Raises
    ------
    ReadError
        A file is missing or was changed.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> motion = kineme.read(bundled_recording())
    >>> truth = kineme.read_segments(bundled_truth(), fps=motion.fps, n_frames=motion.n_frames)
    >>> graph = kineme.motion_graph([motion], [truth])
    >>> len(load_sources(graph))
    1
    """
    motions = []
    for source in graph.sources:
        path = Path(source.path or "")
        with translate_read_errors(path):
            exists = path.is_file()
            digest = sha256(path.read_bytes()).hexdigest() if exists else ""
        if not exists:
            raise ReadError(
                path,
                "is missing, but the graph was built from it: put it back or build the graph again",
            )
        # Digests must match, since spans of frames are meaningless in a changed file.
        if digest != source.sha256:
            raise ReadError(path, "has changed since the graph was built: build the graph again")
        motions.append(read_motion(path, **vars(source.options)))
    return motions


def _format_source(source: Source, folder: Path) -> dict[str, Any]:
    """Return a source for JSON, with paths relative to the folder of the graph."""
    if source.path is None or source.sha256 is None:
        raise ParameterError("a graph can only be written if its motions were read from files")
    options = source.options
    if options.skeleton is not None:
        options = replace(options, skeleton=_make_relative(options.skeleton, folder))
    path = _make_relative(source.path, folder)
    return {**vars(source), "path": path, "options": options_to_json(options)}


def _make_relative(path: str, folder: Path) -> str:
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:  # another drive
        return str(Path(path).absolute())


def _parse_graph(data: dict[str, Any]) -> MotionGraph:
    """Return the graph in parsed JSON; raise ValueError if parts are missing or inconsistent."""
    _check_complete(data, MotionGraph)
    graph = convert_json(data, MotionGraph)
    for name, kind in (("sources", Source), ("nodes", Node), ("edges", Edge)):
        for row in data[name]:
            _check_complete(row, kind)
    for row in data["sources"]:
        options_from_json(ReadOptions, row["options"])  # rejects unknown options
    for part, sound in _check_parts(graph):
        if not sound:
            raise ValueError(str(part))
    return graph


def _check_complete(row: dict[str, Any], kind: Any) -> None:
    for part in fields(kind):
        if part.name not in row:
            raise ValueError(f"no {part.name!r}")


def _resolve_source(source: Source, folder: Path) -> Source:
    """Return a source with its paths resolved against the folder of the graph's file."""
    options = source.options
    if options.skeleton is not None:
        options = replace(options, skeleton=str(folder / options.skeleton))
    return replace(source, path=str(folder / str(source.path)), options=options)


def _check_parts(graph: MotionGraph) -> Iterator[tuple[object, bool]]:
    """Yield every part of a graph, and whether it is consistent with the sources."""
    for name in ("fps", "threshold", "window"):
        value = getattr(graph, name)
        yield f"{name} is {value}", 0 < value < _FASTEST
    for source in graph.sources:
        named = isinstance(source.path, str) and isinstance(source.sha256, str)
        yield source, source.n_frames > 0 and named
    frames = [source.n_frames for source in graph.sources]
    for node in graph.nodes:
        placed = node.source in range(len(frames)) and node.cluster >= -1
        yield node, placed and 0 <= node.start < node.stop <= frames[node.source]
    # Jumps leave a node after its middle and enter before it, so that nodes keep some length.
    middles = [(node.start + node.stop) / 2 for node in graph.nodes]
    nodes = range(len(middles))
    for edge in graph.edges:
        placed = edge.tail in nodes and edge.head in nodes and 0 <= edge.distance < _MOST
        moved = placed and max(map(abs, (edge.angle, *edge.shift))) < _MOST
        left = moved and middles[edge.tail] < edge.leave
        yield edge, left and 0 <= edge.enter <= middles[edge.head]
