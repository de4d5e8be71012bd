"""From pieces to the words of a vocabulary: which segment stands for a cluster."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme.library.constants import VocabularyConstants
from kineme.library.pieces import Piece, read_features
from kineme.library.vocabulary import Word
from kineme.segments.table import SegmentTable

Ints = NDArray[np.int64]


@dataclass(frozen=True)
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
    """

    recording: int
    own_cluster: int
    start_s: float
    stop_s: float
    seconds: float


def places_in(piece: Piece, recording: int) -> list[Place]:
    """The words of a recording: one for each cluster that it has.

    The typical segment is the repetition of median length, or the activity where none was
    counted.
    """
    table = piece.table
    places = []
    for cluster in sorted(set(table.cluster[table.kind == "activity"].tolist()) - {-1}):
        rows = table[(table.cluster == cluster) & (table.kind == "activity")]
        repetitions = rows[rows.level == "primitive"]
        chosen = repetitions if len(repetitions) else rows
        order = np.argsort(chosen.duration_s, kind="stable")
        typical = chosen[int(order[len(order) // 2])]
        longest = rows[rows.level == rows.level[0]]  # one level: activities where there are any
        seconds = round(float(longest.duration_s.sum()), 6)
        places.append(Place(recording, cluster, typical.start_s, typical.stop_s, seconds))
    return places


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
