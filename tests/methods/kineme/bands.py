"""Make bands along the diagonal of matrices, and points to compute them from."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray


def one_sided(matrix: NDArray[np.floating], width: int) -> NDArray[np.float32]:
    """Return ``band[i, j - i]`` for j from i on; zero beyond the end."""
    band = np.zeros((len(matrix), width + 1), np.float32)
    for i, j in np.ndindex(matrix.shape):
        if 0 <= j - i <= width:
            band[i, j - i] = matrix[i, j]
    return band


@st.composite
def points(draw: st.DrawFn, *, max_frames: int = 30) -> NDArray[np.float32]:
    """Draw points on a small grid, so that many points and distances are equal."""
    frames, dims = draw(st.integers(1, max_frames)), draw(st.integers(1, 3))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return rng.integers(0, draw(st.integers(1, 6)), (frames, dims)).astype(np.float32)
