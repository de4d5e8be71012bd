"""How much the scores hang on each constant of `kineme`, and on the trials they are judged by.

    python benchmarks/sensitivity.py [--quick]

First every constant alone is made 15 % smaller and larger: mean scores of the
five trials of subject 86 and of HDM05 sequences. Then each trial is left out
in turn: every constant is chosen anew without it, one after the other from 15 %
less, as it is and 15 % more, by the mean of one-to-one accuracy, border F1 and
covering; the trial left out is scored with what was chosen. Chosen once on the
other four trials alone, and once on these and the HDM05 sequences, half the
weight each, which is what the constants of `kineme` were chosen on.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields, replace

import numpy as np

from _recordings import Case, hdm05, subject_86
from fairness import SHOWN, Scores, mean, show
from kineme.errors import ParameterError
from kineme.evaluation import evaluate_segmentation
from kineme.operations import resample
from kineme.segmentation.presets import KINEME, ActionPreset
from kineme.segmentation.segmenter import segment

NUDGES = (0.85, 1.15)
JUDGED = ("one_to_one", "border_f1", "covering")
KEPT = ("name", "working_fps", "offsets", "max_lag", "any_pace")
CONSTANTS = [field.name for field in fields(ActionPreset) if field.name not in KEPT]


def at_working_rate(cases: Iterable[Case]) -> list[Case]:
    """The same recordings with the frames that the preset looks at, to save time and memory."""
    return [replace(case, motion=resample(case.motion, KINEME.working_fps)) for case in cases]


def scores(cases: Sequence[Case], preset: ActionPreset) -> Scores:
    return mean(
        evaluate_segmentation(case.truth, segment(case.motion, preset=preset)) for case in cases
    )


def nudged(preset: ActionPreset) -> Iterator[tuple[str, ActionPreset]]:
    for name in CONSTANTS:
        for factor in NUDGES:
            try:
                other = preset.replace(**{name: factor * getattr(preset, name)})
            except ParameterError:
                continue
            yield f"{name} x {factor:g}", other


def chosen(*groups: Sequence[Case]) -> ActionPreset:
    """The preset that these cases, each group of equal weight, would have led to."""

    def goodness(preset: ActionPreset) -> float:
        return float(np.mean([judged(cases, preset) for cases in groups]))

    best, reached = KINEME, goodness(KINEME)
    for name in CONSTANTS:
        for factor in NUDGES:
            other = best.replace(**{name: factor * getattr(KINEME, name)})
            score = goodness(other)
            if score > reached + 1e-9:
                best, reached = other, score
    return best


def judged(cases: Sequence[Case], preset: ActionPreset) -> float:
    found = scores(cases, preset)
    return float(np.mean([found[name] for name in JUDGED]))


def left_out(trials: Sequence[Case], *others: Sequence[Case]) -> Scores:
    """The mean scores of the trials, each with constants chosen without it."""
    found = []
    for out in trials:
        preset = chosen([case for case in trials if case is not out], *others)
        changes = [
            f"{name} {getattr(preset, name):g}"
            for name in CONSTANTS
            if getattr(preset, name) != getattr(KINEME, name)
        ]
        print(f"without {out.name}: {', '.join(changes) or 'nothing changes'}", flush=True)
        found.append(scores([out], preset))
    return mean(found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="three HDM05 sequences, not fifteen")
    trials = at_working_rate(subject_86())
    exercises = at_working_rate(hdm05(3 if parser.parse_args().quick else 15))
    for title, cases in (("subject 86", trials), ("HDM05", exercises)):
        rows = {"as it is": scores(cases, KINEME)}
        rows |= {label: scores(cases, preset) for label, preset in nudged(KINEME)}
        show(title, rows)
        worst = {name: min(row[name] for row in rows.values()) for name in JUDGED}
        print("least: " + ", ".join(f"{SHOWN[name]} {value:.3f}" for name, value in worst.items()))
    rows = {"as it is": scores(trials, KINEME)}
    rows["chosen on the others"] = left_out(trials)
    rows["and on HDM05"] = left_out(trials, exercises)
    show("left out", rows)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
