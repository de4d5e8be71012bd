"""The clusters of a library: what is known of each over all recordings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, get_type_hints

import numpy as np
from numpy.typing import NDArray

from kineme.library.edits import Edits
from kineme.library.layout import arrow

Columns = Mapping[str, NDArray[Any]]


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


def unsure_words(words: Columns, most: float) -> list[Word]:
    """The words of least confidence, below ``most``, the least sure first.

    Parameters
    ----------
    words : mapping of str to array
        The table of a library, edits applied.
    most : float
    """
    rows = np.flatnonzero((words["confidence"] < most) & (words["cluster"] != words["following"]))
    rows = rows[np.argsort(words["confidence"][rows], kind="stable")]
    columns = (words[name][rows].tolist() for name in Word._fields)
    return [Word(*row) for row in zip(*columns, strict=True)]


def clusters_of(
    words: Columns, segments: Columns, vocabularies: Mapping[str, str], edits: Edits
) -> list[Cluster]:
    """The clusters, those of most seconds first.

    Parameters
    ----------
    words, segments : mapping of str to array
        The tables of a library, edits applied.
    vocabularies : mapping of str to str
        That of each recording.
    edits : Edits
        Names.
    """
    lasts = segments["stop_s"] - segments["start_s"]
    active = segments["kind"] == "activity"
    finer = segments["level"] == "primitive"
    found = []
    for number in sorted(set(words["cluster"].tolist())):
        own = np.flatnonzero(words["cluster"] == number)
        typical = own[np.argmin(words["spread"][own])]
        rows = active & (segments["cluster"] == number)
        repeated = rows & finer
        recording = str(words["recording"][typical])
        found.append(
            Cluster(
                number,
                edits.name(number),
                vocabularies[recording],
                len(set(words["recording"][own].tolist())),
                int((rows & ~finer).sum()),
                int(repeated.sum()),
                round(float(lasts[rows & ~finer].sum()), 6),
                round(float(np.median(lasts[repeated if repeated.any() else rows])), 6),
                recording,
                float(words["start_s"][typical]),
                float(words["stop_s"][typical]),
            )
        )
    return sorted(found, key=lambda cluster: (-cluster.seconds, cluster.cluster))


def cluster_table(clusters: Sequence[Cluster]) -> Any:
    """The clusters as a pyarrow.Table."""
    pa, _ = arrow()
    types = {int: pa.int64(), float: pa.float64(), str: pa.string()}
    hints = get_type_hints(Cluster)
    schema = pa.schema([(name, types[hints[name]]) for name in Cluster._fields])
    return pa.Table.from_pylist([cluster._asdict() for cluster in clusters], schema=schema)
