"""Search one repetition in all recordings of other people, as a library does.

    python -m benchmarks search [--record]

The threshold is the default; mirror images count. Examples are exercises of HDM05, actions of
UTKinect, and the middle repetition of each take of UI-PRMD. Precision: a hit is right if its middle
lies in the same exercise (mean over examples with hits). Recall: a repetition is found if hits
cover half of it (mean over all examples).
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import kineme
from _figures import add_option, record
from _options import choose_size, find_data, make_parser
from _recordings import ACTORS, read_hdm05, read_rows
from _sources import PERSON, list_body_recordings
from kineme.features.canonical import MATCHING_FPS, matching_features, mirror_features
from kineme.library.finding import find_matches
from kineme.recordings import Motion
from kineme.transfer.matching import THRESHOLD, Matches

Features = NDArray[np.float32]

LEAST = 6
"""Minimum samples of an example."""


class SearchCounts(NamedTuple):
    """Hits, right hits, repetitions and found repetitions of one example."""

    hits: int
    right: int
    wanted: int
    found: int


@dataclass(frozen=True)
class Take:
    """A recording with its person and labelled spans in seconds."""

    name: str
    person: str
    motion: Motion
    spans: tuple[tuple[float, float, str], ...] = ()


def read_hdm05_takes() -> Iterator[Take]:
    for actor in ACTORS:
        for name, label, motion in read_hdm05(actor, every=choose_size(1, 6)):
            yield Take(name, actor, motion, ((0.0, motion.duration, label),))


def read_utkinect() -> Iterator[Take]:
    folder = find_data("sets/utkinect")
    rows = read_rows(folder / "labels.csv")
    for name in sorted(rows)[:: choose_size(1, 5)]:
        motion = kineme.read(folder / "recordings" / f"{name}.parquet")
        spans = ((float(row["start_s"]), float(row["stop_s"]), row["label"]) for row in rows[name])
        yield Take(name, name.split("_")[0], motion, tuple(spans))


def read_uiprmd() -> Iterator[Take]:
    for name, path, rows in list_body_recordings("uiprmd", "labels.csv")[:: choose_size(1, 8)]:
        spans = [(float(row["start_s"]), float(row["stop_s"]), row["label"]) for row in rows]
        yield Take(name, PERSON.findall(name)[-1], kineme.read(path), tuple(spans))


def search_both_sides(example: Features, features: Features) -> Matches:
    """Find spans that match an example or its mirror image."""
    examples = [example, mirror_features(example)]
    return find_matches(features, examples, [], threshold=THRESHOLD, top=None)


def search_takes(
    example: Features, label: str, takes: Sequence[tuple[Take, Features]]
) -> SearchCounts:
    hits = right = wanted = found = 0
    for take, features in takes:
        covered = np.zeros(len(features), np.bool_)
        for start, stop, _ in zip(*search_both_sides(example, features), strict=True):
            middle = (start + stop) / 2 / MATCHING_FPS
            hits += 1
            right += any(a <= middle < b and name == label for a, b, name in take.spans)
            covered[start:stop] = True
        for a, b, name in take.spans:
            if name == label:
                wanted += 1
                found += covered[round(a * MATCHING_FPS) : round(b * MATCHING_FPS)].mean() >= 0.5
    return SearchCounts(hits, right, wanted, found)


def search_corpus(takes: Sequence[Take]) -> list[SearchCounts]:
    """Search each example in the recordings of all other people."""
    features = [matching_features(take.motion) for take in takes]
    everyone = list(zip(takes, features, strict=True))
    found = []
    for take, own in everyone:
        same = [span for span in take.spans if span[2] == take.spans[0][2]]
        for a, b, label in [same[len(same) // 2]] if len(same) > 1 else take.spans:
            example = own[round(a * MATCHING_FPS) : round(b * MATCHING_FPS)]
            others = [one for one in everyone if one[0].person != take.person]
            if len(example) >= LEAST and others:
                found.append(search_takes(example, label, others))
    return found


def main() -> None:
    parser = make_parser(__doc__)
    add_option(parser)
    parser.parse_args()
    for name, takes in (
        ("uiprmd", list(read_uiprmd())),
        ("hdm05", list(read_hdm05_takes())),
        ("utkinect", list(read_utkinect())),
    ):
        found = search_corpus(takes)
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
