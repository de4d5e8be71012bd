"""From analyses to the words of a vocabulary: which segment stands for a cluster."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme.library.settings import VOCABULARY, VocabularyConstants
from kineme.library.storage.analyses import Analysis, read_spans
from kineme.library.vocabulary.joining import Crowd, Word
from kineme.segments.table import SegmentTable


@dataclass(frozen=True, eq=False)
class Place:
    """Where a word comes from.

    Attributes
    ----------
    recording : int
        Its number among those of the library.
    cluster : int
        The cluster in that recording.
    start_s, stop_s : float
        Its typical segment.
    seconds : float
        Of all its segments.
    embedding : (32,) array
        Of its typical segment.
    spans : (segments, 2) array
        Starts and stops of all its segments, seconds.
    """

    recording: int
    cluster: int
    start_s: float
    stop_s: float
    seconds: float
    embedding: NDArray[np.float32]
    spans: NDArray[np.float64]


def places_in(analysis: Analysis, recording: int) -> list[Place]:
    """Return the words of a recording: one for each cluster that it has.

    The typical segment is the repetition of median length, or the activity where none was
    counted.
    """
    table = analysis.table
    active, finer, lasts = table.kind != "transition", table.level == "primitive", table.duration_s
    places = []
    for cluster in sorted(set(table.cluster[active].tolist()) - {-1}):
        members = np.flatnonzero((table.cluster == cluster) & active)
        repeated = members[finer[members]]
        chosen = repeated if len(repeated) else members
        row = int(chosen[np.argsort(lasts[chosen], kind="stable")[len(chosen) // 2]])
        longest = members[
            finer[members] == finer[members[0]]
        ]  # one level: activities where there are any
        places.append(
            Place(
                recording,
                cluster,
                float(table.start_s[row]),
                float(table.stop_s[row]),
                round(float(lasts[longest].sum()), 6),
                analysis.embeddings[row],
                np.column_stack([table.start_s[longest], table.stop_s[longest]]),
            )
        )
    return places


class _Spans(NamedTuple):
    """Where the features of a word lie in an analysis: its example and its context, in samples."""

    key: str
    example: tuple[int, int]
    context: tuple[int, int]


def crowd_of(
    places: Sequence[Place], analyses: Sequence[Analysis], folder: Path, keys: Sequence[str]
) -> Crowd:
    """Return the words at these places, drawn in an order that depends on each of them alone."""
    names = [f"{keys[place.recording]} {place.cluster}" for place in places]
    drawn = b"".join(sha256(name.encode()).digest()[:8] for name in names)
    spans = [
        _spans(place, analyses[place.recording], keys[place.recording], VOCABULARY)
        for place in places
    ]
    return Crowd(
        partial(_word_at, folder),
        spans,
        np.array([place.recording for place in places]),
        np.array([place.seconds for place in places]),
        np.array([place.embedding for place in places]),
        np.frombuffer(drawn, ">u8"),
    )


def _word_at(folder: Path, spans: _Spans) -> Word:
    """Return the features of a word, as they are compared."""
    return Word(*read_spans(folder, spans.key, (spans.example, spans.context)))


def _spans(place: Place, analysis: Analysis, key: str, constants: VocabularyConstants) -> _Spans:
    fps, samples = analysis.facts["features_fps"], analysis.facts["samples"]

    def between(start_s: float, stop_s: float) -> tuple[int, int]:
        first = min(round(start_s * fps), samples - 1)
        return first, min(max(round(stop_s * fps), first + 1), samples)

    middle = (place.start_s + place.stop_s) / 2
    half = min(place.stop_s - place.start_s, constants.longest_example) / 2
    start_s, stop_s = _around(analysis.table, middle)
    reach = max(constants.longest_context, 2 * half) / 2
    first_s = max(min(start_s, middle - half), middle - reach)
    last_s = min(max(stop_s, middle + half), middle + reach)
    return _Spans(key, between(middle - half, middle + half), between(first_s, last_s))


def _around(table: SegmentTable, second: float) -> tuple[float, float]:
    """Return the activity that lies around a second."""
    around = (table.level == "activity") & (table.start_s <= second) & (second < table.stop_s)
    row = int(np.argmax(around))
    return (float(table.start_s[row]), float(table.stop_s[row])) if around[row] else (second,) * 2
