"""One vocabulary of signals: clusters of samples of channels of all recordings, which words take.

Clusters of single recordings are not comparable between recordings: one that only walks tells fast
from slow, one that walks and sits does not. So these are not joined. Some samples of all recordings
are clustered (`kineme.transfer.vocabulary`), in units of the whole library, and each word takes the
cluster that the samples of its segments are nearest to in the mean. docs/sets.md tells how well
that goes.

A task tells where the samples of some recordings lie; whoever works on it reads them there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Float32s, Floats
from kineme.library.executors import Executor
from kineme.library.storage.analyses import Analysis, read_channel_samples
from kineme.library.vocabulary.joining import Joined, beside_others, results
from kineme.library.vocabulary.words import Place
from kineme.transfer.channel_samples import Units

MOST = 20_000
"""Samples that are clustered; of more, as many at equal steps, one of each recording at least."""
AT_ONCE = 50
"""Recordings of a task."""
PER_WORKER = 1000
"""Recordings for which one process more is started: some seconds of work."""


@dataclass(frozen=True, eq=False)
class _Search:
    """Words of some recordings, by the segments of each, whose nearest clusters are looked for."""

    folder: Path
    keys: Sequence[str]
    words: Sequence[Sequence[Floats]]
    units: Units
    centres: Float32s


def clusters_of_signals(
    places: Sequence[Place],
    analyses: Sequence[Analysis],
    folder: Path,
    keys: Sequence[str],
    executor: Executor,
) -> Joined:
    """The clusters of words of signals; spread is the distance from the centre of the cluster."""
    from kineme.transfer.vocabulary import centres_of, likely_number  # scikit-learn takes a second

    numbers = sorted({place.recording for place in places})
    step = -(-sum(analyses[number].facts["moments"] for number in numbers) // MOST)
    # By the digests of their contents: clusters are the same whatever the files are called.
    ordered = sorted(numbers, key=lambda number: keys[number])
    sample = np.concatenate(
        [read_channel_samples(folder, keys[number], step) for number in ordered]
    )
    units = Units.of(*_means_and_deviations(sample))
    points = units.features(*_means_and_deviations(sample))
    centres = centres_of(points, likely_number(points))
    words: dict[int, list[Floats]] = {number: [] for number in numbers}
    for place in places:
        words[place.recording].append(place.spans)
    blocks = [numbers[first : first + AT_ONCE] for first in range(0, len(numbers), AT_ONCE)]
    tasks = [
        _Search(folder, [keys[i] for i in block], [words[i] for i in block], units, centres)
        for block in blocks
    ]
    found = dict(results(executor, _distances, tasks, len(numbers) // PER_WORKER))
    distances = np.concatenate([found[task] for task in tasks])
    return _nearest_clusters(distances, np.array([place.seconds for place in places]))


def _distances(task: _Search) -> Floats:
    """Return how far the mean sample of each word is from each centre."""
    return np.concatenate(
        [_of_recording(task, *each) for each in zip(task.keys, task.words, strict=True)]
    )


def _of_recording(task: _Search, key: str, words: Sequence[Floats]) -> Floats:
    samples = read_channel_samples(task.folder, key)
    features = task.units.features(*_means_and_deviations(samples)).astype(np.float64)
    means = np.array([features[_inside(samples[:, 0], spans)].mean(axis=0) for spans in words])
    distances: Floats = np.sqrt(((means[:, None] - task.centres) ** 2).sum(axis=2))
    return distances


def _inside(seconds: Float32s, spans: Floats) -> NDArray[np.bool_]:
    """Return the samples in spans; of a short one that before it."""
    inside = np.zeros(len(seconds), np.bool_)
    firsts = np.minimum(np.searchsorted(seconds, spans[:, 0]), len(seconds) - 1)
    stops = np.maximum(np.searchsorted(seconds, spans[:, 1]), firsts + 1)
    for first, stop in zip(firsts, stops, strict=True):
        inside[first:stop] = True
    return inside


def _means_and_deviations(samples: Float32s) -> tuple[Float32s, Float32s]:
    """Means and deviations."""
    n = samples.shape[1] // 2
    return samples[:, 1 : 1 + n], samples[:, 1 + n :]


def _nearest_clusters(distances: Floats, seconds: Floats) -> Joined:
    """The nearest cluster of each word, those of most seconds first; others there are not."""
    clusters = np.unique(distances.argmin(axis=1))
    distances = distances[:, clusters]
    lasts = np.round(np.bincount(distances.argmin(axis=1), seconds), 6)
    order = np.argsort(-lasts, kind="stable")
    distances = distances[:, order]
    return beside_others(distances.argmin(axis=1), distances.min(axis=1), distances)
