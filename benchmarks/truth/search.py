"""One repetition as example, searched in all recordings of other people, as a library does.

    python -m benchmarks search [--record]

At the default threshold, mirror images as well. Examples are exercises of HDM05, actions of
UTKinect, and of each take of UI-PRMD the repetition in its midst. A hit is right if its middle lies
in the same exercise; a repetition is found if half of it lies in hits. Both are means over examples
that have a hit, and over all.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import kineme
from _corpora import Take, corpora
from _figures import add_option, record
from _options import command_line, few
from _sources import PERSON, of_bodies
from kineme.features.canonical import MATCHING_FPS, matching_features, mirror_features
from kineme.library.searching import find_matches
from kineme.transfer.subsequences import THRESHOLD, Matches

Features = NDArray[np.float32]

LEAST = 6
"""Samples of an example."""


class Searched(NamedTuple):
    """Of one example: hits, those that are right, repetitions, those that are found."""

    hits: int
    right: int
    wanted: int
    found: int


def uiprmd() -> Iterator[Take]:
    for name, path, rows in of_bodies("uiprmd", "labels.csv")[:: few(1, 8)]:
        spans = [(float(row["start_s"]), float(row["stop_s"]), row["label"]) for row in rows]
        yield Take(name, PERSON.findall(name)[-1], kineme.read(path), tuple(spans))


def found_either_way(example: Features, features: Features) -> Matches:
    """Spans that are like an example or like its mirror image."""
    examples = [example, mirror_features(example)]
    return find_matches(features, examples, [], threshold=THRESHOLD, top=None)


def searched(example: Features, label: str, takes: Sequence[tuple[Take, Features]]) -> Searched:
    hits = right = wanted = found = 0
    for take, features in takes:
        covered = np.zeros(len(features), np.bool_)
        for start, stop, _ in zip(*found_either_way(example, features), strict=True):
            middle = (start + stop) / 2 / MATCHING_FPS
            hits += 1
            right += any(a <= middle < b and name == label for a, b, name in take.spans)
            covered[start:stop] = True
        for a, b, name in take.spans:
            if name == label:
                wanted += 1
                found += covered[round(a * MATCHING_FPS) : round(b * MATCHING_FPS)].mean() >= 0.5
    return Searched(hits, right, wanted, found)


def of_corpus(takes: Sequence[Take]) -> list[Searched]:
    """Each example, in the recordings of all other people."""
    features = [matching_features(take.motion) for take in takes]
    everyone = list(zip(takes, features, strict=True))
    found = []
    for take, own in everyone:
        same = [span for span in take.spans if span[2] == take.spans[0][2]]
        for a, b, label in [same[len(same) // 2]] if len(same) > 1 else take.spans:
            example = own[round(a * MATCHING_FPS) : round(b * MATCHING_FPS)]
            others = [one for one in everyone if one[0].person != take.person]
            if len(example) >= LEAST and others:
                found.append(searched(example, label, others))
    return found


def main() -> None:
    parser = command_line(__doc__)
    add_option(parser)
    parser.parse_args()
    for name, takes in (
        ("uiprmd", list(uiprmd())),
        ("hdm05", corpora()["hdm05"]),
        ("utkinect", corpora()["utkinect"]),
    ):
        found = of_corpus(takes)
        precision = float(np.mean([one.right / one.hits for one in found if one.hits] or [0]))
        recall = float(np.mean([one.found / one.wanted for one in found if one.wanted] or [0]))
        print(
            f"{name}: precision {precision:.3f}, recall {recall:.3f} of {len(found)} examples",
            flush=True,
        )
        record(f"search.{name}.precision", round(precision, 3))
        record(f"search.{name}.recall", round(recall, 3))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
