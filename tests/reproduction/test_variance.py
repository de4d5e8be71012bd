"""Clusters of like segments are tight, wherever and however fast they are performed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from reference_results import TRIALS, from_one, reference

import kineme_reproduction.benchmark  # noqa: F401 (registers the scores)
import naive
from kineme.errors import ParameterError
from kineme.evaluation import (
    TRANSITION,
    Labelling,
    Truth,
    evaluate,
)
from kineme.features._kernels import find_cheapest_path
from kineme.features.point_clouds import compute_cloud_distances
from kineme_reproduction.variance import feature_variance, overall, point_cloud_variance


@given(
    arrays(np.float64, st.tuples(st.integers(1, 7), st.integers(1, 7)), elements=st.floats(0, 10)),
    st.floats(0, 3),
)
def test_the_cheapest_warp_is_its_recursion_and_its_path_costs_as_much(cost, step):
    total, rows, columns = find_cheapest_path(cost, step)
    assert total == pytest.approx(naive.find_cheapest_cost(cost, step))
    moves = np.stack([np.diff(rows, prepend=-1), np.diff(columns, prepend=-1)])
    assert (moves.max(axis=0) == 1).all()
    assert moves.min() >= 0
    aside = (moves.sum(axis=0) == 1).sum()
    assert cost[rows, columns].sum() + step * aside == pytest.approx(total)


@pytest.fixture
def walk() -> np.ndarray:
    """Four joints moving about for 40 frames."""
    return np.random.default_rng(1).normal(size=(40, 4, 3)).cumsum(axis=0) * 0.05


def moved(points: np.ndarray, angle: float) -> np.ndarray:
    turn = np.array(
        [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    )
    return points @ turn.T + [3.0, 0.0, -2.0]


def test_place_and_facing_do_not_matter_but_height_does(walk):
    twice = np.concatenate([walk, moved(walk, 2.0)])
    inner = compute_cloud_distances(twice, slice(5, 35), slice(45, 75), half=2)
    assert np.abs(np.diag(inner)).max() < 1e-6
    lifted = np.concatenate([walk, walk + [0, 0.1, 0]])
    assert np.diag(
        compute_cloud_distances(lifted, slice(5, 35), slice(45, 75), half=2)
    ) == pytest.approx(0.1)


def test_the_closed_form_is_the_least_over_all_turns(walk):
    found = compute_cloud_distances(walk, slice(3, 5), slice(20, 22), half=1)
    for i, j in ((0, 1), (1, 0)):
        least = naive.compute_cloud_distance(walk, 3 + i, 20 + j, half=1)
        assert found[i, j] == pytest.approx(least, abs=1e-3)


def test_equal_segments_have_no_variance_and_transitions_are_left_out(walk):
    features = np.concatenate([walk.reshape(40, 12)] * 2 + [np.zeros((20, 12))])
    found = Labelling([0, 40, 80, 90, 100], ("1", "1", "2", TRANSITION), 30.0)
    first, second = feature_variance(features, found)
    assert (first.segments, first.distance_mean, first.distance_variance) == (2, 0, 0)
    assert first.length_mean_s == pytest.approx(40 / 30)
    assert (second.segments, np.isnan(second.distance_mean)) == (1, True)
    assert overall([first, second]) == (0, 0)
    assert np.isnan(overall([second])).all()


def test_each_ordered_pair_is_divided_by_the_length_of_its_first():
    features = np.array([0.0, 0, 1, 1, 1])[:, None]
    (cluster,) = feature_variance(features, Labelling([0, 2, 5], ("1", "1"), 10.0))
    assert cluster.distance_mean == pytest.approx((3 / 2 + 3 / 3) / 2)
    assert cluster.distance_variance == pytest.approx(np.var([3 / 2, 3 / 3], ddof=1))


def test_evaluate_adds_variances_where_it_has_the_data(walk):
    truth = Truth(("a",), [], [], [], 40, 30.0)
    found = Labelling([0, 20, 40], ("1", "1"), 30.0)
    scores = evaluate(truth, found, positions=walk, features=walk.reshape(40, 12))
    assert scores["cloud_distance"] > 0 < scores["feature_distance"]
    assert not {"cloud_distance", "feature_distance"} & evaluate(truth, found).keys()


def test_data_of_another_shape_or_length_is_one_clear_error(walk):
    found = Labelling([0, 50], ("1",), 30.0)
    with pytest.raises(ParameterError, match="segments cover 50 frames, the data 40"):
        point_cloud_variance(walk, found)
    with pytest.raises(ParameterError, match="positions must be"):
        point_cloud_variance(walk[0], found)
    with pytest.raises(ParameterError, match="features must be"):
        feature_variance(walk, found)


def test_the_programs_clusters_are_tighter_than_those_of_aca_and_haca(data_dir):
    """Figure 5 (b), over the five trials: on the features the program itself stored."""
    means: dict[str, list[tuple[float, float]]] = {"program": [], "aca": [], "haca": []}
    for trial in TRIALS:
        stored = np.load(data_dir / "cmu86" / "reference" / f"2014_paper_{trial}.npz")
        features = stored["features"].T
        program = reference(data_dir, "2014_paper", trial)
        runs = reference(data_dir, "aca_haca", trial)["runs"][0]
        found = {
            "program": (program["all_cuts"], program["clusters"]),
            **{name: (runs[name]["cuts_30hz"], runs[name]["clusters"]) for name in ("aca", "haca")},
        }
        for name, (cuts, numbers) in found.items():
            segments = from_one(cuts, len(features), numbers)
            means[name].append(overall(feature_variance(features, segments)))
    program, aca, haca = (np.mean(means[name], axis=0) for name in ("program", "aca", "haca"))
    assert (program < aca).all()
    assert (program < haca).all()
