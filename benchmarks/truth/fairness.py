"""Fair scores on recordings nobody tuned for, beside what is promised of `kineme`.

    python -m benchmarks fairness [--every 10] [--record]

- **subject 86**: five trials, beside uniform cuts and the recorded runs of ACA
  and HACA, which are told the number of classes (mean of their five seeds), and what
  the annotators' own borders score: cut at their means, and with the spans in which they
  differ as transitions.
- **HDM05**: exercises of three actors, joined in random order, 50 seeds.
- **synthetic**: 100 seeds per condition (see ``_recordings.synthetic``).
- **the same recording** larger, turned, in another unit, at another rate or in
  another format: borders within 0.1 s of one of the other result, both ways.

``one hand`` and ``all`` are what the promise for synthetic recordings is about.
"""

from __future__ import annotations

import json
import tempfile
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

import kineme
import kineme_reproduction.benchmark  # noqa: F401 (the scores of the papers)
from _figures import add_option, record
from _options import command_line, needed
from _recordings import CONDITIONS, Case, hdm05, subject_86, synthetic
from kineme.evaluation import Labelling, Truth, evaluate, evaluate_segmentation
from kineme.methods.presets import DEFAULT, PUBLISHED
from kineme.recordings import Motion
from kineme.recordings.operations import resample, scale, turn
from kineme.segments.segmentation import Segmentation
from kineme_reproduction.baselines.uniform import uniform

SHOWN = {
    "one_to_one": "one-to-one",
    "one_to_one_agreed": "agreed",
    "border_f1": "border F1",
    "covering": "covering",
    "border_ratio": "borders",
    "cluster_ratio": "clusters",
    "strict": "strict",
    "tolerant": "tolerant",
    "count_exact": "counts",
}
PROMISED = {
    "subject 86": {
        "one_to_one": 0.90, "one_to_one_agreed": 0.95, "border_f1": 0.90, "covering": 0.92,
        "border_ratio": 1.25, "cluster_ratio": 1.4, "strict": 0.90, "tolerant": 0.98,
    },
    "HDM05": {"one_to_one": 0.85, "count_exact": 0.90},
    "synthetic": {"border_f1": 0.95, "count_exact": 0.95},
}  # fmt: skip

COMPARED = (DEFAULT, *PUBLISHED)
INCH = 0.0254

Scores = dict[str, float]


def mean(rows: Iterable[Scores]) -> Scores:
    """The mean of each score; counts are weighed as runs of repetitions, others as recordings."""
    kept = list(rows)
    return {name: float(np.mean([row[name] for row in kept])) for name in kept[0] if name in SHOWN}


def by_presets(cases: Iterable[Case]) -> dict[str, Scores]:
    """Mean scores of every preset; recordings come one by one, so that few are held at once."""
    rows: dict[str, list[Scores]] = {preset: [] for preset in COMPARED}
    for case in cases:
        for preset in COMPARED:
            found = kineme.segment(case.motion, preset=preset)
            rows[preset].append(evaluate_segmentation(case.truth, found))
    return {preset: mean(scores) for preset, scores in rows.items()}


def uniform_scores(cases: Iterable[Case]) -> Scores:
    def score(truth: Truth) -> Scores:
        cuts = uniform(truth.frames, fps=truth.fps, seconds=0.5).cuts
        return evaluate(truth, Labelling.from_cuts(cuts, frames=truth.frames, fps=truth.fps))

    return mean(score(case.truth) for case in cases)


def annotators_scores(cases: Iterable[Case]) -> dict[str, Scores]:
    """What nobody's borders can be far above: those of the people who made the truth."""
    truths = [case.truth for case in cases]
    return {
        "means of annotators": mean(evaluate(truth, truth.at_means()) for truth in truths),
        "spans of annotators": mean(evaluate(truth, truth.labelling()) for truth in truths),
    }


def recorded_scores(cases: Iterable[Case], method: str) -> Scores:
    """ACA or HACA as their authors' program ran: five seeds per trial."""

    def score(truth: Truth, run: dict[str, list[int]]) -> Scores:
        cuts = np.array(run["cuts_30hz"]) - 1
        found = Labelling.from_cuts(cuts, run["clusters"], frames=truth.frames, fps=truth.fps)
        return evaluate(truth, found.merged())

    rows = []
    for case in cases:
        path = needed("cmu86/reference") / f"aca_haca_{case.name}.json"
        runs = json.loads(path.read_text())["runs"]
        rows += [score(case.truth, run[method]) for run in runs]
    return mean(rows)


