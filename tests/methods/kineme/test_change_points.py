"""Change points against their naive version, and clusters numbered by appearance."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from kineme.methods.kineme import _tree_kernels as kernels

seconds = settings(max_examples=60)


def one_sided(matrix: np.ndarray, width: int) -> np.ndarray:
    """Return ``band[i, j - i]`` for j from i on; zero beyond the end."""
    band = np.zeros((len(matrix), width + 1), np.float32)
    for i, j in np.ndindex(matrix.shape):
        if 0 <= j - i <= width:
            band[i, j - i] = matrix[i, j]
    return band


@st.composite
def similarities(draw: st.DrawFn, *, max_bins: int = 9) -> np.ndarray:
    """Draw a symmetric similarity matrix from 0 to 1 with ones on the diagonal."""
    n = draw(st.integers(1, max_bins))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    similarity = rng.random((n, n)) ** draw(st.sampled_from([0.1, 1, 10]))
    similarity = np.round(np.minimum(similarity, similarity.T), 2)
    np.fill_diagonal(similarity, 1)
    return similarity


@given(similarities(), st.integers(0, 9), st.sampled_from([0.0, 0.3, 1.0, 5.0]))
@seconds
def test_no_division_is_cheaper(similarity, width, penalty) -> None:
    width = min(width, len(similarity) - 1)
    divisions = naive.list_divisions(len(similarity), width + 1)
    found = kernels.find_change_points(one_sided(similarity, width), penalty).tolist()
    assert found in divisions
    costs = [naive.compute_division_cost(similarity, borders, penalty) for borders in divisions]
    assert naive.compute_division_cost(similarity, found, penalty) == pytest.approx(
        min(costs), abs=1e-4
    )
