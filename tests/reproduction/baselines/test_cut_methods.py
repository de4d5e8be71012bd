"""Uniform cuts, PCA, probabilistic PCA and Gaussian mixtures."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from threadpoolctl import threadpool_limits

import kineme
import naive
from kineme.errors import ParameterError
from kineme.evaluation import Comparison, Labelling, border_score
from kineme.features.pose import compute_joint_quaternions
from kineme.methods import PRESETS
from kineme_reproduction.annotations import read_trials
from kineme_reproduction.baselines.barbic2004 import gmm
from kineme_reproduction.baselines.segments import Segments, cut_uniformly

SEEDS = st.integers(0, 2**32 - 1)


@pytest.fixture(autouse=True, scope="module")
def _one_thread():
    """Many small matrices: more threads only wait for each other."""
    with threadpool_limits(1):
        yield


def changing(seed: int, spans: tuple[int, ...] = (60, 70, 50)) -> np.ndarray:
    """Frames of one behaviour after another, each in its own plane of six dimensions."""
    random = np.random.default_rng(seed)
    parts = []
    for span in spans:
        plane = random.normal(size=(2, 6))
        parts.append(random.normal(size=6) + random.normal(size=(span, 2)) @ plane)
    return np.concatenate(parts) + random.normal(scale=0.05, size=(sum(spans), 6))


def cut(method: str, features: np.ndarray, fps: float = 30.0) -> Segments:
    return PRESETS[method].replace(working_fps=fps).segments(features)


@given(st.integers(1, 2000), st.floats(0.01, 5), st.sampled_from([30.0, 59.94, 120.0]))
def test_uniform_cuts_are_evenly_spaced(n_frames, seconds, fps):
    if seconds * fps < 1:
        with pytest.raises(ParameterError, match="less than a frame apart"):
            cut_uniformly(n_frames, fps=fps, seconds=seconds)
        return
    borders = [0, *cut_uniformly(n_frames, fps=fps, seconds=seconds).cuts.tolist(), n_frames]
    lengths = np.diff(borders)
    assert (lengths > 0).all()
    assert (abs(lengths[:-1] - seconds * fps) <= 1).all()
    assert lengths[-1] <= seconds * fps + 1


@settings(max_examples=15)
@given(SEEDS)
def test_pca_cuts_match_the_naive_twin(seed):
    features = changing(seed)
    starts = [0, *cut("pca", features, 10.0).cuts.tolist()]
    for start, stop in pairwise([*starts, None]):
        expected = naive.find_pca_cut(features[start:], first=20, lag=5)
        assert (expected is None) == (stop is None)
        assert expected is None or start + expected == stop


@settings(max_examples=15)
@given(SEEDS)
def test_ppca_cuts_match_the_naive_twin(seed):
    features = changing(seed)
    starts = [0, *cut("ppca", features, 10.0).cuts.tolist()]
    for start, stop in pairwise([*starts, None]):
        expected = naive.find_ppca_cut(features[start:], ahead=12, growth=1)
        assert (expected is None) == (stop is None)
        assert expected is None or start + expected == stop


@pytest.mark.parametrize("method", ["pca", "ppca"])
@given(seed=SEEDS)
@settings(max_examples=10)
def test_turned_moved_and_scaled_features_are_cut_alike(method, seed):
    features = changing(seed)
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(6, 6)))[0]
    plain, other = cut(method, features, 10.0), cut(method, 3 * features @ turn + 5, 10.0)
    assert plain.cuts.tolist() == other.cuts.tolist()


@pytest.mark.parametrize("method", ["pca", "ppca"])
@pytest.mark.parametrize("n_frames", [1, 5, 40, 400])
def test_what_stands_still_or_is_short_is_not_cut(method, n_frames):
    assert cut(method, np.full((n_frames, 4), 0.3)).cuts.size == 0


@pytest.mark.parametrize("method", ["pca", "ppca"])
def test_a_start_from_rest_is_cut_without_a_warning(method):
    still = np.full((300, 3), 0.2)
    moving = 0.2 + np.sin(np.arange(300)[:, None] / [3, 5, 7])
    assert cut(method, np.concatenate([still, moving])).cuts.size > 0


def test_gaussians_are_clusters_that_come_back():
    first, second, third = changing(1)[:60], changing(1)[60:130], changing(1)[:60]
    segments = gmm(np.concatenate([first, second, third]), PRESETS["gmm"].replace(n_classes=2))
    assert segments.cuts.tolist() == [60, 130]
    assert segments.clusters[0] == segments.clusters[2] != segments.clusters[1]


def test_more_gaussians_than_frames_are_refused():
    with pytest.raises(ParameterError, match="3 frames cannot be told into 4"):
        gmm(np.zeros((3, 2)), PRESETS["gmm"].replace(n_classes=4))


def test_pca_methods_find_the_borders_of_a_real_recording(data_dir):
    folder = data_dir / "cmu86"
    truth = read_trials(folder / "annotations.json", fps=120.0)["86_09"]
    quaternions = compute_joint_quaternions(kineme.read(folder / "86_09.amc"))
    for method in ("pca", "ppca"):
        segments = cut(method, quaternions.reshape(len(quaternions), -1), 120.0)
        labels = segments.clusters.tolist()
        found = Labelling.from_cuts(segments.cuts, labels, frames=segments.n_frames, fps=120.0)
        assert border_score(Comparison.of(truth, found)).recall == 1
