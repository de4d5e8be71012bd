"""Movements of different people found by example: the figures of the matching features.

    python benchmarks/likeness.py [exercises] [strides] [kinect]

``exercises``: each of the 188 exercises of HDM05 against those of other actors, by the larger of
the distances of each one's best match in the other; named as the nearest one within the
threshold; and named with its own class missing. ``strides``: strides of walking, of one person,
searched in all recordings of other people (see ``_corpora.py``); a stride is found if half of it
lies in matches, a match is right if half of it lies in walking. Dribbling, jogging and sneaking
count neither way, nor does what is nearer than 0.75 s to where one label follows another.
``kinect``: the labelled actions of UTKinect, against those of other people.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from _corpora import WALKS, Take, corpora
from canonical_basis import poses_of
from kineme.features.canonical.matching import MATCHING_FPS, OFFSETS_S, basis, directions
from kineme.matching import THRESHOLD, search, two_way_distance

Floats = NDArray[np.float64]
Features = NDArray[np.float32]

STRIDES = 3
"""Searched of each recording: the first one, one in the middle, the last one."""
WALKING, NOT_COUNTED = "walk", ("walk_lead_ball", "run", "carry")
STEPPING = ("jogLeftCircle4StepsRstart", "sneak2StepsLStart")
BLURRED_S = 0.75


@cache
def poses(name: str) -> list[Floats]:
    """Stacked poses of every take of a corpus."""
    return [poses_of(take) for take in corpora()[name]]


def features(name: str, mean: Floats, axes: Floats) -> list[Features]:
    return [directions(stacked, mean, axes) for stacked in poses(name)]


def exercises(mean: Floats, axes: Floats) -> dict[str, float]:
    """Ranked, and named from the other actors."""
    takes = corpora()["hdm05"]
    labels = np.array([take.spans[0][2] for take in takes])
    people = np.array([take.person for take in takes])
    return compared(features("hdm05", mean, axes), labels, people)


def kinect(mean: Floats, axes: Floats) -> dict[str, float]:
    segments, labels, people = [], [], []
    for take, whole in zip(corpora()["utkinect"], features("utkinect", mean, axes), strict=True):
        for start, stop, label in take.spans:
            first = round(start * MATCHING_FPS)
            segments.append(whole[first : max(round(stop * MATCHING_FPS), first + 3)])
            labels.append(label)
            people.append(take.person)
    return compared(segments, np.array(labels), np.array(people))


def compared(
    segments: Sequence[Features], labels: NDArray[np.str_], people: NDArray[np.str_]
) -> dict[str, float]:
    """Figures of every segment against those of other people."""
    n = len(segments)
    distances = np.full((n, n), np.inf)
    for a in range(n):
        for b in range(a):
            if people[a] != people[b]:
                distances[a, b] = distances[b, a] = two_way_distance(segments[a], segments[b])
    return ranked(distances, labels, people)


def ranked(
    distances: Floats, labels: NDArray[np.str_], people: NDArray[np.str_]
) -> dict[str, float]:
    """Mean average precision, and what is named right as the nearest one within the threshold."""
    precisions, nearest, right, found, wrong = [], [], [], [], []
    for query, row in enumerate(distances):
        others = people != people[query]
        same = labels[others] == labels[query]
        order = np.argsort(row[others], kind="stable")
        hits = np.flatnonzero(same[order])
        precisions.append(np.mean((np.arange(len(hits)) + 1) / (hits + 1)))
        nearest.append(same[order[0]])
        found.append(row[others][order[0]] <= THRESHOLD)
        right.append(found[-1] and nearest[-1])
        wrong.append(row[others][~same].min() <= THRESHOLD)
    return {
        "mean average precision": float(np.mean(precisions)),
        "nearest right": float(np.mean(nearest)),
        "precision": float(np.sum(right) / max(1, np.sum(found))),
        "recall": float(np.mean(right)),
        "named without its class": float(np.mean(wrong)),
    }


def strides(mean: Floats, axes: Floats) -> dict[str, float]:
    takes = [*corpora()["cmu86"], *corpora()["others"]]
    stacked = [*poses("cmu86"), *poses("others")]
    seen = [directions(each, mean, axes) for each in stacked]
    truth = [walking(take, len(each)) for take, each in zip(takes, seen, strict=True)]
    spans = [
        [(a, b) for a, b in steps(each) if (walks[a:b] == 1).all()]
        for each, walks in zip(stacked, truth, strict=True)
    ]
    others = [
        each
        for take, each in zip(corpora()["hdm05"], features("hdm05", mean, axes), strict=True)
        if take.spans[0][2] not in STEPPING
    ]
    right = wrong = hit = wanted = among_others = 0
    for take, example, own in zip(takes, seen, spans, strict=True):
        for at in sorted({round(k) for k in np.linspace(0, len(own) - 1, STRIDES)} if own else ()):
            stride = example[slice(*own[at])]
            for other, whole, walks, known in zip(takes, seen, truth, spans, strict=True):
                if other.person == take.person:
                    continue
                covered = np.zeros(len(whole), np.bool_)
                for start, stop, _ in zip(*search(stride, whole), strict=True):
                    covered[start:stop] = True
                    right += bool(np.mean(walks[start:stop] == 1) >= 0.5)
                    wrong += bool(np.mean(walks[start:stop] == 0) > 0.5)
                hit += sum(covered[a:b].mean() >= 0.5 for a, b in known)
                wanted += len(known)
            among_others += sum(len(search(stride, whole).starts) for whole in others)
    return {
        "precision": right / (right + wrong + among_others),
        "recall": hit / wanted,
        "matches in punches, kicks, jumps of others": among_others,
    }


def walking(take: Take, n: int) -> NDArray[np.int64]:
    """1 where somebody walks, 0 where not, -1 where neither counts."""
    found = np.full(n, 1 if take.name in WALKS else 0)
    if take.name == "cmu_131_01_bvh11.bvh":
        return np.full(n, -1)  # starts and stops between dance steps
    for start, stop, label in take.spans:
        code = 1 if label == WALKING else -1 if label in NOT_COUNTED else 0
        found[round(start * MATCHING_FPS) : round(stop * MATCHING_FPS)] = code
    for _, stop, _ in take.spans[:-1]:
        blurred = max(0, round((stop - BLURRED_S) * MATCHING_FPS))
        found[blurred : round((stop + BLURRED_S) * MATCHING_FPS)] = -1
    return found


def steps(stacked: Floats) -> list[tuple[int, int]]:
    """From where the left foot is farthest ahead to where it is again, 0.6 to 1.7 s later."""
    dims = stacked.shape[1] // len(OFFSETS_S)
    ahead = stacked[:, len(OFFSETS_S) // 2 * dims + 2]
    ahead = ahead - np.convolve(ahead, np.ones(15) / 15, "same")
    peaks = find_peaks(ahead, distance=8, prominence=0.1)[0].tolist()
    return [(a, b) for a, b in pairwise(peaks) if 9 <= b - a <= 25]


PROMISED = {
    "exercises": {
        "mean average precision": 0.97,
        "nearest right": 0.99,
        "precision": 0.99,
        "recall": 0.75,
        "named without its class": 0.05,
    },
    "strides": {
        "precision": 0.97,
        "recall": 0.85,
        "matches in punches, kicks, jumps of others": 0,
    },
    "kinect": {"mean average precision": 0.83, "nearest right": 0.94},
}
AT_MOST = ("named without its class", "matches in punches, kicks, jumps of others")


def show(name: str, mean: Floats, axes: Floats) -> None:
    """All figures in one line, for one basis."""
    parts = []
    for works in (exercises, strides, kinect):
        figures = works(mean, axes)
        parts.append(" ".join(f"{value:.3f}" for value in figures.values()))
    print(f"{name:20} {' | '.join(parts)}", flush=True)


def main() -> None:
    warnings.simplefilter("ignore")
    for name in sys.argv[1:] or PROMISED:
        figures = {"exercises": exercises, "strides": strides, "kinect": kinect}[name](*basis())
        print(f"\n{name}")
        for what, value in figures.items():
            promised = PROMISED[name].get(what)
            said = ""
            if promised is not None:
                kept = value <= promised if what in AT_MOST else value >= promised - 0.005
                most = "at most" if what in AT_MOST else "at least"
                said = f"{most} {promised:g} promised: {'kept' if kept else 'NOT KEPT'}"
            print(f"{what:45} {value:6.3f}  {said}", flush=True)


if __name__ == "__main__":
    main()
