"""Movements of different people found by example: the figures of the matching features.

    python -m benchmarks likeness [exercises] [strides] [segments] [time] [--record]

``exercises``: each of the 188 exercises of HDM05 against those of other actors, by the larger of
the distances of each one's best match in the other; named as the nearest one within the
threshold; and named with its own class missing. ``strides``: strides of walking, of one person,
searched in all recordings of other people (see ``_corpora.py``); a stride is found if half of it
lies in matches, a match is right if half of it lies in walking. Dribbling, jogging and sneaking
count neither way, nor does what is nearer than 0.75 s to where one label follows another.
``segments``: exercises of HDM05 and labelled actions of UTKinect against those of other people,
by their embeddings, and by the sum of this distance and that of the nearer warping, of the one in
the other or the other way. ``time``: a stride of 1.3 s searched in an hour.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks
from scipy.spatial.distance import cdist

import kineme
from _corpora import WALKS, Take, corpora, poses_of
from _figures import add_option, record
from _measure import interleaved
from _options import command_line
from kineme.features.canonical import MATCHING_FPS, matching_features, matching_poses
from kineme.features.canonical.matching import OFFSETS_S, basis, directions
from kineme.matching import search
from kineme.matching.embeddings import axes_of_embeddings, embedded
from kineme.matching.subsequences import warped
from kineme.transfer import THRESHOLD

Floats = NDArray[np.float64]
Features = NDArray[np.float32]
Texts = NDArray[np.str_]
Basis = tuple[Floats, Floats]
Figures = dict[str, float]

STRIDES = 3
"""Searched of each recording: the first one, one in the middle, the last one."""
WALKING, NOT_COUNTED = "walk", ("walk_lead_ball", "run")
STEPPING = ("jogLeftCircle4StepsRstart", "sneak2StepsLStart")
BLURRED_S = 0.75
NO_MATCH = 2.0
"""Distance of opposite features: counts where nothing matches."""


@cache
def stacked(name: str) -> list[Floats]:
    """Stacked poses of every take of a corpus."""
    return [poses_of(take) for take in corpora()[name]]


@cache
def poses(name: str) -> list[Floats]:
    return [matching_poses(take.motion) for take in corpora()[name]]


def features(name: str, of: Basis) -> list[Features]:
    return [directions(each, *of) for each in stacked(name)]


def exercises(of: Basis) -> Figures:
    """Ranked, and named from the other actors."""
    labels, people = actions("hdm05")
    one_way = warped_distances(sliced("hdm05", features("hdm05", of)), people)
    return ranked(np.maximum(one_way, one_way.T), labels, people)


def segments(of: Basis) -> Figures:
    """Figures of embeddings, alone and joined with warping, by corpus."""
    figures: Figures = {}
    for name in ("hdm05", "utkinect"):
        labels, people = actions(name)
        whole = np.array([embedded(each, *of) for each in sliced(name, poses(name))])
        apart = cdist(whole, whole)
        one_way = warped_distances(sliced(name, features(name, basis())), people)
        joined = apart + np.minimum(one_way, one_way.T)
        for how, distances in (("alone", apart), ("joined", joined)):
            ranks = ranked(distances, labels, people)
            for what in ("mean average precision", "nearest right"):
                figures[f"{name}, {how}, {what}"] = ranks[what]
    return figures


def actions(name: str) -> tuple[Texts, Texts]:
    """Labels of all labelled spans of a corpus, and who makes them."""
    pairs = [(label, take.person) for take in corpora()[name] for *_, label in take.spans]
    labels, people = zip(*pairs, strict=True)
    return np.array(labels), np.array(people)


def sliced(name: str, takes: Sequence[NDArray[np.floating]]) -> list[NDArray[np.floating]]:
    """What lies in the labelled spans of features of all takes."""
    parts = []
    for take, whole in zip(corpora()[name], takes, strict=True):
        for start, stop, _ in take.spans:
            first = round(start * MATCHING_FPS)
            parts.append(whole[first : max(round(stop * MATCHING_FPS), first + 3)])
    return parts


def warped_distances(parts: Sequence[NDArray[np.floating]], people: Texts) -> Floats:
    """Of each one's best match in each that another makes; `NO_MATCH` within one person."""
    n = len(parts)
    distances = np.full((n, n), NO_MATCH)
    for a, b in np.argwhere(people[:, None] != people).tolist():
        distances[a, b] = min(warped(parts[a], parts[b])[0].min(), NO_MATCH)
    return distances


