"""Segment by the three methods of Barbič et al. 2004: PCA, probabilistic PCA, Gaussian mixtures.

The features are the quaternions of 14 joints in one row per frame
(`compute_joint_quaternions`); lengths are the paper's frame numbers at 120 Hz,
in seconds. `pca` and `ppca` cut where a model of the frames so far ceases to fit;
they start anew at each cut, and find no clusters.

Source: Barbič, Safonova, Pan, Faloutsos, Hodgins and Pollard, "Segmenting
Motion Capture Data into Distinct Behaviors", Graphics Interface 2004. Two things
are our reading: the first frame at which the running mean of `pca` is trusted,
and the range that sets the threshold of `ppca`, taken over the motion that is
left. ("GMM" in the program of Zhou et al. is something else: spectral clustering
of the frames.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from sklearn.decomposition import PCA
from sklearn.mixture import GaussianMixture
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Floats, Ints
from kineme.errors import ParameterError
from kineme_reproduction.baselines.segments import Segments, unclustered

if TYPE_CHECKING:
    from kineme_reproduction.baselines.presets import GmmPreset, PcaPreset, PpcaPreset

BATCH = 256
"""Numbers of frames whose scatters are computed at once."""


def pca(features: Floats, preset: PcaPreset) -> Segments:
    """Cut where the error of a fixed number of principal components rises faster than before.

    The first two seconds fix the number r of components that keep 90 % of the
    variance. e_i is the squared error left when the first i frames are
    projected on their own first r components, d_i = e_i - e_(i - 0.5 s). The cut
    is the first i whose d_i exceeds the mean of those before it by three
    standard deviations, once half a second of them is known.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        At ``preset.working_fps``.
    preset : PcaPreset
    """
    return _cut_and_start_anew(features, partial(_error_jump, preset=preset))


def ppca(features: Floats, preset: PpcaPreset) -> Segments:
    """Cut where the next frames differ most from the previous ones.

    A Gaussian is fitted to the first K frames: their principal components up to
    95 % of the variance, and the mean of the discarded variances in all other
    directions. H is the mean squared Mahalanobis distance of the 1.25 s ahead. K
    grows from 1.25 s in steps of 1/12 s; the cut is the first peak of H that
    rises above the lowest H before it by a tenth of H's range.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        At ``preset.working_fps``.
    preset : PpcaPreset
    """
    return _cut_and_start_anew(features, partial(_distance_peak, preset=preset))


def gmm(features: Floats, preset: GmmPreset) -> Segments:
    """Find runs of frames with the same likeliest Gaussian; the Gaussians are the clusters.

    The features are reduced to the principal components with most of their
    variance; expectation maximisation starts from k-means. No segment is too
    short to stand.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
        Such as the quaternions of `compute_joint_quaternions`.
    preset : GmmPreset
        Told the number of Gaussians.

    Raises
    ------
    ParameterError
        Fewer frames than Gaussians.
    """
    n_classes = preset.required_classes()
    if n_classes > len(features):
        raise ParameterError(f"{len(features)} frames cannot be told into {n_classes} classes")
    with threadpool_limits(1):  # sums, and so results, would change with the number of cores
        reduced = PCA(preset.variance_kept, svd_solver="full").fit_transform(features)
        labels = GaussianMixture(n_classes, random_state=preset.seed).fit_predict(reduced)
    cuts = np.flatnonzero(np.diff(labels)) + 1
    return Segments(cuts, labels[np.append(0, cuts)].astype(np.int64), len(features))


def _cut_and_start_anew(features: Floats, find: Callable[..., int | None]) -> Segments:
    """Cut repeatedly by a rule that finds the first cut in given frames, or None.

    Variances below the rounding error of the whole count as that.
    """
    floor = max(np.finfo(float).eps * float(features.var(axis=0).sum()), np.finfo(float).tiny)
    starts = [0]
    with threadpool_limits(1):  # many small matrices
        while (cut := find(features[starts[-1] :], floor=floor)) is not None:
            starts.append(starts[-1] + cut)
    return unclustered(starts[1:], len(features))


def _error_jump(features: Floats, preset: PcaPreset, *, floor: float) -> int | None:
    """Return the first frame at which the projection error jumps, or None."""
    first, lag = max(1, preset.frames(preset.first)), max(1, preset.frames(preset.rise_span))
    if len(features) < first + 2 * lag:
        return None
    errors: list[Floats] = []
    kept = 0
    for _, _, scatters in _list_scatters(features, np.arange(first, len(features) + 1)):
        variances = np.linalg.eigvalsh(scatters)[:, ::-1]
        kept = kept or _count_dimensions(variances[0], preset.variance_kept)
        errors.append(variances[:, kept:].sum(axis=1))
    error = np.concatenate(errors)
    rise = error[lag:] - error[:-lag]
    count = np.arange(1, len(rise))
    mean = np.cumsum(rise)[:-1] / count
    spread = np.sqrt(np.maximum(np.cumsum(rise**2)[:-1] / count - mean**2, 0))
    bound = mean + preset.deviations * spread + floor * len(features)
    jumps = np.flatnonzero(rise[1:] > bound) + 1
    jumps = jumps[jumps >= lag]
    return first + lag + int(jumps[0]) if jumps.size else None


def _distance_peak(features: Floats, preset: PpcaPreset, *, floor: float) -> int | None:
    """Return the first peak of the distance H of the next frames, or None."""
    ahead, growth = max(2, preset.frames(preset.ahead)), max(1, preset.frames(preset.growth_step))
    counts = np.arange(ahead, len(features) - ahead + 1, growth)
    if len(counts) < 3:
        return None
    distance = np.array(
        [
            _mahalanobis(
                features[count : count + ahead] - mean,
                scatter / (count - 1),
                floor,
                preset.variance_kept,
            )
            for batch in _list_scatters(features, counts)
            for count, mean, scatter in zip(*batch, strict=True)
        ]
    )
    threshold = preset.rise * np.ptp(distance)
    valley = np.minimum.accumulate(distance)
    before, here, after = distance[:-2], distance[1:-1], distance[2:]
    peaks = (here > before) & (here >= after) & (here - valley[:-2] >= threshold)
    return int(counts[1:-1][peaks][0]) if peaks.any() else None


def _mahalanobis(deviations: Floats, covariance: Floats, floor: float, share: float) -> float:
    """Return the mean squared distance under the covariance of probabilistic PCA."""
    variances, axes = np.linalg.eigh(covariance)
    variances, axes = np.maximum(variances[::-1], floor), axes[:, ::-1]
    kept = min(_count_dimensions(variances, share), len(variances) - 1)
    inside = deviations @ axes[:, :kept]
    outside = (deviations**2).sum(axis=1) - (inside**2).sum(axis=1)
    distances = (inside**2 / variances[:kept]).sum(axis=1) + outside / variances[kept:].mean()
    return float(distances.mean())


def _list_scatters(features: Floats, counts: Ints) -> Iterator[tuple[Ints, Floats, Floats]]:
    """Yield rising numbers of first frames, their means and scatters, a batch at a time.

    A scatter (dims, dims) is the sum of the outer products of deviations from the mean.
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


def _count_dimensions(variances: Floats, share: float) -> int:
    """Return how many of the largest variances, which come first, exceed this share of all."""
    total = np.cumsum(np.maximum(variances, 0))
    return int(np.searchsorted(total, share * total[-1], side="right")) + 1
