"""Methods × trials: every score of every method on every recording, and the means.

ACA's and HACA's published cuts, which exist for all fourteen trials, need no
recording: `score_published_cuts` measures them with the same functions and
puts the published accuracies beside.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypedDict

import numpy as np

from kineme._json import loaded
from kineme.errors import ReadError
from kineme.evaluation.annotated_scores import evaluate_segmentation
from kineme.evaluation.annotation import Annotation
from kineme.evaluation.frames import one_to_one_accuracy
from kineme.evaluation.labelling import Labelling
from kineme.evaluation.paper import strict_and_tolerant
from kineme.reproduction.methods import Method
from kineme.reproduction.published import published
from kineme.reproduction.trials import Trial, read_truths
from kineme.segments.segmentation import Segmentation

Scores = dict[str, float]


@dataclass(frozen=True, eq=False)
class Result:
    """What one method found in one trial, and its scores, ``seconds`` among them."""

    trial: Trial
    method: str
    found: Segmentation
    scores: Scores


def run(
    trials: Sequence[Trial],
    methods: Mapping[str, Method],
    *,
    progress: Callable[[str], None] | None = None,
) -> list[Result]:
    """A result for every trial and method, trial by trial.

    Parameters
    ----------
    methods : mapping of str to callable
        By name, in the order of the tables.
    progress : callable, optional
        Called with trial and method before each run.
    """
    results = []
    for trial in trials:
        for name, method in methods.items():
            if progress is not None:
                progress(f"{trial.name} {name}")
            start = time.perf_counter()
            found = method(trial)
            seconds = time.perf_counter() - start
            scores = {**scores_of(trial, found), "seconds": seconds}
            results.append(Result(trial, name, found, scores))
    return results


def scores_of(trial: Trial, found: Segmentation) -> Scores:
    """Every score of a segmentation of this trial; see `kineme.evaluation.evaluate`."""
    return evaluate_segmentation(
        trial.truth, found, positions=trial.positions, features=trial.features
    )


def mean_scores(results: Sequence[Result]) -> dict[str, Scores]:
    """Per method the mean of each score over its trials; scores that are nan are left out."""
    return {
        method: mean([r.scores for r in results if r.method == method])
        for method in dict.fromkeys(r.method for r in results)
    }


def mean(rows: Sequence[Scores]) -> Scores:
    """The mean of each score over the rows in which it is a number; nan if in none."""
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {n: [row[n] for row in rows if np.isfinite(row.get(n, np.nan))] for n in names}
    return {n: float(np.mean(values)) if values else float("nan") for n, values in columns.items()}


def as_records(results: Sequence[Result]) -> list[dict[str, Any]]:
    """One record per trial and method, then one per method with the means (trial ``mean``)."""
    records: list[dict[str, Any]] = [
        {"trial": r.trial.name, "method": r.method, **r.scores} for r in results
    ]
    means = mean_scores(results)
    return records + [{"trial": "mean", "method": m, **scores} for m, scores in means.items()]


@dataclass(frozen=True)
class PublishedCuts:
    """Published cuts of a trial, scored, beside the accuracies published for them.

    ``scores`` has ``strict`` and ``tolerant``, and where the published number
    of clusters fits the cuts ``one_to_one`` and ``one_to_one_agreed``;
    ``printed`` has ``strict`` and ``tolerant``.
    """

    method: str
    trial: str
    scores: Scores
    printed: Scores


class _Stored(TypedDict):
    """What is read of ``published.json``: by trial."""

    aca_cuts_30hz: dict[str, list[int]]
    haca_cuts_30hz: dict[str, list[int]]
    aca_cluster_ids: dict[str, list[int]]
    haca_cluster_ids: dict[str, list[int]]


def score_published_cuts(folder: Path) -> list[PublishedCuts]:
    """ACA's and HACA's published cuts of all trials under the authors' functions.

    Parameters
    ----------
    folder : Path
        Holds ``published.json`` with the cuts (``aca_cuts_30hz``, …), and the annotations.

    Raises
    ------
    ReadError
        There is no such file, or it is damaged.
    """
    path = folder / "published.json"
    truths = read_truths(folder)
    if not path.exists():
        raise ReadError(path, "no published cuts here: there is no such file")
    stored = loaded(path, _Stored)
    try:
        return [
            _published_cuts(method, trial, truth, stored)
            for method in ("aca", "haca")
            for trial, truth in truths.items()
        ]
    except (ValueError, KeyError) as error:  # no such trial, or cuts that do not rise
        raise ReadError(path, f"no published cuts here: {error}") from error


def _published_cuts(
    method: Literal["aca", "haca"], trial: str, truth: Annotation, stored: _Stored
) -> PublishedCuts:
    aca = method == "aca"
    marks = stored["aca_cuts_30hz" if aca else "haca_cuts_30hz"][trial]
    cuts = np.array(marks, np.int64) - 1  # counted from 1
    clusters = stored["aca_cluster_ids" if aca else "haca_cluster_ids"][trial]
    fits = len(clusters) == cuts.size + 1  # HACA's of three trials do not
    found = Labelling.from_cuts(
        cuts, clusters if fits else None, frames=truth.frames, fps=truth.fps
    )
    strict, tolerant = strict_and_tolerant(truth, found)
    scores = {"strict": strict, "tolerant": tolerant}
    if fits:
        scores["one_to_one"], scores["one_to_one_agreed"] = one_to_one_accuracy(truth, found)
    tables = published()
    printed = {kind: tables[f"accuracy_{kind}"][method][trial] for kind in ("strict", "tolerant")}
    return PublishedCuts(method, trial, scores, printed)
