"""Borders and labels against their naive twins, and on recordings of known blocks."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from bands import one_sided
from kineme.methods.recurrence import _action_kernels as kernels
from kineme.methods.recurrence.change_points import change_points, divided, merge_neighbors
from kineme.methods.recurrence.recurrence import narrower
from kineme.methods.segments import by_first_appearance
from loops import measured, swing

seconds = settings(max_examples=60)


@st.composite
def similarities(draw: st.DrawFn, *, max_bins: int = 9) -> np.ndarray:
    """Symmetric, from 0 to 1, each sample similar to itself."""
    n = draw(st.integers(1, max_bins))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    similarity = rng.random((n, n)) ** draw(st.sampled_from([0.1, 1, 10]))
    similarity = np.round(np.minimum(similarity, similarity.T), 2)
    np.fill_diagonal(similarity, 1)
    return similarity


@given(similarities(), st.integers(0, 9), st.integers(0, 4), st.sampled_from([0.0, 0.3, 1.0, 5.0]))
@seconds
def test_no_division_is_cheaper(similarity, width, shortest, penalty) -> None:
    width = min(width, len(similarity) - 1)
    divisions = naive.divisions(len(similarity), shortest, width + 1)
    found = kernels.change_points(one_sided(similarity, width), penalty, shortest).tolist()
    assert found in divisions
    costs = [naive.division_cost(similarity, borders, penalty) for borders in divisions]
    assert naive.division_cost(similarity, found, penalty) == pytest.approx(min(costs), abs=1e-4)


@given(similarities(max_bins=12), st.integers(0, 12), st.integers(0, 5), st.data())
@seconds
def test_affinities_are_those_of_the_naive_version(similarity, width, gap, data) -> None:
    n = len(similarity)
    labels = np.array(data.draw(st.lists(st.integers(0, 2), min_size=n, max_size=n)), np.int64)
    found = np.full((n, 3), np.nan)
    band = one_sided(similarity, width)
    kernels.class_affinities(band, labels, gap, 0, n, found)
    expected = naive.class_affinities(similarity, width, labels, 3, gap)
    np.testing.assert_allclose(found, expected, atol=1e-6)


@given(similarities(max_bins=12), st.integers(0, 12), st.data())
@seconds
def test_summed_similarities_are_those_of_the_naive_version(similarity, width, data) -> None:
    n = len(similarity)
    labels = np.array(data.draw(st.lists(st.integers(-1, 2), min_size=n, max_size=n)), np.int64)
    sums, counts = np.zeros((3, 3)), np.zeros((3, 3))
    kernels.sum_similarities(one_sided(similarity, width), labels, sums, counts)
    expected = naive.sum_similarities(similarity, min(width, n - 1), labels, 3)
    np.testing.assert_allclose(sums, expected[0], atol=1e-5)
    np.testing.assert_array_equal(counts, expected[1])


@given(st.integers(1, 6), st.integers(1, 3), st.sampled_from([0.0, 0.2, 1.0]), st.integers(0, 99))
@seconds
def test_no_labels_are_cheaper(n, classes, switch_cost, seed) -> None:
    costs = np.random.default_rng(seed).integers(0, 5, (n, classes)) / 4
    found = kernels.cheapest_labels(costs, switch_cost)
    every = np.indices((classes,) * n).reshape(n, -1).T
    cheapest = min(naive.labels_cost(costs, labels, switch_cost) for labels in every)
    assert naive.labels_cost(costs, found, switch_cost) == pytest.approx(cheapest)


@given(st.lists(st.integers(-1, 4), max_size=20))
@seconds
def test_labels_are_counted_by_first_appearance(labels) -> None:
    found = by_first_appearance(np.array(labels, np.int64)).tolist()
    known = [label for label in dict.fromkeys(labels) if label >= 0]
    assert found == [known.index(label) if label >= 0 else -1 for label in labels]


def test_borders_are_where_the_movement_changes() -> None:
    found = measured(swing(8, period=1), swing(10, period=1.2, axis=2), swing(9, period=0.8))
    borders = change_points(found, penalty=17.5, min_length=6)
    np.testing.assert_allclose(borders, [0, 80, 200, 272], atol=1)


def test_two_slow_repetitions_are_parts_of_one_stretch() -> None:
    found = measured(swing(2, period=6), swing(8, period=1.2, axis=2))
    parts = np.array([0, 60, 120, len(found)])
    merged = merge_neighbors(parts, found, gap=8, softness=2.0, least=0.3)
    assert merged.tolist() == [0, 120, len(found)]
    # Nothing is left to merge.
    assert (
        merge_neighbors(merged, found, gap=8, softness=2.0, least=0.3).tolist() == merged.tolist()
    )


SHORT = {"softness": 2.0, "least": 0.5, "elsewhere": 0.65, "min_length": 6}


def test_short_exercises_are_divided() -> None:
    parts = [swing(3, period=1), swing(3, period=1.2, axis=2), swing(2, period=0.8, axis=4)]
    wide = measured(*parts)
    narrow = narrower(wide, phases=(7,), rank=16, low=0.08, high=0.16)
    finer = np.array([0, 30, 66, 82])
    assert divided(np.array([0, 82]), finer, narrow, **SHORT).tolist() == [0, 30, 66, 82]
    # Not near a border that is there.
    assert divided(np.array([0, 27, 82]), finer, narrow, **SHORT).tolist() == [0, 27, 66, 82]


def test_phases_of_slow_repetitions_are_not_divided() -> None:
    wide = measured(swing(3, period=6))
    narrow = narrower(wide, phases=(7,), rank=16, low=0.08, high=0.16)
    finer = np.arange(0, 181, 15)
    assert divided(np.array([0, 180]), finer, narrow, **SHORT).tolist() == [0, 180]
