"""Tables of a library's recordings, with its clusters and names; and tables that take these.

A recording whose table nobody has saved is shown as the library has it. A saved one is what people
made of it: it takes numbers and names of the library when they say so, and keeps its segments.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._version import __version__
from kineme.library import Library
from kineme.library.edits import Edits
from kineme.library.storage.layout import as_array
from kineme.library.storage.places import is_remote
from kineme.segments.annotation import Annotation
from kineme.segments.editing import name_cluster
from kineme.segments.editing.clusters import collect_names, set_cluster_names
from kineme.segments.editing.rows import renumber_clusters
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, SegmentTable

LEAST_SHARE = 0.5
"""Of a cluster's frames that lie in one of the library, from which it is that one."""
COMPUTED = tuple(name for name, column in COLUMNS.items() if not column.derived)


class LibraryTables:
    """Segment tables of a library as it is now."""

    def __init__(self, library: Library):
        table = library.table("segments")
        names = np.array(table.column("recording").to_pylist(), object)
        # Rows of a recording follow each other: edges are where the name changes.
        edges = [0, *(np.flatnonzero(names[1:] != names[:-1]) + 1).tolist(), len(names)]
        self._rows = {names[a]: (a, b) for a, b in pairwise(edges) if a < b}
        self._columns = {name: as_array(table.column(name)) for name in COMPUTED}
        self._library = library
        of = library.recordings
        facts = zip(of["recording"], of["n_frames"], of["fps"], of["format"], strict=True)
        paths = ((library.path_of(name), name, *rest) for name, *rest in facts)
        self._facts = {
            path.absolute(): (name, n_frames, fps, kind)
            for path, name, n_frames, fps, kind in paths
            if not is_remote(path)
        }

    def of(self, path: Path) -> Segmentation | None:
        """Return the table of the recording in a file; None where the library has none."""
        facts = self._facts.get(path.absolute())
        if facts is None or facts[0] not in self._rows:
            return None
        name, n_frames, fps, kind = facts
        start, stop = self._rows[name]
        columns: dict[str, Any] = {
            column: values[start:stop] for column, values in self._columns.items()
        }
        labels = zip(columns["cluster"].tolist(), columns["label"].tolist(), strict=True)
        names = {cluster: label for cluster, label in labels if cluster >= 0 and label}
        options, home = self._library.segment_options, self._library.folder
        return Segmentation.from_columns(
            columns,
            n_frames=int(n_frames),
            fps=float(fps),
            provenance={
                "kineme": __version__,
                "preset": options.preset,
                "parameters": dict(options.constants),
                "input": {"path": str(path), "format": kind},
                "notes": [f"segments, clusters and names are those of the library {home.name}"],
            },
            annotation=Annotation(cluster_names=names),
        )


def match_library_clusters(table: Segmentation, of_library: Segmentation) -> dict[int, int]:
    """Return the clusters of a table that are clusters of the library, with its numbers.

    A cluster is the one of the library that most of its frames lie in.
    """
    votes: dict[int, Counter[int]] = {}
    for rows, others in (
        (table.activities, of_library.activities),
        (table.primitives, of_library.primitives),
    ):
        if not len(rows) or not len(others):
            continue
        pairs = np.stack([_spread_clusters(rows), _spread_clusters(others)])
        # (cluster, number) pairs, and on how many frames they occur.
        places, counts = np.unique(pairs, axis=1, return_counts=True)
        for (cluster, number), count in zip(places.T.tolist(), counts.tolist(), strict=True):
            if cluster >= 0:
                votes.setdefault(cluster, Counter())[number] += count
    best = {cluster: found.most_common(1)[0] for cluster, found in votes.items()}
    return {
        cluster: number
        for cluster, (number, count) in best.items()
        if number >= 0 and count >= LEAST_SHARE * votes[cluster].total()
    }


def apply_library_clusters(
    table: Segmentation, of_library: Segmentation, edits: Edits, *, replace_names: bool = False
) -> tuple[Segmentation, int]:
    """A table with the numbers and names of the library, and how many clusters keep another name.

    Clusters that the library has merged are merged; two others that lie in one of the library stay
    two, since people may have parted them: the larger has its number, both its name. A cluster that
    has another name keeps it unless ``replace_names``, and so does each segment with its own.
    """
    places, names = match_library_clusters(table, of_library), collect_names(of_library)
    numbers = _assign_numbers(table, places, edits, {*of_library.table.cluster.tolist()})
    after = renumber_clusters(table, numbers)
    former = collect_names(table)
    # Reversed: of clusters that get one number the first one's name wins.
    renamed = {numbers[cluster]: former[cluster] for cluster in reversed(former)}
    after = set_cluster_names(after, renamed)
    kept = 0
    for cluster, number in numbers.items():
        name = names.get(places.get(cluster, -1), "")
        present = collect_names(after).get(number, "")
        if not name or name == present:
            continue
        if present and not replace_names:
            kept += 1
        else:
            after = name_cluster(after, number, name)
    same = after.table.cluster.tolist() == table.table.cluster.tolist()
    return (replace(after, hierarchy=table.hierarchy) if same else after), kept


def _assign_numbers(
    table: Segmentation, places: dict[int, int], edits: Edits, present: set[int]
) -> dict[int, int]:
    """Return the numbers that the clusters of a table get, the largest first."""
    sizes: Counter[int] = Counter(table.table.cluster.tolist())
    del sizes[-1]
    following = max([-1, *sizes, *present]) + 1
    numbers: dict[int, int] = {}
    # The largest first: it gets the number that several could have.
    for cluster, _ in sizes.most_common():
        number: int = places.get(cluster, cluster)
        merged = cluster != number and edits.number(cluster) == number
        is_used = number in numbers.values() or (cluster not in places and number in present)
        # Numbers are shared only by clusters that people have merged.
        if is_used and not merged:
            number = following
            following += 1
        numbers[cluster] = number
    return numbers


def _spread_clusters(rows: SegmentTable) -> NDArray[np.int64]:
    """Return the cluster of each frame of a level."""
    return np.repeat(rows.cluster, rows.stop_frame - rows.start_frame)