def variants(motion: Motion, folder: Path) -> dict[str, Motion]:
    """The same recording in other guises."""

    def by_file(name: str, **reading: Any) -> Motion:
        kineme.write(motion, folder / name)
        return kineme.read(folder / name, **reading)

    # The writer's numbers are centimetres; scaled, they are inches.
    kineme.write(scale(motion, 0.01 / INCH), folder / "inches.bvh")
    return {
        "twice as large": scale(motion, 2.0),
        "half as large": scale(motion, 0.5),
        "turned by 2 rad": turn(motion, 2.0),
        "60 Hz": resample(motion, 60.0),
        "240 Hz": resample(motion, 240.0),
        "as BVH": by_file("take.bvh", unit="cm"),
        "as AMC": by_file("take.amc", fps=motion.fps, skeleton=folder / "take.asf"),
        "in inches": kineme.read(folder / "inches.bvh", unit="inch"),
    }


def same_borders(a: Segmentation, b: Segmentation, tolerance_s: float = 0.1) -> tuple[int, int]:
    """How many borders of the two lie near one of the other, and how many there are."""
    cuts = [found.cuts() / found.fps for found in (a, b)]
    near = np.abs(cuts[0][:, None] - cuts[1]) <= tolerance_s
    return int(near.any(axis=0).sum() + near.any(axis=1).sum()), sum(near.shape)


def invariance(cases: Iterable[Case]) -> dict[str, dict[str, float]]:
    """Share of same borders by preset and guise."""
    sums: dict[str, dict[str, list[tuple[int, int]]]] = {preset: {} for preset in COMPARED}
    for case in cases:
        with tempfile.TemporaryDirectory() as folder:
            others = variants(case.motion, Path(folder))
        for preset in COMPARED:
            here = kineme.segment(case.motion, preset=preset)
            for name, other in others.items():
                there = kineme.segment(other, preset=preset)
                sums[preset].setdefault(name, []).append(same_borders(here, there))
    return {
        preset: {name: np.divide(*np.sum(pairs, axis=0)) for name, pairs in guises.items()}
        for preset, guises in sums.items()
    }


def show(title: str, rows: dict[str, Scores], promised: Scores | None = None) -> None:
    columns = [name for name in SHOWN if any(name in scores for scores in rows.values())]
    print(f"\n{title:26}" + "".join(f"{SHOWN[name]:>11}" for name in columns))
    if promised:
        rows = rows | {"promised of kineme": promised}
    for label, scores in rows.items():
        cells = (f"{scores[name]:11.3f}" if name in scores else f"{'':11}" for name in columns)
        print(f"{label:26}" + "".join(cells))


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--every", type=int, default=1, help="one in so many seeds")
    add_option(parser)
    every = parser.parse_args().every
    cases = subject_86()
    scores = by_presets(cases)
    scores |= {method: recorded_scores(cases, method) for method in ("aca", "haca")}
    scores["uniform 0.5 s"] = uniform_scores(cases)
    scores |= annotators_scores(cases)
    show("subject 86", scores, PROMISED["subject 86"])
    for label, row in scores.items():
        for name, value in row.items():
            record(f"fairness.subject_86.{label.split()[0]}.{name}", value)
    scores = by_presets(hdm05(50 // every))
    show("HDM05", scores, PROMISED["HDM05"])
    record("fairness.hdm05.kineme.count_exact", scores["kineme"]["count_exact"])
    for condition in CONDITIONS:
        scores = by_presets(synthetic(condition, 100 // every))
        show(f"synthetic, {condition}", scores, PROMISED["synthetic"])
        name = f"fairness.synthetic.{condition.replace(' ', '_')}.kineme.count_exact"
        record(name, scores["kineme"]["count_exact"])
    found = invariance(cases)
    print(f"\n{'same borders':20}" + "".join(f"{preset:>13}" for preset in found))
    for guise in found["kineme"]:
        print(f"{guise:20}" + "".join(f"{shares[guise]:13.3f}" for shares in found.values()))
    whole = np.mean(list(found["kineme"].values()))
    print(f"kineme: {whole:.3f} of all, 0.950 promised")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
