"""Our scores of the authors' own results are the figures they, and others, measured."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from reference_results import (
    CONFIGURATIONS,
    TRIALS,
    activities,
    clusters,
    from_one,
    reference,
)

from kineme.evaluation import (
    TRANSITION,
    Comparison,
    Labelling,
    Truth,
    border_ratio,
    border_score,
    covering,
    cut_ratio,
    one_to_one_accuracy,
)
from kineme_reproduction.annotations import read_trials
from kineme_reproduction.benchmark import published
from kineme_reproduction.protocols import majority_accuracy, strict_and_tolerant

of = Comparison.of


def right(truth: Truth, found: Labelling) -> tuple[float, float]:
    """Of all frames, and of those on which people agree."""
    compared = of(truth, found)
    return one_to_one_accuracy(compared), one_to_one_accuracy(compared.agreed)


@pytest.fixture(scope="module")
def truths(data_dir: Path) -> dict[str, Truth]:
    return read_trials(data_dir / "cmu86" / "annotations.json")


@pytest.fixture(scope="module")
def stored(data_dir: Path) -> dict:
    return json.loads((data_dir / "cmu86" / "published.json").read_text())


@pytest.mark.parametrize("trial", TRIALS)
@pytest.mark.parametrize("configuration", CONFIGURATIONS)
def test_strict_and_tolerant_are_the_programs_to_all_digits(data_dir, truths, configuration, trial):
    result = reference(data_dir, configuration, trial)
    found = from_one(result["activity_cuts"], result["frames"])
    scores = strict_and_tolerant(of(truths[trial], found))
    assert np.round(scores, 4) == pytest.approx(
        (result["accuracy_strict"], result["accuracy_tolerant"]), abs=1e-9
    )


@pytest.mark.parametrize(
    ("step", "strict", "tolerant"),
    [(36, 0.935, 0.961), (15, 0.972, 0.981), (5, 0.989, 0.995), (10**6, 0.203, 0.227)],
)
def test_uniform_cuts_pass_every_method_under_the_papers_protocol(truths, step, strict, tolerant):
    scores = [
        strict_and_tolerant(of(truths[trial], uniform(truths[trial], step))) for trial in TRIALS
    ]
    assert np.mean(scores, axis=0) == pytest.approx((strict, tolerant), abs=6e-4)


@pytest.mark.parametrize(
    ("configuration", "one_to_one", "agreed", "f1", "covered", "cuts", "number"),
    [
        ("2014_paper", 0.742, 0.778, 0.72, 0.82, 2.4, 14.8),
        ("2017_program_defaults", 0.834, 0.872, 0.86, 0.89, 1.7, 11.2),
    ],
)
def test_fair_scores_of_the_authors_programs(
    data_dir, truths, configuration, one_to_one, agreed, f1, covered, cuts, number
):
    """The table's one-to-one lets ``transition`` be assigned like any cluster; ours does not."""
    free, ours, rest = [], [], []
    for trial in TRIALS:
        result, truth = reference(data_dir, configuration, trial), truths[trial]
        groups, stretches = clusters(result), activities(result)
        free.append(right(truth, renamed(groups)))
        ours.append(right(truth, groups))
        plain = from_one(result["activity_cuts"], result["frames"])
        rest.append(
            (
                border_score(of(truth, stretches)).f1,
                covering(of(truth, plain)),
                cut_ratio(of(truth, plain)).value,
                len(set(result["clusters"])),
            )
        )
    assert np.mean(free, axis=0) == pytest.approx((one_to_one, agreed), abs=1.5e-3)
    assert (np.mean(ours, axis=0) <= np.mean(free, axis=0) + 1e-12).all()
    f1_found, *others = np.mean(rest, axis=0)
    assert f1_found == pytest.approx(f1, abs=5e-3)
    assert others == pytest.approx((covered, cuts, number), abs=0.03)
    assert (
        np.mean(
            [
                border_ratio(of(truths[t], activities(reference(data_dir, configuration, t)))).value
                for t in TRIALS
            ]
        )
        < cuts
    )


def test_majority_accuracy_is_near_the_rerun_of_others(truths, stored):
    """Their ACA was another run, so trials differ; where cuts agree the measure must."""
    truth = truths["86_01"]
    found = from_one(
        stored["aca_cuts_30hz"]["86_01"], truth.frames, stored["aca_cluster_ids"]["86_01"]
    )
    assert majority_accuracy(of(truth, found)) == pytest.approx((0.8146, 0.9374), abs=1e-3)


def test_published_figures_ship_with_their_sources(stored):
    tables = published()
    for name in tables["sources"]:
        assert tables[name] == stored[name]


def uniform(truth: Truth, step: int) -> Labelling:
    return Labelling.from_cuts(
        np.arange(step, truth.frames, step), frames=truth.frames, fps=truth.fps
    )


def renamed(found: Labelling) -> Labelling:
    labels = ["between" if label == TRANSITION else label for label in found.labels]
    return Labelling(found.borders, tuple(labels), found.fps)
