"""The clusters of a library: what is known of each over all recordings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, get_type_hints

import numpy as np

from kineme.errors import ParameterError
from kineme.library.opened import OpenTables
from kineme.library.storage.layout import arrow, as_column


class Cluster(NamedTuple):
    """A cluster of the library, over all recordings.

    Attributes
    ----------
    cluster : int
    label : str
        Its name, or empty.
    vocabulary : str
        `bodies`, or which channels.
    recordings, activities, repetitions : int
        How many it occurs in; how many activities and primitives there are of it.
    seconds : float
        Of its activities.
    typical_s : float
        Median seconds of a repetition, or of an activity where none was counted.
    example : str
        The recording of its most typical word.
    start_s, stop_s : float
        Where that lies there.
    """

    cluster: int
    label: str
    vocabulary: str
    recordings: int
    activities: int
    repetitions: int
    seconds: float
    typical_s: float
    example: str
    start_s: float
    stop_s: float


class Word(NamedTuple):
    """A cluster of one recording, as part of one of the library.

    Attributes
    ----------
    recording : str
    start_s, stop_s : float
        Its typical segment.
    cluster : int
        Of the library.
    following : int
        The one that it is nearest to but for its own.
    confidence : float
        How much nearer it is to its own, 0 to 1.
    """

    recording: str
    start_s: float
    stop_s: float
    cluster: int
    following: int
    confidence: float


def clusters_of(tables: OpenTables) -> list[Cluster]:
    """The clusters of a library, those of most seconds first."""
    words, segments, told = tables.columns("words"), tables.columns("segments"), tables.recordings
    vocabularies = dict(zip(told["recording"], told["vocabulary"], strict=True))
    lasts = segments["stop_s"] - segments["start_s"]
    active = segments["kind"] != "transition"
    finer = segments["level"] == "primitive"
    found = []
    for number in sorted(set(words["cluster"].tolist())):
        own = np.flatnonzero(words["cluster"] == number)
        typical = own[np.argmin(words["spread"][own])]
        rows = active & (segments["cluster"] == number)
        repeated = rows & finer
        typically = lasts[repeated if repeated.any() else rows]
        recording = str(words["recording"][typical])
        found.append(
            Cluster(
                number,
                tables.edits.name(number),
                vocabularies[recording],
                len(set(words["recording"][own].tolist())),
                int((rows & ~finer).sum()),
                int(repeated.sum()),
                round(float(lasts[rows & ~finer].sum()), 6),
                round(float(np.median(typically)), 6) if len(typically) else 0.0,
                recording,
                float(words["start_s"][typical]),
                float(words["stop_s"][typical]),
            )
        )
    return sorted(found, key=lambda cluster: (-cluster.seconds, cluster.cluster))


def cluster_table(clusters: Sequence[Cluster]) -> Any:
    """The clusters as a pyarrow.Table."""
    pa, _ = arrow()
    hints = get_type_hints(Cluster)
    return pa.table(
        {
            name: as_column([getattr(each, name) for each in clusters], hints[name])
            for name in Cluster._fields
        }
    )


def unsure_words(tables: OpenTables) -> list[Word]:
    """The words that may as well be in another cluster, the least sure first."""
    words, most = tables.columns("words"), tables.head["vocabulary"]["unsure"]
    rows = np.flatnonzero((words["confidence"] < most) & (words["cluster"] != words["following"]))
    rows = rows[np.argsort(words["confidence"][rows], kind="stable")]
    columns = (words[name][rows].tolist() for name in Word._fields)
    return [Word(*row) for row in zip(*columns, strict=True)]


def numbers_of(tables: OpenTables, cluster: int | str) -> list[int]:
    """The numbers of the clusters of that number or name, one at least.

    Parameters
    ----------
    tables : OpenTables
    cluster : int or str

    Raises
    ------
    ParameterError
        There is none.
    """
    there = sorted(set(tables.columns("words")["cluster"].tolist()))
    edits, text = tables.edits, str(cluster)
    named = isinstance(cluster, str)  # a whole number is never taken for a name of digits
    found = [number for number in there if named and edits.name(number) == text]
    if not found and text.isdecimal():
        found = [number for number in there if number == edits.number(int(text))]
    if not found:
        names = ", ".join(edits.name(number) or str(number) for number in there[:20])
        raise ParameterError(f"no cluster is called {text:.60}; there are {names or 'none'}")
    return found
