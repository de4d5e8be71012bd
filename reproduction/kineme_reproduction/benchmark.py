"""Methods × trials: every score of every method on every recording, and the means.

Methods are presets under one form: a trial in, a segmentation out. Most see the motion alone.
ACA, HACA and GMM are told the true number of classes, as in all published comparisons, and ACA and
HACA the lengths of segments that their authors chose per trial (Zhou et al., their program).

Published accuracies ship as ``published.json``, trial by trial, each with its source: facts to
compare with. How they were computed is told in `kineme_reproduction.protocols`, as far as it is
known: ACA's and HACA's do not follow from their published cuts. These exist for all fourteen
trials and need no recording: `score_published_cuts` measures them with the same functions and
puts the published accuracies beside.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, TypedDict

import numpy as np

from kineme._util.json import load_json
from kineme.errors import ReadError
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.folder import check_method, segment_with_method
from kineme.evaluation.measures import one_to_one_accuracy
from kineme.evaluation.score import evaluate, register
from kineme.evaluation.truth import TRANSITION, Labelling, Truth
from kineme.methods.presets import PRESETS
from kineme.segments.segmentation import Segmentation
from kineme_reproduction import protocols, variance
from kineme_reproduction.protocols import strict_and_tolerant
from kineme_reproduction.trials import Trial, read_truths

# From here on every evaluation tells the scores of the papers, too.
for each in (*variance.SCORES, *protocols.SCORES):
    register(each, replace=True)

Scores = dict[str, float]
Method = Callable[[Trial], Segmentation]

OF_TRIALS: Mapping[tuple[str, str], Mapping[str, Any]] = {
    ("aca", "86_11"): {"shortest": 21, "longest": 36, "centres": 15},
    ("haca", "86_11"): {"fine_lengths": (7, 9), "coarse_lengths": (3, 4), "centres": 15},
}
"""Constants by method and trial: trial 11 is fast, so its segments are shorter."""


def method(name: str) -> Method:
    """Return the method of this name.

    Parameters
    ----------
    name : str
        Of a preset.

    Returns
    -------
    callable
        From a `Trial` to a `Segmentation`.

    Raises
    ------
    ParameterError
        There is none; the message lists those there are.

    Examples
    --------
    >>> callable(method("haca"))
    True
    """
    check_method(name)
    return partial(_segment_trial, name)


def _segment_trial(name: str, trial: Trial) -> Segmentation:
    n_classes = len(set(trial.truth.labels) - {TRANSITION})
    constants = OF_TRIALS.get((name, trial.name), {})
    return segment_with_method(name, trial.motion, n_classes=n_classes, **constants)


METHODS: Mapping[str, Method] = MappingProxyType({name: method(name) for name in PRESETS})


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
    """Return a result for every trial and method, ordered by trial.

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
    """Return all scores of a segmentation of this trial; see `kineme.evaluation.evaluate`."""
    return evaluate(trial.truth, found, positions=trial.positions, features=trial.features)


def mean_scores(results: Sequence[Result]) -> dict[str, Scores]:
    """Return the mean of each score over trials, by method; nan is left out."""
    return {
        method: mean([r.scores for r in results if r.method == method])
        for method in dict.fromkeys(r.method for r in results)
    }


def mean(rows: Sequence[Scores]) -> Scores:
    """Return the mean of each score over rows; nan is left out."""
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {n: [row[n] for row in rows if np.isfinite(row.get(n, np.nan))] for n in names}
    return {n: float(np.mean(values)) if values else float("nan") for n, values in columns.items()}


def as_records(results: Sequence[Result]) -> list[dict[str, Any]]:
    """Return one record per trial and method, then the means of each method (trial ``mean``)."""
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
    """Score ACA's and HACA's published cuts of all trials with the authors' functions.

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
    stored = load_json(path, _Stored)
    try:
        return [
            _published_cuts(method, trial, truth, stored)
            for method in ("aca", "haca")
            for trial, truth in truths.items()
        ]
    except (ValueError, KeyError) as error:  # no such trial, or cuts that do not rise
        raise ReadError(path, f"no published cuts here: {error}") from error


@cache
def published() -> dict[str, Any]:
    """Tables by name, each ``{method: {trial: value}}``; ``sources`` says where each is from.

    ``accuracy_strict``, ``accuracy_tolerant``, ``rerun_accuracy`` and
    ``rerun_accuracy_certain`` are per trial; ``means`` and
    ``cluster_variance_means`` are as printed.
    """
    text = files(__package__).joinpath("published.json").read_text(encoding="utf-8")
    tables: dict[str, Any] = json.loads(text)
    return tables


def _published_cuts(
    method: Literal["aca", "haca"], trial: str, truth: Truth, stored: _Stored
) -> PublishedCuts:
    aca = method == "aca"
    stored_cuts = stored["aca_cuts_30hz" if aca else "haca_cuts_30hz"][trial]
    cuts = np.array(stored_cuts, np.int64) - 1  # counted from 1
    clusters = stored["aca_cluster_ids" if aca else "haca_cluster_ids"][trial]
    fits = len(clusters) == cuts.size + 1  # HACA's of three trials do not
    found = Labelling.from_cuts(
        cuts, clusters if fits else None, frames=truth.frames, fps=truth.fps
    )
    compared = Comparison.of(truth, found)
    strict, tolerant = strict_and_tolerant(compared)
    scores = {"strict": strict, "tolerant": tolerant}
    if fits:
        scores["one_to_one"] = one_to_one_accuracy(compared)
        scores["one_to_one_agreed"] = one_to_one_accuracy(compared.agreed)
    tables = published()
    printed = {kind: tables[f"accuracy_{kind}"][method][trial] for kind in ("strict", "tolerant")}
    return PublishedCuts(method, trial, scores, printed)
