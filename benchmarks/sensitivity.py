"""How much the scores hang on each constant of `kineme`, and on the trials they are judged by.

    python benchmarks/sensitivity.py [--every 5] [--record]

First every constant alone is made 15 % smaller and larger: mean scores of the
five trials of subject 86 and of HDM05 sequences. Then each trial is left out
in turn: every constant is chosen anew without it, and the trial is scored with
what was chosen. Judged by the mean of one-to-one accuracy, border F1 and
covering over the other four trials, the HDM05 sequences and synthetic
recordings, a third of the weight each, which is what the constants of `kineme`
were chosen on. Of a constant 15 % less, as it is and 15 % more are tried; what
counts is its score and those of the next smaller and larger values together,
so that the middle of a plateau is chosen and not a peak.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from _figures import add_option, record
from _options import command_line, few
from _recordings import Case, hdm05, subject_86, synthetic
from fairness import SHOWN, Scores, mean, show
from kineme.errors import ParameterError
from kineme.evaluation import evaluate_segmentation
from kineme.methods.recurrence.preset import KINEME, RecurrencePreset
from kineme.recordings.operations import resample
from kineme.segmentation.segmenter import segment

NUDGES = (0.85, 1.15)
STEPS = (0.72, 0.85, 1.0, 1.15, 1.32)
JUDGED = ("one_to_one", "border_f1", "covering")
# How it is looked at, and what signals and notes alone depend on; weights are learnt elsewhere.
KEPT = ("working_fps", "any_pace", "smoothing", "recurs_at", "exact_below")
CONSTANTS = [
    known.name
    for known in KINEME.constants()
    if known.name not in KEPT
    and not known.name.startswith("unsure_")
    and isinstance(known.value, int | float)
][: few(None, 2)]


def at_working_rate(cases: Iterable[Case]) -> list[Case]:
    """The same recordings with the frames that the preset looks at, to save time and memory."""
    return [replace(case, motion=resample(case.motion, KINEME.working_fps)) for case in cases]


def scores(cases: Sequence[Case], preset: RecurrencePreset) -> Scores:
    return mean(
        evaluate_segmentation(case.truth, segment(case.motion, preset=preset)) for case in cases
    )


def nudged(preset: RecurrencePreset) -> Iterator[tuple[str, RecurrencePreset]]:
    for name in CONSTANTS:
        for factor in NUDGES:
            other = stepped(preset, name, factor)
            if other is not None:
                yield f"{name} x {factor:g}", other


class Judge:
    """Scores of presets on some recordings, each computed once."""

    def __init__(self, *groups: Sequence[Case]):
        self._groups = groups
        self._known: dict[RecurrencePreset, list[NDArray[np.float64]]] = {}

    def goodness(self, preset: RecurrencePreset, out: Case) -> float:
        """Mean over the groups, each of equal weight, of what is judged; without one case."""
        if preset not in self._known:
            self._known[preset] = [np.array([judged(c, preset) for c in g]) for g in self._groups]
        return float(
            np.mean(
                [
                    found[[case is not out for case in group]].mean()
                    for group, found in zip(self._groups, self._known[preset], strict=True)
                ]
            )
        )

    def chosen(self, out: Case) -> RecurrencePreset:
        """The preset that all but one of the cases would have led to."""
        best = KINEME
        for name in CONSTANTS:
            tried = [stepped(best, name, step) for step in STEPS]
            each = [np.nan if p is None else self.goodness(p, out) for p in tried]
            around = [np.nanmean(each[i - 1 : i + 2]) for i in (1, 2, 3)]
            middle = 1 + int(np.argmax(around))
            found = tried[middle]
            if found is not None and around[middle - 1] > around[1] + 1e-9:
                best = found
        return best


def stepped(preset: RecurrencePreset, name: str, step: float) -> RecurrencePreset | None:
    """The preset with a constant at so many times its value in `kineme`; None if it cannot be."""
    try:
        return preset.replace(**{name: step * getattr(KINEME, name)})
    except ParameterError:
        return None


def judged(case: Case, preset: RecurrencePreset) -> float:
    found = scores([case], preset)
    return float(np.mean([found[name] for name in JUDGED]))


def left_out(trials: Sequence[Case], *others: Sequence[Case]) -> Scores:
    """The mean scores of the trials, each with constants chosen without it."""
    judge = Judge(trials, *others)
    found = []
    for out in trials:
        preset = judge.chosen(out)
        changes = [
            f"{name} {getattr(preset, name):g}"
            for name in CONSTANTS
            if getattr(preset, name) != getattr(KINEME, name)
        ]
        print(f"without {out.name}: {', '.join(changes) or 'nothing changes'}", flush=True)
        found.append(scores([out], preset))
    return mean(found)


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--every", type=int, default=1, help="one in so many other recordings")
    add_option(parser)
    every = parser.parse_args().every
    trials = at_working_rate(subject_86())
    exercises = at_working_rate(hdm05(15 // every))
    made = at_working_rate(synthetic("speed", 10 // every))
    for title, cases in (("subject 86", trials), ("HDM05", exercises)):
        rows = {"as it is": scores(cases, KINEME)}
        rows |= {label: scores(cases, preset) for label, preset in nudged(KINEME)}
        show(title, rows)
        worst = {name: min(row[name] for row in rows.values()) for name in JUDGED}
        print("least: " + ", ".join(f"{SHOWN[name]} {value:.3f}" for name, value in worst.items()))
        if cases is trials:
            found = [row["one_to_one"] for row in rows.values()]
            record("sensitivity.nudged.one_to_one.least", min(found))
            record("sensitivity.nudged.one_to_one.most", max(found))
    rows = {"as it is": scores(trials, KINEME)}
    rows["chosen without it"] = left_out(trials, exercises, made)
    show("left out", rows)
    for name in JUDGED:
        record(f"sensitivity.left_out.{name}", rows["chosen without it"][name])


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
