"""From pieces to the words of a vocabulary: which segment stands for a cluster."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme.library.constants import VOCABULARY, VocabularyConstants
from kineme.library.storage.pieces import Piece, read_features
from kineme.library.vocabulary.crowds import Crowd
from kineme.library.vocabulary.joining import Word
from kineme.segments.table import SegmentTable

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Place:
    """Where a word comes from.

    Attributes
    ----------
    recording : int
        Its number among those of the library.
    own_cluster : int
        The cluster in that recording.
    start_s, stop_s : float
        Its typical segment.
    seconds : float
        Of all its segments.
    embedding : (32,) array
        Of its typical segment.
    """

    recording: int
    own_cluster: int
    start_s: float
    stop_s: float
    seconds: float
    embedding: NDArray[np.float32]


def places_in(piece: Piece, recording: int) -> list[Place]:
    """The words of a recording: one for each cluster that it has.

    The typical segment is the repetition of median length, or the activity where none was
    counted.
    """
    table = piece.table
    places = []
    for cluster in sorted(set(table.cluster[table.kind == "activity"].tolist()) - {-1}):
        own = np.flatnonzero((table.cluster == cluster) & (table.kind == "activity"))
        rows = table[own]
        repeated = rows.level == "primitive"
        chosen = own[repeated] if repeated.any() else own
        order = np.argsort(table.duration_s[chosen], kind="stable")
        row = int(chosen[order[len(order) // 2]])
        typical = table[row]
        longest = rows[rows.level == rows.level[0]]  # one level: activities where there are any
        seconds = round(float(longest.duration_s.sum()), 6)
        span, embedding = (typical.start_s, typical.stop_s), piece.embeddings[row]
        places.append(Place(recording, cluster, *span, seconds, embedding))
    return places


def crowd_of(
    places: Sequence[Place], pieces: Sequence[Piece], folder: Path, keys: Sequence[str]
) -> Crowd:
    """The words at these places, drawn in an order that depends on each of them alone."""

    def word(number: int) -> Word:
        place = places[number]
        at = place.recording
        return word_at(place, pieces[at], folder, keys[at], VOCABULARY)

    names = [f"{keys[place.recording]} {place.own_cluster}" for place in places]
    drawn = [sha256(name.encode()).digest() for name in names]
    return Crowd(
        word,
        np.array([place.recording for place in places]),
        np.array([place.seconds for place in places]),
        np.array([place.embedding for place in places]),
        np.array(sorted(range(len(places)), key=drawn.__getitem__)),
    )


def word_at(
    place: Place, piece: Piece, folder: Path, key: str, constants: VocabularyConstants
) -> Word:
    """The features of a word, as they are compared."""
    features, fps = read_features(folder, key), piece.facts["features_fps"]

    def between(start_s: float, stop_s: float) -> NDArray[np.float32]:
        first = min(round(start_s * fps), len(features) - 1)
        return features[first : max(round(stop_s * fps), first + 1)]

    middle = (place.start_s + place.stop_s) / 2
    half = min(place.stop_s - place.start_s, constants.longest_example) / 2
    start_s, stop_s = _around(piece.table, middle)
    reach = max(constants.longest_context, 2 * half) / 2
    return Word(
        between(middle - half, middle + half),
        between(
            max(min(start_s, middle - half), middle - reach),
            min(max(stop_s, middle + half), middle + reach),
        ),
        place.recording,
        place.seconds,
    )


def _around(table: SegmentTable, second: float) -> tuple[float, float]:
    """The activity that lies around a second."""
    activities = table[table.level == "activity"]
    inside = activities[(activities.start_s <= second) & (second < activities.stop_s)]
    return (inside[0].start_s, inside[0].stop_s) if len(inside) else (second, second)
