"""Trials of one repetition: what is said of them alone, and beside a recording of somebody else.

    python -m benchmarks single_cycles [--record]

A trial is one repetition in the midst of a take, cut as people cut it. Alone it should be one
activity that is done once. Beside a recording of another person, which is segmented and named, its
exercise should be found in it (`kineme.transfer_labels`), and by search with one of the repetitions
of that recording (as a library searches), at the default thresholds.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import kineme
from _corpora import Take, corpora
from _figures import add_option, record
from _options import command_line
from _recordings import REPETITIONS
from kineme.features.canonical import MATCHING_FPS, matching_features
from kineme.recordings import Motion
from kineme.segments.editing.naming import name_cluster
from kineme.segments.segmentation import Segmentation
from kineme.transfer import KnowledgeBase, transfer_features
from search import found_either_way, uiprmd

Floats = NDArray[np.floating]
Spans = list[tuple[float, float]]


class Trial(NamedTuple):
    """One repetition, of whom it is, and its exercise."""

    person: str
    motion: Motion
    label: str


def hdm05() -> Iterator[tuple[Take, Spans]]:
    """Takes of a known number of repetitions, which are taken to be equally long."""
    for take in corpora()["hdm05"]:
        start, stop, label = take.spans[0]
        edges = np.linspace(start, stop, REPETITIONS.get(label, 1) + 1).tolist()
        yield take, list(pairwise(edges))


def cut_by_people() -> Iterator[tuple[Take, Spans]]:
    for take in uiprmd():
        yield take, [(start, stop) for start, stop, _ in take.spans]


def one_repetition(take: Take, spans: Spans) -> Trial:
    start, stop = spans[len(spans) // 2]
    frames = slice(round(start * take.motion.fps), round(stop * take.motion.fps))
    return Trial(take.person, take.motion[frames], take.spans[0][2])


def named(take: Take) -> Segmentation:
    """The recording as it is segmented, what lasts longest in it called by its exercise."""
    found = kineme.segment(take.motion)
    rows = found.activities
    lasting = np.bincount(rows.cluster + 1, rows.stop_frame - rows.start_frame, minlength=2)
    return name_cluster(found, int(lasting[1:].argmax()), take.spans[0][2])


def middle_repetition(take: Take, found: Segmentation) -> Floats:
    """Of those with its name the one in the midst, as it is searched for."""
    rows = found.primitives[found.primitives.label != ""]
    row = rows[len(rows) // 2]
    features = matching_features(take.motion)
    return features[round(row.start_s * MATCHING_FPS) : round(row.stop_s * MATCHING_FPS)]


def said_alone(trial: Trial) -> bool:
    """Whether it is one activity that is done once."""
    found = kineme.segment(trial.motion)
    return len(found.activities) == 1 and found.primitives.kind.tolist() == ["primitive"]


def called_right(trial: Trial, knowledge: KnowledgeBase) -> bool:
    """Whether most of its frames are called by its exercise."""
    found = kineme.segment(trial.motion)
    named = kineme.transfer_labels(found, transfer_features(trial.motion), knowledge)
    rows = named.activities
    right = (rows.stop_frame - rows.start_frame)[rows.label == trial.label].sum()
    return bool(2 * right > trial.motion.n_frames)


def found_in(trial: Trial, example: Floats) -> bool:
    """Whether matches of the example cover half of it."""
    features = matching_features(trial.motion)
    covered = np.zeros(len(features), np.bool_)
    for start, stop, _ in zip(*found_either_way(example, features), strict=True):
        covered[start:stop] = True
    return bool(covered.mean() >= 0.5)


def measured(takes: Iterator[tuple[Take, Spans]]) -> dict[str, float]:
    """Shares of all trials that are said, called and found right."""
    known = [(take, one_repetition(take, spans), named(take)) for take, spans in takes]
    people = sorted({take.person for take, *_ in known})
    alone, called, found = [], [], []
    for who, other in zip(people, people[1:] + people[:1], strict=True):
        theirs = [
            (take, table)
            for take, _, table in known
            if take.person == other and (table.primitives.label != "").any()
        ]
        if not theirs:
            continue
        knowledge = KnowledgeBase.merged(
            *[KnowledgeBase.from_recording(take.motion, table) for take, table in theirs]
        )
        for trial in (trial for take, trial, _ in known if take.person == who):
            alone.append(said_alone(trial))
            same = [one for one in theirs if one[0].spans[0][2] == trial.label]
            if same:
                called.append(called_right(trial, knowledge))
                found.append(found_in(trial, middle_repetition(*same[0])))
    shares = {"one_occurrence": alone, "called": called, "found": found}
    return {name: float(np.mean(of or [np.nan])) for name, of in shares.items()}


def main() -> None:
    parser = command_line(__doc__)
    add_option(parser)
    parser.parse_args()
    for name, takes in (("uiprmd", cut_by_people()), ("hdm05", hdm05())):
        for figure, share in measured(takes).items():
            print(f"{name}: {figure} {share:.3f}", flush=True)
            record(f"single_cycles.{name}.{figure}", round(share, 3))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
