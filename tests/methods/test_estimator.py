"""Segmenter follows the conventions of scikit-learn, and its own."""

from __future__ import annotations

import warnings

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
from kineme.errors import KinemeWarning, ParameterError

ORDER_MATTERS = "the rows of this check are in no order, and clusters here are of stretches in time"
EXPECTED = {
    "check_clustering": ORDER_MATTERS,
    "check_fit1d": "a series of one channel may be a vector, as for segmenters of other libraries",
}


@parametrize_with_checks(
    [Segmenter(fps=30.0), Segmenter("krueger2017", fps=10.0, radius=0.4, level="primitive")],
    expected_failed_checks=lambda _: EXPECTED,
)
def test_scikit_learn_rules(estimator, check) -> None:
    check(estimator)


def two_movements(fps: float = 50.0) -> np.ndarray:
    """Make twelve seconds of one movement of three channels, then twelve of another."""
    t = np.arange(int(24 * fps)) / fps
    one = np.column_stack([np.sin(5 * t), np.cos(5 * t), np.sin(10 * t)])
    two = np.column_stack([np.cos(18 * t), np.sin(9 * t), np.sin(9 * t) ** 3])
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


@pytest.mark.parametrize("level", ["activity", "primitive"])
def test_labels_are_states_without_holes(level: str) -> None:
    x = two_movements()
    estimator = Segmenter(fps=50, level=level, min_action=2.0).fit(x)
    same = segment(Signals(x, 50), min_action=2.0)
    assert estimator.segmentation_.table == same.table
    clusters = same.per_frame("cluster", level=level)
    between = clusters < 0
    assert estimator.labels_[~between].tolist() == clusters[~between].tolist()
    assert (estimator.labels_ >= 0).all()
    assert len(np.unique(estimator.labels_)) == estimator.n_states_
    assert estimator.change_points_.tolist() == same.cuts(level).tolist()
    assert estimator.segmentation_.provenance["parameters"]["min_action"] == 2.0


def test_vectors_frames_and_lists_are_rows() -> None:
    t = np.arange(1200) / 30
    x = np.where(t < 20, np.sin(9 * t), 3 + np.sin(4 * t))
    labels = Segmenter(fps=30).fit_predict(x).tolist()
    frames = (pd.DataFrame(x), pd.DataFrame({"acc": x, "reps": 3}))
    for rows in (x[:, None], x.tolist(), pd.Series(x), *frames):
        assert Segmenter(fps=30).fit_predict(rows).tolist() == labels
    assert segment(x, fps=30).table == segment(Signals(x, 30)).table
    with pytest.raises(ParameterError, match="a recording has its own"):
        segment(Signals(x, 30), fps=30)


def test_as_many_segments_and_states_as_are_wanted() -> None:
    x = two_movements()
    for wanted in (1, 2):
        assert Segmenter(fps=50, n_states=wanted).fit(x).n_states_ == wanted
        found = Segmenter(fps=50, n_segments=wanted).fit(x)
        assert len(found.segmentation_.activities) == wanted
        assert len(found.change_points_) == wanted - 1
    coarse = Segmenter(fps=50, detail=0.01).fit(x).segmentation_
    assert len(coarse.activities) == 1
    with pytest.warns(KinemeWarning, match="no level has 400 states: the nearest has"):
        Segmenter(fps=50, n_states=400).fit(x)
    with pytest.raises(ParameterError, match="krueger2017 has one level"):
        Segmenter("krueger2017", fps=50, n_states=2).fit(x)
    with pytest.raises(ParameterError, match="not both"):
        Segmenter(n_states=2, n_segments=2).fit(x)
    with pytest.raises(ParameterError, match="n_states is 0"):
        Segmenter(n_states=0).fit(x)


def test_other_recordings_are_in_the_same_states() -> None:
    x = two_movements()
    estimator = Segmenter(fps=50).fit(x)
    turned = np.concatenate([x[600:], x[:600]])
    found = estimator.predict(turned)
    assert (found[50:550] == estimator.labels_[900]).all()
    assert (found[650:1150] == estimator.labels_[300]).all()
    assert (estimator.predict(x) == estimator.labels_).mean() > 0.95


