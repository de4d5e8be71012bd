"""Edits of a library that is open: clusters named, merged and split, and that kept at once."""

from __future__ import annotations

from collections.abc import Sequence

from kineme.errors import ParameterError
from kineme.library.clusters import numbers_of
from kineme.library.opened import OpenTables


def name_cluster(tables: OpenTables, cluster: int | str, name: str) -> None:
    """Call a cluster, by number or name, by a name; an empty one takes it away."""
    with tables.editing():
        edits = tables.edits
        for number in numbers_of(tables, cluster):
            edits = edits.with_name(number, name)
        tables.write(edits)


def merge_clusters(tables: OpenTables, cluster: int | str, others: Sequence[int | str]) -> None:
    """Make other clusters part of one, which keeps its number and name.

    Parameters
    ----------
    tables : OpenTables
    cluster : int or str
        By number or name.
    others : sequence of int or str

    Raises
    ------
    ParameterError
        There are no others, or no cluster is called so.
    """
    if not others:
        raise ParameterError("nothing to merge: name two clusters at least")
    with tables.editing():
        target, *same = numbers_of(tables, cluster)
        moved = [*same, *(number for other in others for number in numbers_of(tables, other))]
        tables.write(tables.edits.with_merge(target, moved))


def split_cluster(tables: OpenTables, cluster: int | str, recordings: Sequence[str]) -> int:
    """Make what a cluster has in some recordings a cluster of its own.

    Parameters
    ----------
    tables : OpenTables
    cluster : int or str
        By number or name.
    recordings : sequence of str

    Returns
    -------
    int
        The number of the new cluster.

    Raises
    ------
    ParameterError
        It is in none of these recordings, or in no other.
    """
    with tables.editing():
        (number, *_) = numbers_of(tables, cluster)
        words = tables.columns("words")
        there = set(words["recording"][words["cluster"] == number].tolist())
        if not there.intersection(recordings) or there <= set(recordings):
            raise ParameterError(
                f"cluster {number} is split by naming some, not all, of its {len(there)} "
                f"recordings: {', '.join(sorted(there)[:5])}"
            )
        into: int = max(tables.head["following"], tables.edits.following)
        tables.write(tables.edits.with_split(number, into, recordings))
    return into
