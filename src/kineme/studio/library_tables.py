"""Tables of a library's recordings, saved tables updated from the library, and its undo history.

A recording without a saved table is shown with the library's table. A saved table belongs to its
editor: it takes clusters and names of the library on request only, and keeps its segments.

Names, merges and splits of a library are one small file. ``.kineme/library.json`` in its folder
keeps what that file held before each edit in the studio. If another program has edited the library
since, nothing can be undone.
"""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from hashlib import sha256
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from kineme._util.files import is_remote
from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.library import Library
from kineme.library.edits import Edits
from kineme.library.storage.layout import (
    EDITS,
    LOCK_EDITS,
    as_array,
    lock_for_writing,
    read_json,
    write_json,
)
from kineme.segments.annotation import Annotation
from kineme.segments.editing import name_cluster
from kineme.segments.editing.borders import renumber_clusters
from kineme.segments.editing.clusters import collect_names, set_cluster_names
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, SegmentTable
from kineme.studio.storage.sidecars import FOLDER, read_sidecar, write_file

MIN_SHARE = 0.5
"""Share of a cluster's frames that must lie in one library cluster to be matched with it."""
STORED_COLUMNS = tuple(name for name, column in COLUMNS.items() if not column.derived)
"""Columns that are not derived from others."""
MAX_STEPS = 200
"""Undo steps kept in the file."""
HISTORY = "library.json"


class LibraryTables:
    """Segment tables of a library; ``segments`` is the table that they were made from."""

    def __init__(self, library: Library):
        self.segments = table = library.table("segments")
        names = np.array(table.column("recording").to_pylist(), object)
        # Rows of a recording follow each other: edges are where the name changes.
        edges = [0, *(np.flatnonzero(names[1:] != names[:-1]) + 1).tolist(), len(names)]
        self._rows = {names[a]: (a, b) for a, b in pairwise(edges) if a < b}
        self._columns = {name: as_array(table.column(name)) for name in STORED_COLUMNS}
        self._library = library
        columns = ("recording", "n_frames", "fps", "format")
        facts = zip(*(library.recordings[column] for column in columns), strict=True)
        self._facts = {
            path.absolute(): (name, *rest)
            for name, *rest in facts
            if not is_remote(path := library.path_of(name))
        }

    def find_table(self, path: Path) -> Segmentation | None:
        """Return the table of the recording in a file; None if the library has none."""
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
        options, folder = self._library.segment_options, self._library.folder
        return Segmentation.from_columns(
            columns,
            n_frames=int(n_frames),
            fps=float(fps),
            provenance={
                "kineme": __version__,
                "preset": options.preset,
                "parameters": dict(options.constants),
                "input": {"path": str(path), "format": kind},
                "notes": [f"segments, clusters and names come from the library {folder.name}"],
            },
            annotation=Annotation(cluster_names=names),
        )


def apply_library_clusters(
    table: Segmentation, library_table: Segmentation, edits: Edits, *, replace_names: bool = False
) -> tuple[Segmentation, int]:
    """Give a table the clusters and names of the library; also return how many kept other names.

    Clusters that were merged in the library are merged. Two other clusters that match the same
    library cluster stay separate, since somebody may have split them: the larger takes the number,
    both take the name. A cluster with a different name keeps it unless ``replace_names``; so does a
    segment with its own name.
    """
    matches, names = match_library_clusters(table, library_table), collect_names(library_table)
    numbers = _assign_numbers(table, matches, edits, {*library_table.table.cluster.tolist()})
    after = renumber_clusters(table, numbers)
    former = collect_names(table)
    # Reversed, so that the first name wins if several clusters get the same number.
    renamed = {numbers[cluster]: former[cluster] for cluster in reversed(former)}
    after = set_cluster_names(after, renamed)
    n_kept = 0
    for cluster, number in numbers.items():
        name = names.get(matches.get(cluster, -1), "")
        present = collect_names(after).get(number, "")
        if not name or name == present:
            continue
        if present and not replace_names:
            n_kept += 1
        else:
            after = name_cluster(after, number, name)
    is_unchanged = after.table.cluster.tolist() == table.table.cluster.tolist()
    return (replace(after, hierarchy=table.hierarchy) if is_unchanged else after), n_kept


