"""Segmenter keeps scikit-learn's rules, and its own."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from sklearn.base import clone
from sklearn.model_selection import ParameterGrid
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer
from sklearn.utils.estimator_checks import parametrize_with_checks

import kineme
from kineme import Segmenter, Signals, segment
from kineme.errors import ParameterError

ORDER_MATTERS = "the rows of this check are in no order, and clusters here are of stretches in time"
EXPECTED = {"check_clustering": ORDER_MATTERS}


@parametrize_with_checks(
    [Segmenter(), Segmenter("krueger2017", fps=10.0, radius=0.4)],
    expected_failed_checks=lambda _: EXPECTED,
)
def test_scikit_learn_rules(estimator, check) -> None:
    check(estimator)


def two_movements(fps: float = 50.0) -> np.ndarray:
    """Twelve seconds of one movement of three channels, then as much of another."""
    t = np.arange(int(24 * fps)) / fps
    one = np.column_stack([np.sin(5 * t), np.cos(5 * t), np.sin(10 * t)])
    two = np.column_stack([np.sin(9 * t), np.sin(9 * t + 1) ** 3, np.cos(18 * t)])
    rng = np.random.default_rng(0)
    return np.where((t < 12)[:, None], one, two) + 0.05 * rng.standard_normal((len(t), 3))


@pytest.mark.parametrize("preset", ["kineme", "voegele2014", "krueger2017"])
def test_two_movements_are_two_clusters_with_a_border_between(preset: str) -> None:
    estimator = Segmenter(preset, fps=50)
    labels = estimator.fit_predict(two_movements())
    assert labels.shape == (1200,)
    early, late = set(labels[100:500].tolist()), set(labels[700:1100].tolist())
    assert not early & late
    cuts = estimator.segmentation_.cuts()
    assert np.abs(cuts - 600).min() <= 25
    assert estimator.segmentation_.fps == 50


def test_labels_are_those_of_the_segmentation() -> None:
    x = two_movements()
    estimator = Segmenter(fps=50, min_action=2.0).fit(x)
    same = segment(Signals(x, 50), min_action=2.0)
    assert estimator.segmentation_.table == same.table
    assert estimator.labels_.tolist() == same.per_frame("cluster").tolist()
    assert estimator.segmentation_.provenance["parameters"]["min_action"] == 2.0


def test_constants_are_parameters_like_others() -> None:
    estimator = Segmenter("krueger2017", fps=50, radius=0.4)
    assert clone(estimator).get_params() == estimator.get_params()
    assert estimator.get_params()["radius"] == 0.4
    few, many = (
        len(clone(estimator).set_params(**values).fit(two_movements()).segmentation_)
        for values in ParameterGrid({"radius": [0.05, 0.4]})
    )
    assert few < many
    assert "radius=0.4" in repr(estimator)


def test_what_a_preset_cannot_take_is_said_by_fit() -> None:
    with pytest.raises(ParameterError, match="sensors has no parameter 'radius'"):
        Segmenter(radius=0.4).fit(two_movements())
    with pytest.raises(ParameterError, match="one of voegele2014 and krueger2017"):
        Segmenter(radius=0.4).fit(two_movements())
    with pytest.raises(ParameterError, match="no left and right"):
        Segmenter("krueger2017", mirror=True).fit(two_movements())
    with pytest.raises(ParameterError, match="smoothing must be a number from 0 to 3600 s, not -1"):
        Segmenter(smoothing=-1).fit(two_movements())
    with pytest.raises(ParameterError, match="frame rate is -5"):
        Segmenter(fps=-5).fit(two_movements())


def test_data_frames_name_the_channels_and_pipelines_hold_it() -> None:
    frame = pd.DataFrame(two_movements(), columns=["acc_x", "acc_y", "acc_z"])
    estimator = Segmenter(fps=50).fit(frame)
    assert list(estimator.feature_names_in_) == list(frame.columns)
    assert "channels: acc_x, acc_y, acc_z" in estimator.segmentation_.provenance["notes"][0]
    piped = make_pipeline(FunctionTransformer(), Segmenter(fps=50)).fit_predict(frame.to_numpy())
    assert piped.tolist() == estimator.labels_.tolist()


def test_a_rate_that_was_not_given_is_said() -> None:
    estimator = Segmenter().fit(two_movements(30.0))
    assert estimator.segmentation_.fps == 30
    assert (
        "frame rate 30 Hz assumed: no fps was given"
        in (estimator.segmentation_.provenance["notes"])
    )


def test_a_rate_of_nothing_is_refused() -> None:
    with pytest.raises(ParameterError, match="frame rate is 0"):
        Segmenter(fps=0).fit(np.zeros((10, 1)))


@pytest.mark.parametrize("zone", [None, "Europe/Berlin"])
def test_a_data_frame_that_knows_its_times_tells_the_rate(zone: str | None) -> None:
    times = pd.date_range("2026-03-01", periods=1200, freq="20ms", tz=zone)
    frame = pd.DataFrame(two_movements(), index=times, columns=["x", "y", "z"])
    told, given = Segmenter().fit(frame).segmentation_, Segmenter(fps=50).fit(frame).segmentation_
    assert told.table == given.table
    assert "frame rate 50 Hz, as the times in the index" in told.provenance["notes"][0]
    counted = Segmenter().fit(frame.reset_index(drop=True)).segmentation_
    assert counted.fps == 30


def test_a_name_that_is_no_parameter_is_refused_when_it_is_set() -> None:
    with pytest.raises(ParameterError, match="no parameter or constant 'nonsense'"):
        Segmenter().set_params(nonsense=3)
    changed = Segmenter().set_params(preset="krueger2017", radius=0.4)
    assert changed.get_params()["radius"] == 0.4


def test_a_recording_is_told_where_it_belongs() -> None:
    with pytest.raises(ParameterError, match="kineme.segment takes recordings"):
        Segmenter().fit_predict(kineme.read(kineme.bundled_recording()))
