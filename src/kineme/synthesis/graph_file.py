"""Motion graphs as JSON, schema ``kineme.motion-graph/1``.

One object:

    {
      "schema": "kineme.motion-graph/1",
      "fps": 120.0, "threshold": 0.08, "window": 0.333,    as in MotionGraph
      "sources": [{"path": "86_10.amc", "sha256": "...", "n_frames": 7583, "options": {}}],
      "nodes": [{"source": 0, "start": 0, "stop": 312, "cluster": 0, "label": ""}],
      "edges": [{"tail": 0, "head": 1, "leave": 312, "enter": 312, "distance": 0.0,
                 "angle": 0.0, "shift": [0.0, 0.0], "jump": false}]
    }

Paths are relative to the graph's folder. The recordings are not in the file:
they are read again, with ``options``, and must be the same byte for byte. A
reader must ignore names it does not know; a change that old readers would
misunderstand gets the next number.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import asdict, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

from kineme._files import atomic_write, reading
from kineme._json import loaded
from kineme.errors import ParameterError, ReadError
from kineme.formats import read_motion
from kineme.recordings import Motion
from kineme.synthesis.graph import Edge, MotionGraph, Node, Source

SCHEMA = "kineme.motion-graph/1"
OPTIONS = ("skeleton", "fps", "unit", "up")

_MOST = 1e9  # metres, seconds, frames per second

Json = dict[str, Any]


def write_graph(graph: MotionGraph, path: str | os.PathLike[str]) -> None:
    """Leave the graph at ``path``.

    Parameters
    ----------
    graph : MotionGraph
    path : path-like

    Raises
    ------
    ParameterError
        A source came from no file, so that nobody could read it again.
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
        "sources": [_source_cells(source, folder) for source in graph.sources],
    }
    text = json.dumps(head, indent=2).removesuffix("\n}")
    for name, rows in (("nodes", graph.nodes), ("edges", graph.edges)):
        lines = ",\n".join(f"    {json.dumps(asdict(row))}" for row in rows)
        text += f',\n  "{name}": [\n{lines}\n  ]'
    with atomic_write(path) as draft:
        draft.write_text(text + "\n}\n", encoding="utf-8")


def read_graph(path: str | os.PathLike[str]) -> MotionGraph:
    """The graph at ``path``.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    MotionGraph

    Raises
    ------
    ReadError
        Missing, damaged or of another version.

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
    data = loaded(Path(path))
    schema = data.get("schema") if isinstance(data, dict) else None
    if not str(schema).startswith("kineme.motion-graph/"):
        raise ReadError(path, "is not a motion graph: make one with kineme graph FILES")
    if schema != SCHEMA:
        raise ReadError(path, f"has schema {schema!r}, but this version reads {SCHEMA!r}")
    try:
        return _graph(data, Path(path).absolute().parent)
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        what = f"no {error}" if isinstance(error, KeyError) else str(error)
        raise ReadError(
            path, f"is damaged ({what:.120}): build it anew with kineme graph"
        ) from error


def load_sources(graph: MotionGraph) -> list[Motion]:
    """The recordings the graph was built on, in order.

    Parameters
    ----------
    graph : MotionGraph

    Returns
    -------
    list of Motion

    Raises
    ------
    ReadError
        One is missing or was changed since.

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
        with reading(path):
            exists = path.is_file()
            digest = sha256(path.read_bytes()).hexdigest() if exists else ""
        if not exists:
            raise ReadError(path, "is not there, and the graph was built on it: put it back, "
                            "or build the graph anew")  # fmt: skip
        if digest != source.sha256:
            raise ReadError(path, "has changed since the graph was built on it: build it anew")
        motions.append(read_motion(path, **source.options))
    return motions


def _source_cells(source: Source, folder: Path) -> Json:
    if source.path is None or source.sha256 is None:
        raise ParameterError("a graph can be written if its motions were read from files")
    options = dict(source.options)
    if "skeleton" in options:
        options["skeleton"] = _relative(options["skeleton"], folder)
    return asdict(replace(source, path=_relative(source.path, folder), options=options))


def _relative(path: str, folder: Path) -> str:
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:  # another drive
        return str(Path(path).absolute())


def _graph(data: Json, folder: Path) -> MotionGraph:
    sources = tuple(_source(row, folder) for row in data["sources"])
    nodes = tuple(_node(row, sources) for row in data["nodes"])
    edges = tuple(_edge(row, nodes) for row in data["edges"])
    fps, threshold, window = (
        _checked(data, name, _number, lambda x: 0 < x < 1e6)
        for name in ("fps", "threshold", "window")
    )
    return MotionGraph(sources, nodes, edges, fps, threshold, window)


def _source(row: Json, folder: Path) -> Source:
    options = {name: value for name, value in row["options"].items() if name in OPTIONS}
    if "skeleton" in options:
        options["skeleton"] = str(folder / options["skeleton"])
    frames = _checked(row, "n_frames", int, lambda n: n > 0)
    return Source(str(folder / row["path"]), str(row["sha256"]), frames, options)


def _node(row: Json, sources: tuple[Source, ...]) -> Node:
    source = _checked(row, "source", int, lambda s: 0 <= s < len(sources))
    stop = _checked(row, "stop", int, lambda n: n <= sources[source].n_frames)
    start = _checked(row, "start", int, lambda n: 0 <= n < stop)
    return Node(source, start, stop, _checked(row, "cluster", int, lambda c: c >= -1),
                _checked(row, "label", str, lambda _: True))  # fmt: skip


def _edge(row: Json, nodes: tuple[Node, ...]) -> Edge:
    tail, head = (
        _checked(row, end, int, lambda n: 0 <= n < len(nodes)) for end in ("tail", "head")
    )
    from_node, to_node = nodes[tail], nodes[head]
    x, z = (_number(value) for value in row["shift"])
    return Edge(
        tail,
        head,
        _checked(row, "leave", int, lambda n: _middle(from_node) < n),
        _checked(row, "enter", int, lambda n: 0 <= n <= _middle(to_node)),
        _checked(row, "distance", _number, lambda d: d >= 0),
        _checked(row, "angle", _number, lambda _: True),
        (x, z),
        _checked(row, "jump", bool, lambda _: True),
    )


def _middle(node: Node) -> float:
    return (node.start + node.stop) / 2


def _checked(row: Json, name: str, kind: Callable[[Any], Any], fits: Callable[[Any], bool]) -> Any:
    value = row[name]
    if isinstance(kind, type) and type(value) is not kind:
        raise ValueError(f"{name} is {value!r:.40}")
    value = kind(value)
    if not fits(value):
        raise ValueError(f"{name} is {value!r:.40}")
    return value


def _number(value: Any) -> float:
    if type(value) not in (int, float) or not -_MOST < value < _MOST:
        raise ValueError(f"{value!r:.40} is no number")
    return float(value)
