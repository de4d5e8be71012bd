"""Principal components of the first frames of a recording, for any number of them at once."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ParameterError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BATCH = 256


def leading_scatters(features: Floats, counts: Ints) -> Iterator[tuple[Ints, Floats, Floats]]:
    """Per batch of counts: counts, means (batch, dims), scatters (batch, dims, dims).

    The scatter of the first n frames is the sum of the outer products of their
    deviations from their mean.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
    counts : ndarray
        Numbers of frames, rising.
    """
    centred = features - features.mean(axis=0)  # squares of small numbers keep their digits
    total = np.zeros(features.shape[1])
    products = np.zeros((features.shape[1],) * 2)
    done = 0
    for batch in np.array_split(counts, -(-len(counts) // BATCH)):
        means = np.empty((len(batch), features.shape[1]))
        scatters = np.empty((len(batch), *products.shape))
        for row, count in enumerate(batch):
            new = centred[done:count]
            total = total + new.sum(axis=0)
            products = products + new.T @ new
            done = count
            means[row] = total / count
            scatters[row] = products - count * np.outer(means[row], means[row])
        yield batch, means + features.mean(axis=0), scatters


def dimensions_kept(variances: Floats, share: float) -> int:
    """Return the fewest leading dimensions with more than this share of the variance.

    Parameters
    ----------
    variances : ndarray
        Per component, the largest first.
    """
    total = np.cumsum(np.maximum(variances, 0))
    return int(np.searchsorted(total, share * total[-1], side="right")) + 1


def checked(features: Floats) -> Floats:
    """Return the features as an array (frames, dims), or raise an error."""
    array = np.asarray(features, np.float64)
    if array.ndim != 2 or not len(array):
        raise ParameterError(f"features must be (frames, dims), not of shape {array.shape}")
    if not np.isfinite(array).all():
        raise ParameterError("features must be finite numbers")
    return array