@pytest.mark.parametrize("gap", [(0, 100), (550, 700), (1100, 1200)])
def test_rows_in_a_gap_keep_their_state(gap: tuple[int, int]) -> None:
    x = two_movements()
    x[slice(*gap)] = np.nan
    estimator = Segmenter(fps=50).fit(x)
    assert estimator.predict(x).tolist() == estimator.labels_.tolist()


def test_channels_without_names_are_matched_in_order() -> None:
    x = two_movements()
    for frame in (pd.DataFrame(x, columns=["a", "b", "c"]), pd.DataFrame(x)):
        for one, other in ((x, frame), (frame, x)):
            estimator = Segmenter(fps=50).fit(one)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)
                assert estimator.predict(other).tolist() == estimator.predict(one).tolist()


def test_rows_at_any_times_have_states() -> None:
    t = np.sort(np.random.default_rng(0).choice(2000, 1500, replace=False)) / 50
    x = np.where(t < 20, np.sin(9 * t), 3 + np.sin(4 * t))
    frame = pd.DataFrame({"acc": x}, index=pd.to_timedelta(t, unit="s"))
    order = np.random.default_rng(1).permutation(1500)
    with pytest.warns(KinemeWarning, match="not in order of time"):
        estimator = Segmenter().fit(frame.iloc[order])
    states = np.empty(1500, int)
    states[order] = estimator.labels_
    sure = np.abs(t - 20) > 0.5
    assert (states == (t > 20))[sure].all()
    (border,) = estimator.change_points_
    assert abs(t[border] - 20) < 0.4


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


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"radius": 0.4}, "sensors has no parameter 'radius'.*voegele2014 and krueger2017"),
        ({"preset": "krueger2017", "mirror": True}, "no left and right"),
        ({"smoothing": -1}, "smoothing must be a number from 0 to 3600 s, not -1"),
        ({"fps": -5}, "frame rate is -5"),
        ({"fps": 0}, "frame rate is 0"),
    ],
)
def test_what_a_preset_cannot_take_is_said_by_fit(options, message) -> None:
    with pytest.raises(ParameterError, match=message):
        Segmenter(**{"fps": 50, **options}).fit(two_movements())


def test_data_frames_name_the_channels_and_pipelines_hold_it() -> None:
    frame = pd.DataFrame(two_movements(), columns=["acc_x", "acc_y", "acc_z"])
    estimator = Segmenter(fps=50).fit(frame)
    assert list(estimator.feature_names_in_) == list(frame.columns)
    assert "channels: acc_x, acc_y, acc_z" in estimator.segmentation_.provenance["notes"][0]
    piped = make_pipeline(FunctionTransformer(), Segmenter(fps=50)).fit_predict(frame.to_numpy())
    assert piped.tolist() == estimator.labels_.tolist()
    frame.columns = pd.MultiIndex.from_product([["acc"], list("xyz")])
    assert Signals(frame, 50).names == ("acc_x", "acc_y", "acc_z")
    assert Segmenter(fps=50).fit_predict(frame).tolist() == estimator.labels_.tolist()


@pytest.mark.parametrize("zone", [None, "Europe/Berlin"])
def test_a_data_frame_that_knows_its_times_tells_the_rate(zone: str | None) -> None:
    times = pd.date_range("2026-03-01", periods=1200, freq="20ms", tz=zone)
    frame = pd.DataFrame(two_movements(), index=times, columns=["x", "y", "z"])
    told, given = Segmenter().fit(frame).segmentation_, Segmenter(fps=50).fit(frame).segmentation_
    assert told.table == given.table
    with pytest.warns(KinemeWarning, match="30 rows a second assumed: give fps= or times="):
        counted = Segmenter().fit(frame.reset_index(drop=True)).segmentation_
    assert counted.fps == 30


def test_a_name_that_is_no_parameter_is_refused_when_it_is_set() -> None:
    with pytest.raises(ParameterError, match="no parameter or constant 'nonsense'"):
        Segmenter().set_params(nonsense=3)
    changed = Segmenter().set_params(preset="krueger2017", radius=0.4)
    assert changed.get_params()["radius"] == 0.4


def test_a_recording_is_told_where_it_belongs() -> None:
    with pytest.raises(ParameterError, match="kineme.segment for recordings"):
        Segmenter().fit_predict(kineme.read(kineme.bundled_recording()))
