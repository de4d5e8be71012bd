"""ACA and HACA: kernels against naive twins, laws, and the original program's runs."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import kineme
import naive
from kineme.errors import MotionError, ParameterError
from kineme.evaluation import Comparison, one_to_one_accuracy
from kineme.features.pose import compute_joint_quaternions, compute_log_maps
from kineme.methods import PRESETS
from kineme_reproduction.annotations import read_trials
from kineme_reproduction.baselines._kernels import (
    cheapest_lengths,
    propagate,
    window_alignments,
)
from kineme_reproduction.baselines.aca import aca, frame_kernel, haca_levels, majority_segments
from kineme_reproduction.baselines.segments import Segments
from kineme_reproduction.benchmark import OF_TRIALS

SEEDS = st.integers(0, 2**32 - 1)
ACA, HACA = PRESETS["aca"], PRESETS["haca"]
SHORT_ACA = ACA.replace(n_classes=2, shortest=12, longest=30, centres=8)
SHORT_HACA = HACA.replace(n_classes=2, fine_lengths=(4, 6), coarse_lengths=(2, 4), centres=8)


def random_kernel(seed: int, n: int) -> np.ndarray:
    return frame_kernel(np.random.default_rng(seed).normal(size=(n, 2)), 0.5)


def two_movements(rounds: int = 4) -> np.ndarray:
    """Four seconds each of two circles at 120 Hz, in turn."""
    t = np.arange(480) / 120 * 2 * np.pi
    circle = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    other = np.stack([0 * t + 4, np.cos(2 * t), np.sin(2 * t)], axis=1)
    noise = np.random.default_rng(0).normal(scale=0.02, size=(rounds * 480, 3))
    return np.concatenate([circle, other] * (rounds // 2)) + noise


@cache
def levels_of_two_movements() -> tuple[Segments, Segments]:
    return haca_levels(two_movements(), SHORT_HACA)


@given(SEEDS, st.integers(3, 14), st.integers(1, 6))
def test_propagation_matches_its_naive_twin(seed, n, longest):
    kernel = random_kernel(seed, n)
    np.testing.assert_array_equal(
        propagate(kernel, longest), naive.propagate_kernel(kernel, longest)
    )


@given(SEEDS, st.integers(2, 14), st.integers(1, 6), st.data())
def test_window_alignments_are_the_dtak_of_every_window(seed, n, longest, data):
    kernel = random_kernel(seed, n)
    weights = np.random.default_rng(seed).integers(1, 9, n).astype(float)
    start = data.draw(st.integers(0, n - 1))
    stop = data.draw(st.integers(start + 1, n))
    found = window_alignments(kernel, weights, start, stop, longest)
    for v in range(n):
        for length in range(1, min(longest, v + 1) + 1):
            window = slice(v - length + 1, v + 1)
            expected = naive.compute_dtak(
                kernel[window, start:stop], weights[window], weights[start:stop]
            )
            assert found[v, length - 1] == pytest.approx(expected, rel=1e-12)


@given(SEEDS, st.integers(1, 10), st.integers(1, 4), st.integers(0, 3))
def test_cheapest_lengths_are_the_cheapest_cover(seed, n, shortest, more):
    longest = shortest + more
    costs = np.random.default_rng(seed).random((n, longest))
    ways = naive.list_covers(n, shortest, longest)
    found = cheapest_lengths(costs, shortest, False).tolist()
    if not ways:
        assert found == []
    else:
        assert found == min(ways, key=lambda way: naive.compute_cover_cost(costs, way))


@given(SEEDS, st.integers(1, 3), st.integers(1, 4))
def test_first_segmentation_repeats_the_programs_slip(seed, shortest, more):
    labels = np.random.default_rng(seed).integers(0, 3, 24)
    state = majority_segments(labels, 3, shortest, shortest + more)
    expected = naive.find_first_segmentation(labels, shortest, shortest + more)
    assert np.diff(state.borders).tolist() == expected


def test_two_movements_in_turn_are_told_apart():
    """Borders may be off by as much as a segment: nothing but its length holds one in place."""
    truth = np.repeat([0, 1] * 2, 480)
    for segments in (aca(two_movements(), SHORT_ACA), levels_of_two_movements()[1]):
        labels = segments.per_frame()
        agreement = np.mean(labels == truth)
        assert max(agreement, 1 - agreement) > 0.85


def test_equal_seeds_give_equal_segments_and_turned_features_the_same():
    features = two_movements()
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    first, second, turned = (
        aca(x, SHORT_ACA.replace(seed=5)) for x in (features, features, features @ turn)
    )
    assert np.array_equal(first.cuts, second.cuts)
    assert first.objective == second.objective
    assert np.array_equal(first.cuts, turned.cuts)
    assert turned.objective == pytest.approx(first.objective)


def test_second_level_segments_are_made_of_first_level_ones():
    fine, coarse = levels_of_two_movements()
    assert set(coarse.cuts) <= set(fine.cuts)
    assert coarse.n_frames == fine.n_frames == 1920


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"n_classes": 40}, "cannot hold 40 classes"),
        ({"shortest": 30, "longest": 20}, "segments of 30 to 20 blocks"),
        ({"shortest": 300, "longest": 301}, "cannot hold 2 classes"),
        ({"shortest": 95, "longest": 97, "n_classes": 1}, "let them differ more"),
    ],
)
def test_impossible_lengths_are_refused(values, message):
    with pytest.raises(ParameterError, match=message):
        aca(two_movements(2), SHORT_ACA.replace(**values))


def test_motions_without_the_joints_are_refused(data_dir):
    motion = kineme.read(data_dir / "formats" / "cmu_131_01_bvh11.bvh")
    with pytest.raises(MotionError, match="no joint 'upperback'"):
        compute_joint_quaternions(motion)


def test_accuracy_agrees_with_the_original_program(data_dir: Path):
    """Two seeds of the five, on one trial."""
    folder, trial = data_dir / "cmu86", "86_01"
    reference = json.loads((folder / "reference" / f"aca_haca_{trial}.json").read_text())
    truth = read_trials(folder / "annotations.json", fps=120.0)[trial]
    features = compute_log_maps(compute_joint_quaternions(kineme.read(folder / f"{trial}.amc")))

    def accuracy(segments: Segments) -> float:
        true = truth.at_means().numbers()  # without a class for transitions
        return one_to_one_accuracy(Comparison(true, segments.per_frame(), 120.0))

    for name in ("aca", "haca"):
        preset = PRESETS[name].replace(n_classes=4, **OF_TRIALS.get((name, trial), {}))
        theirs = [r[name]["accuracy"] for r in reference["runs"]]
        ours = np.mean([accuracy(preset.replace(seed=s).segments(features)) for s in (1, 2)])
        assert ours == pytest.approx(np.mean(theirs), abs=0.03), name