def match_library_clusters(table: Segmentation, library_table: Segmentation) -> dict[int, int]:
    """Return the library cluster that matches each cluster of a table, if one does.

    It holds at least `MIN_SHARE` of the cluster's frames. Both tables have equally many frames.
    """
    votes: dict[int, Counter[int]] = {}
    for rows, library_rows in (
        (table.activities, library_table.activities),
        (table.primitives, library_table.primitives),
    ):
        if not len(rows) or not len(library_rows):
            continue
        pairs = np.stack([_spread_clusters(rows), _spread_clusters(library_rows)])
        # Pairs (cluster, library cluster), and the number of frames of each.
        combinations, counts = np.unique(pairs, axis=1, return_counts=True)
        for (cluster, match), count in zip(combinations.T.tolist(), counts.tolist(), strict=True):
            if cluster >= 0:
                votes.setdefault(cluster, Counter())[match] += count
    winners = {cluster: counter.most_common(1)[0] for cluster, counter in votes.items()}
    return {
        cluster: match
        for cluster, (match, count) in winners.items()
        if match >= 0 and count >= MIN_SHARE * votes[cluster].total()
    }


def _assign_numbers(
    table: Segmentation, matches: dict[int, int], edits: Edits, present: set[int]
) -> dict[int, int]:
    """Return the new number of each cluster of a table, the largest cluster first."""
    sizes: Counter[int] = Counter(table.table.cluster.tolist())
    del sizes[-1]
    next_free = max([-1, *sizes, *present]) + 1
    numbers: dict[int, int] = {}
    # The largest first: it gets the number if several clusters match the same one.
    for cluster, _ in sizes.most_common():
        number: int = matches.get(cluster, cluster)
        is_merged = cluster != number and edits.number(cluster) == number
        is_used = number in numbers.values() or (cluster not in matches and number in present)
        # Numbers are shared only by clusters that people have merged.
        if is_used and not is_merged:
            number = next_free
            next_free += 1
        numbers[cluster] = number
    return numbers


def _spread_clusters(rows: SegmentTable) -> NDArray[np.int64]:
    """Return the cluster of each frame."""
    return np.repeat(rows.cluster, rows.stop_frame - rows.start_frame)


class Step(Struct, frozen=True):
    """An edit: its description, the content before it, and the digest of the content after it."""

    what: str
    before: dict[str, Any]
    after: str


class LibraryHistory:
    """Edits of a library in the studio, of which the last can be undone."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._path = folder / FOLDER / HISTORY

    def present(self) -> dict[str, Any]:
        """Return the content of the edits file."""
        return read_json(self._folder / EDITS)

    def add(self, what: str, before: dict[str, Any]) -> None:
        """Record an edit that has been made; ``before`` is the content before it."""
        after = self.present()
        if after != before:
            self._write([*self._steps(), Step(what, before, _compute_digest(after))])

    def last(self) -> str:
        """Return the description of the edit that can be undone; empty if there is none."""
        steps = self._steps()
        return (
            steps[-1].what if steps and steps[-1].after == _compute_digest(self.present()) else ""
        )

    def undo(self) -> None:
        """Undo the last edit; ParameterError if there is none, or the library has changed since."""
        with lock_for_writing(self._folder, "try again", LOCK_EDITS):
            if not self.last():
                raise ParameterError("nothing to undo, or the library was changed meanwhile")
            *steps, last = self._steps()
            if last.before:
                write_json(self._folder / EDITS, last.before)
            else:  # before the first edit there was no file
                Edits().write(self._folder)
        self._write(steps)

    def _steps(self) -> list[Step]:
        return read_sidecar(self._path, list[Step], [])[0]

    def _write(self, steps: list[Step]) -> None:
        content = msgspec.json.encode(steps[-MAX_STEPS:])
        write_file(self._path, msgspec.json.format(content, indent=1))


def _compute_digest(content: dict[str, Any]) -> str:
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
