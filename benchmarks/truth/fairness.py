"""Score all presets on subject 86 and compare them with baselines.

    python -m benchmarks fairness [--record]

Baselines: uniform cuts; recorded runs of ACA and HACA, which were given the number of classes (mean
of five seeds); and the annotators' own borders, at their means or with the spans in which they
differ as transitions.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterable

import numpy as np

import kineme
import kineme_reproduction.benchmark  # noqa: F401 (the scores of the papers)
from _figures import add_option, record
from _options import find_data, make_parser
from _recordings import Case, read_subject_86
from kineme.evaluation import Labelling, Truth, evaluate
from kineme.methods.presets import DEFAULT, PUBLISHED
from kineme_reproduction.baselines.segments import cut_uniformly

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
    "one_to_one": 0.90, "one_to_one_agreed": 0.95, "border_f1": 0.90, "covering": 0.92,
    "border_ratio": 1.25, "cluster_ratio": 1.4, "strict": 0.90, "tolerant": 0.98,
}  # fmt: skip

COMPARED = (DEFAULT, *PUBLISHED)
Scores = dict[str, float]


def average(rows: Iterable[Scores]) -> Scores:
    """Average each score over recordings."""
    kept = list(rows)
    return {name: float(np.mean([row[name] for row in kept])) for name in kept[0] if name in SHOWN}


def score_presets(cases: Iterable[Case]) -> dict[str, Scores]:
    """Return the mean scores of every preset."""
    rows: dict[str, list[Scores]] = {preset: [] for preset in COMPARED}
    for case in cases:
        for preset in COMPARED:
            found = kineme.segment(case.motion, preset=preset)
            rows[preset].append(evaluate(case.truth, found))
    return {preset: average(scores) for preset, scores in rows.items()}


def score_uniform_cuts(cases: Iterable[Case]) -> Scores:
    def score(truth: Truth) -> Scores:
        cuts = cut_uniformly(truth.frames, fps=truth.fps, seconds=0.5).cuts
        return evaluate(truth, Labelling.from_cuts(cuts, frames=truth.frames, fps=truth.fps))

    return average(score(case.truth) for case in cases)


def score_annotators(cases: Iterable[Case]) -> dict[str, Scores]:
    """Score the annotators' own borders, an upper limit for all methods."""
    truths = [case.truth for case in cases]
    return {
        "means of annotators": average(evaluate(truth, truth.at_means()) for truth in truths),
        "spans of annotators": average(evaluate(truth, truth.labelling()) for truth in truths),
    }


def score_recorded_runs(cases: Iterable[Case], method: str) -> Scores:
    """Score recorded runs of the authors' program for ACA or HACA, five seeds per trial."""

    def score(truth: Truth, run: dict[str, list[int]]) -> Scores:
        cuts = np.array(run["cuts_30hz"]) - 1
        found = Labelling.from_cuts(cuts, run["clusters"], frames=truth.frames, fps=truth.fps)
        return evaluate(truth, found.merged())

    rows = []
    for case in cases:
        path = find_data("cmu86/reference") / f"aca_haca_{case.name}.json"
        runs = json.loads(path.read_text())["runs"]
        rows += [score(case.truth, run[method]) for run in runs]
    return average(rows)


def show(rows: dict[str, Scores]) -> None:
    """Print a row for each method and one for the promised scores."""
    columns = [name for name in SHOWN if any(name in scores for scores in rows.values())]
    print(f"{'subject 86':26}" + "".join(f"{SHOWN[name]:>11}" for name in columns))
    for label, scores in (rows | {"promised of kineme": PROMISED}).items():
        cells = (f"{scores[name]:11.3f}" if name in scores else f"{'':11}" for name in columns)
        print(f"{label:26}" + "".join(cells))


def main() -> None:
    parser = make_parser(__doc__)
    add_option(parser)
    parser.parse_args()
    cases = read_subject_86()
    scores = score_presets(cases)
    scores |= {method: score_recorded_runs(cases, method) for method in ("aca", "haca")}
    scores["uniform 0.5 s"] = score_uniform_cuts(cases)
    scores |= score_annotators(cases)
    show(scores)
    for label, row in scores.items():
        for name, value in row.items():
            record(f"fairness.subject_86.{label.split()[0]}.{name}", value)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
