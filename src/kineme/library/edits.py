"""Edits of clusters by people: names, merges, splits; stored apart from computed tables.

Edits refer to cluster numbers, which stay the same between builds. They are applied when tables
are read: splits first, then merges, then names.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Ints
from kineme._util.json import convert_json
from kineme.errors import ParameterError, ReadError
from kineme.library.storage.layout import (
    EDITS,
    MOST_CLUSTERS,
    as_array,
    as_column,
    read_json,
    write_json,
)
from kineme.segments.annotation import as_text

SCHEMA = "kineme.library.edits/1"
Number = Annotated[int, msgspec.Meta(ge=-1, lt=MOST_CLUSTERS)]
"""Number of a cluster; -1: no cluster."""


@dataclass(frozen=True)
class Split:
    """Move the segments of a cluster in some recordings to another cluster."""

    cluster: Number
    into: Number
    recordings: tuple[str, ...]


@dataclass(frozen=True)
class Edits:
    """All edits of a library.

    Parameters
    ----------
    names : Mapping of int to str
        Names of clusters.
    merged : Mapping of int to int
        Merged clusters, and the cluster each belongs to.
    splits : tuple of Split

    Examples
    --------
    >>> edits = Edits().with_merge(2, [5]).with_name(2, "walk")
    >>> edits.number(5), edits.name(5)
    (2, 'walk')
    """

    names: Mapping[Number, str] = field(default_factory=dict)
    merged: Mapping[Number, Number] = field(default_factory=dict)
    splits: tuple[Split, ...] = ()

    @property
    def next_cluster(self) -> int:
        """Return the first cluster number above all numbers in the edits."""
        return max([-1, *self.names, *self.merged, *(split.into for split in self.splits)]) + 1

    def number(self, cluster: int) -> int:
        """Return the cluster that a computed one was merged into, or itself."""
        return self.merged.get(cluster, cluster)

    def name(self, cluster: int) -> str:
        """Return the name of a cluster, empty if it has none."""
        return self.names.get(self.number(cluster), "")

    def with_name(self, cluster: int, name: str) -> Edits:
        """Return the edits with a name for a cluster; an empty name removes it."""
        name = as_text(name, "a name")
        if name != name.strip() or not name.isprintable():
            raise ParameterError(f"a name is one line of plain text, not {name!r:.60}")
        names = {**self.names, self.number(cluster): name}
        return replace(self, names={number: text for number, text in names.items() if text})

    def with_merge(self, cluster: int, others: Sequence[int]) -> Edits:
        """Return the edits with others merged into a cluster, which keeps its number and name.

        If it has no name, it gets that of the first of the others that has one.
        """
        target = self.number(cluster)
        name = next(filter(None, map(self.name, (target, *others))), "")
        moved = {self.number(other) for other in others} - {target}
        merged = {old: target if new in moved else new for old, new in self.merged.items()}
        names = {number: text for number, text in self.names.items() if number not in moved}
        merged |= dict.fromkeys(sorted(moved), target)
        return replace(self, merged=merged, names=names).with_name(target, name)

    def with_split(self, cluster: int, into: int, recordings: Sequence[str]) -> Edits:
        """Return the edits with the segments of a cluster in some recordings as a new cluster."""
        target = self.number(cluster)
        parts = [target, *(old for old, new in self.merged.items() if new == target)]
        names = tuple(sorted(map(str, recordings)))
        splits = tuple(Split(part, into, names) for part in sorted(parts))
        return replace(self, splits=(*self.splits, *splits))

    def with_renamed(self, former: Mapping[str, str]) -> Edits:
        """Return the edits with splits that apply to renamed recordings.

        ``former`` holds the former name of each recording by its name. Splits also keep the names
        of removed recordings, in case these are restored.
        """
        splits = []
        for split in self.splits:
            names = {*split.recordings}
            new = {name for name, old in former.items() if old in names}
            recordings = tuple(sorted(names.difference(former.values()) | new))
            splits.append(replace(split, recordings=recordings))
        return replace(self, splits=tuple(splits))

    def apply(self, clusters: Ints, recordings: NDArray[Any]) -> Ints:
        """Return cluster numbers of rows after the edits, given their recordings."""
        result = clusters.copy()
        for split in self.splits:
            result[(result == split.cluster) & np.isin(recordings, split.recordings)] = split.into
        for old, new in self.merged.items():
            result[result == old] = new
        return result

    def write(self, folder: Path) -> None:
        """Write the edits to the folder of a library."""
        content = msgspec.to_builtins(self, str_keys=True)
        write_json(folder / EDITS, {"schema": SCHEMA, **content})


def read_edits(folder: Path) -> Edits:
    """Return the edits stored in the folder of a library."""
    path = folder / EDITS
    content = read_json(path)
    if not content:
        return Edits()
    if content.get("schema") != SCHEMA:
        raise ReadError(path, f"has schema {content.get('schema')!r:.40}, not {SCHEMA}")
    try:
        # Without these, missing parts would be taken for empty ones.
        parts = {name: content[name] for name in ("names", "merged", "splits")}
        return convert_json(parts, Edits)
    except (ValueError, KeyError) as error:
        raise ReadError(path, "is damaged: its names, merges or splits are not valid") from error


def apply_edits(table: Any, edits: Edits) -> Any:
    """Return a computed table with the edits applied and columns of names added.

    ``label`` holds the names of ``cluster``, ``action_label`` those of ``action`` if present.
    """
    recordings = as_array(table.column("recording"))
    for name, label in (("cluster", "label"), ("next_cluster", None), ("action", "action_label")):
        if name not in table.column_names:
            continue
        clusters = edits.apply(as_array(table.column(name)), recordings)
        table = table.set_column(table.column_names.index(name), name, as_column(clusters, int))
        if label is not None:
            column = _list_names(clusters, edits)
            if label in table.column_names:
                table = table.set_column(table.column_names.index(label), label, column)
            elif label == "action_label":
                table = table.append_column(label, column)
            else:
                table = table.add_column(table.column_names.index(name) + 1, label, column)
    return table


def _list_names(clusters: Ints, edits: Edits) -> Any:
    """Return the name of each cluster as a pyarrow array."""
    unique, inverse = np.unique(clusters, return_inverse=True)
    names = as_column([edits.name(number) for number in unique.tolist()], str)
    return names.take(as_column(inverse, int))
