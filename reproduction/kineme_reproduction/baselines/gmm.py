"""Gaussian mixture segmentation (Barbič et al. 2004): a cut where the likeliest Gaussian changes.

Source: Barbič, Safonova, Pan, Faloutsos, Hodgins and Pollard, "Segmenting
Motion Capture Data into Distinct Behaviors", Graphics Interface 2004, section
on Gaussian mixtures. ("GMM" in the program of Zhou et al. is something else:
spectral clustering of the frames.)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from sklearn.decomposition import PCA
from sklearn.mixture import GaussianMixture
from threadpoolctl import threadpool_limits

from kineme.errors import ParameterError
from kineme_reproduction.baselines.principal import checked
from kineme_reproduction.baselines.segments import Segments

if TYPE_CHECKING:
    from kineme_reproduction.baselines.constants import GmmConstants

Floats = NDArray[np.float64]


def gmm(features: Floats, preset: GmmConstants) -> Segments:
    """Find runs of frames with the same likeliest Gaussian; the Gaussians are the clusters.

    The features are reduced to the principal components with most of their
    variance; expectation maximisation starts from k-means. No segment is too
    short to stand.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        Such as the quaternions of `compute_joint_quaternions`.
    preset : GmmConstants
        Told the number of Gaussians.

    Raises
    ------
    ParameterError
        Fewer frames than Gaussians.
    """
    frames, n_classes = checked(features), preset.required_classes()
    if n_classes > len(frames):
        raise ParameterError(f"{len(frames)} frames cannot be told into {n_classes} classes")
    with threadpool_limits(1):  # sums, and so results, would change with the number of cores
        reduced = PCA(preset.variance_kept, svd_solver="full").fit_transform(frames)
        labels = GaussianMixture(n_classes, random_state=preset.seed).fit_predict(reduced)
    cuts = np.flatnonzero(np.diff(labels)) + 1
    return Segments(cuts, labels[np.append(0, cuts)].astype(np.int64), len(frames))