def ranked(distances: Floats, labels: Texts, people: Texts) -> Figures:
    """Mean average precision, and what is named right as the nearest one within the threshold."""
    precisions, nearest, found, wrong = [], [], [], []
    for query, row in enumerate(distances):
        others = people != people[query]
        same = labels[others] == labels[query]
        order = np.argsort(row[others], kind="stable")
        hits = np.flatnonzero(same[order])
        precisions.append(np.mean((np.arange(len(hits)) + 1) / (hits + 1)))
        nearest.append(same[order[0]])
        found.append(row[others][order[0]] <= THRESHOLD)
        wrong.append(row[others][~same].min() <= THRESHOLD)
    right = np.logical_and(found, nearest)
    return {
        "mean average precision": float(np.mean(precisions)),
        "nearest right": float(np.mean(nearest)),
        "precision": float(np.sum(right) / max(1, np.sum(found))),
        "recall": float(np.mean(right)),
        "named without its class": float(np.mean(wrong)),
    }


def strides(of: Basis) -> Figures:
    """Walking of others found by one stride."""
    takes = [*corpora()["cmu86"], *corpora()["others"]]
    poses_of_all = [*stacked("cmu86"), *stacked("others")]
    seen = [directions(each, *of) for each in poses_of_all]
    truth = [walking(take, len(each)) for take, each in zip(takes, seen, strict=True)]
    spans = [
        [(a, b) for a, b in steps(each) if (walks[a:b] == 1).all()]
        for each, walks in zip(poses_of_all, truth, strict=True)
    ]
    exercises_of = zip(corpora()["hdm05"], features("hdm05", of), strict=True)
    elsewhere = [each for take, each in exercises_of if take.spans[0][2] not in STEPPING]
    right = wrong = hit = wanted = among = 0
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
                hit += sum(bool(covered[a:b].mean() >= 0.5) for a, b in known)
                wanted += len(known)
            among += sum(len(search(stride, whole).starts) for whole in elsewhere)
    return {
        "precision": right / (right + wrong + among),
        "recall": hit / wanted,
        "matches in exercises of HDM05": among,
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


def steps(poses_of_one: Floats) -> list[tuple[int, int]]:
    """From where the left foot is farthest ahead to where it is again, 0.6 to 1.7 s later."""
    dims = poses_of_one.shape[1] // len(OFFSETS_S)
    ahead = poses_of_one[:, len(OFFSETS_S) // 2 * dims + 2]
    ahead = ahead - np.convolve(ahead, np.ones(15) / 15, "same")
    peaks = find_peaks(ahead, distance=8, prominence=0.1)[0].tolist()
    return [(a, b) for a, b in pairwise(peaks) if 9 <= b - a <= 25]


def time(_: Basis) -> Figures:
    """Seconds."""
    motion = kineme.read(kineme.bundled_recording())
    own = matching_features(motion)
    hour = np.resize(own, (round(3600 * MATCHING_FPS), own.shape[1]))
    works: dict[str, Callable[[], object]] = {
        "search of 1.3 s in an hour": lambda: search(own[100:120], hour),
        "features of an hour": lambda: matching_features(motion),
    }
    took = interleaved(works, runs=7)
    took["features of an hour"] *= 3600 / motion.duration
    return took


PROMISED = {
    "exercises": {
        "mean average precision": 0.97,
        "nearest right": 0.99,
        "precision": 0.99,
        "recall": 0.75,
        "named without its class": -0.05,
    },
    "strides": {"precision": 0.97, "recall": 0.85, "matches in exercises of HDM05": -0.0},
    "segments": {
        "hdm05, joined, mean average precision": 0.98,
        "utkinect, alone, mean average precision": 0.83,
        "utkinect, joined, mean average precision": 0.83,
        "utkinect, joined, nearest right": 0.94,
    },
    "time": {"search of 1.3 s in an hour": -0.02},
}
"""At least; negative: at most."""
WORKS: dict[str, Callable[[Basis], Figures]] = {
    "exercises": exercises,
    "strides": strides,
    "segments": segments,
    "time": time,
}


def show(title: str, names: Sequence[str], of: Basis) -> None:
    """All figures in one line, for one basis."""
    figures = [" ".join(f"{value:.3f}" for value in WORKS[name](of).values()) for name in names]
    print(f"{title:20} {' | '.join(figures)}", flush=True)


def verdict(value: float, promised: float | None) -> str:
    if promised is None:
        return ""
    at_most = np.signbit(promised)
    kept = value <= -promised if at_most else value >= promised - 0.005
    word = "most" if at_most else "least"
    return f"at {word} {abs(promised):g} promised: {'kept' if kept else 'NOT KEPT'}"


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("works", nargs="*", default=list(WORKS), help=", ".join(WORKS))
    add_option(parser)
    for name in parser.parse_args().works:
        print(f"\n{name}")
        of = axes_of_embeddings() if name == "segments" else basis()
        for what, value in WORKS[name](of).items():
            record(f"likeness.{name}.{what.replace(',', '').replace(' ', '_')}", round(value, 3))
            print(f"{what:45} {value:6.3f}  {verdict(value, PROMISED[name].get(what))}", flush=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
