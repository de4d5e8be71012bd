"""Compute the self-similarity matrix of a recording at several zoom levels.

A cell of level 0 is the similarity of two samples: ``exp(-d²)`` of the distance of
their features, from 0 (nothing in common, or a gap) to 1. Features are stacked from
0.2 s before to 0.2 s after each sample. For a motion they are the end effectors in the
body's own frame; a distance of 1 is a fifth of the body size. For a motion without a
known body they are distances between points, for signals the standardised channels.

A cell of level L compares two spans of 2^L samples by mean and deviation of each
feature (the Fréchet distance of normal distributions with independent features). So
at low zoom an activity is a uniform square, independent of the phase of its samples.

The matrix is not stored: cells are computed on demand from the features of two spans.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Float32s, Floats
from kineme.errors import MotionError, ParameterError
from kineme.features.distances import SIZE, compute_distance_features
from kineme.features.effectors import Names, end_effectors, measure_body_size
from kineme.features.pose import pose_features
from kineme.recordings import Motion, Signals
from kineme.recordings.operations import resample

COARSEST = 256
"""Largest number of cells per side of the coarsest level."""
RATE = 10.0
"""Cells per second, which is fine enough for a screen."""
MAX_CELLS = 36_000
"""Largest number of cells per side: one hour. Longer recordings have fewer cells per second."""
OFFSETS = (-0.2, -0.1, 0.0, 0.1, 0.2)
"""Time offsets of stacked samples, s."""
BODY_SCALE = 0.2
"""Unit of distances in body sizes, chosen for a good contrast of CMU's subject 86."""
SIGNAL_SCALE = 0.5
"""Unit of distances as a share of the distance of two random samples."""
MAX_CHANNELS = 16
"""Largest number of dimensions of signals; of more, principal components are used."""


@dataclass(frozen=True, eq=False)
class SimilarityMatrix:
    """Self-similarity of a recording: ``levels[L]`` holds the features of the cells of level L.

    They are (cells, dims), in units of distance, and nan in gaps. Level 0 has ``fps`` cells per
    second.
    """

    fps: float
    levels: tuple[Float32s, ...]

    def cells(self, level: int, rows: slice, columns: slice) -> Float32s:
        """Return similarities of some cells of a level, (rows, columns) from 0 to 1; 0 in gaps."""
        down, across = self.levels[level][rows], self.levels[level][columns]
        # All squared distances, |a|² + |b|² - 2 a·b, by one matrix product.
        squared = (down**2).sum(axis=1)[:, None] + (across**2).sum(axis=1) - 2 * (down @ across.T)
        # Distances to gaps are nan: similarity 0.
        return np.asarray(np.nan_to_num(np.exp(-np.maximum(squared, 0)), nan=0.0), np.float32)


def compare_frames(
    recording: Motion | Signals, *, effectors: Names | None = None
) -> SimilarityMatrix:
    """Compute the matrix of a recording; gaps have a similarity of 0 to everything."""
    if isinstance(recording, Motion):
        return compare_frames_of_motion(recording, effectors=effectors)
    values = np.array(recording.values)
    for start, stop in recording.gaps:
        values[start:stop] = np.nan
    return compare_frames_of_signal(values, recording.fps)


def compare_frames_of_motion(motion: Motion, *, effectors: Names | None = None) -> SimilarityMatrix:
    """Compute the matrix of a motion; without a known body by distances between points.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording
    >>> matrix = compare_frames_of_motion(kineme.read(bundled_recording()))
    >>> [len(level) for level in matrix.levels]
    [483, 242]
    """
    try:
        ends = end_effectors(motion, names=effectors)
        values = pose_features(motion, effectors=ends)
        values /= BODY_SCALE * measure_body_size(motion, ends)
    except MotionError:
        motion = resample(motion, min(motion.fps, 3 * RATE))  # distances are many
        values = _scale_distance_features(motion)
    for start, stop in motion.gaps:
        values[start:stop] = np.nan
    return _stack_levels(values, motion.fps, motion.duration)


def compare_frames_of_signal(values: ArrayLike, fps: float) -> SimilarityMatrix:
    """Compute the matrix of a signal (frames, channels) or (frames,), with nan in gaps.

    Raise ParameterError if it is not a signal, or if the frame rate is not positive.

    Examples
    --------
    >>> matrix = compare_frames_of_signal([[0.0], [1.0], [0.0], [1.0]], fps=2.0)
    >>> matrix.cells(0, slice(0, 2), slice(2, 4)).shape
    (2, 2)
    """
    try:
        signal = np.asarray(values, np.float64)
    except (ValueError, TypeError):
        raise ParameterError(
            "a signal must be frames x channels of numbers: remove columns of text"
        ) from None
    signal = signal[:, None] if signal.ndim == 1 else signal
    if signal.ndim != 2 or 0 in signal.shape:
        raise ParameterError(f"a signal must be frames x channels, not of shape {signal.shape}")
    if not (np.isfinite(fps) and fps > 0):
        raise ParameterError(f"the frame rate must be a positive number, not {fps}")
    averaged = max(1, int(fps / (2 * RATE)))  # frames whose mean is compared: 0.05 s
    # Means over short spans; the last one may be shorter.
    starts = np.arange(0, len(signal), averaged)
    lengths = np.diff(starts, append=len(signal))
    means = np.add.reduceat(signal, starts, axis=0) / lengths[:, None]
    return _stack_levels(_standardise(means), fps / averaged, len(signal) / fps)


def _scale_distance_features(motion: Motion) -> Floats:
    """Return distance features for a motion without a body, in the matrix's unit of distance.

    Frames in gaps are 0; the caller sets them to nan.
    """
    visible = np.ones(motion.n_frames, np.bool_)
    for start, stop in motion.gaps:
        visible[start:stop] = False
    if motion.skeleton.n_joints < 2 or not visible.any():
        return np.zeros((motion.n_frames, 1))
    # Leave out frames in gaps, which would distort the scale.
    features, _ = compute_distance_features(motion.positions[visible])
    values = np.zeros((motion.n_frames, features.shape[1]))
    values[visible] = features / (BODY_SCALE * SIZE)
    return values


def _standardise(values: Floats) -> Floats:
    """Standardise channels; reduce many channels to their principal components."""
    visible = np.asarray(np.isfinite(values).all(axis=1))
    if not visible.any():
        return np.full((len(values), 1), np.nan)
    # Centred over visible rows; rows in gaps become nan.
    out = np.where(visible[:, None], values, np.nan) - values[visible].mean(axis=0)
    deviation = out[visible].std(axis=0)
    out = out[:, deviation > 0] / deviation[deviation > 0]
    if out.shape[1] == 0:
        return np.where(visible[:, None], 0.0, np.nan)
    if out.shape[1] > MAX_CHANNELS:
        from scipy.linalg import eigh

        n = out.shape[1]
        # The last eigenvectors have the largest eigenvalues.
        axes = eigh(np.cov(out[visible].T), subset_by_index=(n - MAX_CHANNELS, n - 1))[1]
        out = out @ axes
    # Twice the summed variance is the mean squared distance of two random samples.
    return np.asarray(out / (SIGNAL_SCALE * np.sqrt(2 * out[visible].var(axis=0).sum())))


def _stack_levels(values: Floats, fps: float, seconds: float) -> SimilarityMatrix:
    """Compute all levels of the matrix from features (samples, dims).

    Features are in units of distance, and nan in gaps. ``seconds`` is the length of the recording.
    """
    rate = min(RATE, fps, MAX_CELLS / seconds)
    # Middles of the cells; 1e-6 drops a tiny last cell that rounding may add.
    middles = np.asarray((np.arange(ceil(seconds * rate - 1e-6)) + 0.5) / rate, np.float64)
    stacked = np.concatenate(
        [_sample_at(values, middles + offset, fps) for offset in OFFSETS], axis=1
    )
    # Stacking must not make distances larger.
    stacked /= np.sqrt(len(OFFSETS))
    # A cell is visible only if all of its stacked samples are.
    visible = np.asarray(np.isfinite(stacked).all(axis=1))
    # Sums instead of means, so that cells can be merged by addition.
    total = np.where(visible[:, None], stacked, 0.0)
    squares, counts = total**2, visible.astype(float)[:, None]
    levels = [np.where(visible[:, None], total, np.nan).astype(np.float32)]
    while len(total) > COARSEST:
        # Sums of pairs of neighbouring rows; an odd last row stays alone.
        pairs = np.arange(0, len(total), 2)
        total, squares, counts = (np.add.reduceat(s, pairs) for s in (total, squares, counts))
        # 0 / 0 in gaps.
        with np.errstate(invalid="ignore"):
            mean = total / counts
            # Variance: mean of squares less squared mean, which rounding can make negative.
            deviation = np.sqrt(np.maximum(squares / counts - mean**2, 0))
        # The squared distance of means and deviations is the squared Fréchet distance.
        levels.append(np.concatenate([mean, deviation], axis=1).astype(np.float32))
    return SimilarityMatrix(rate, tuple(levels))


def _sample_at(values: Floats, times: Floats, fps: float) -> Floats:
    """Interpolate values at times in seconds; frame i is at (i + 0.5) / fps."""
    positions = np.clip(times * fps - 0.5, 0, len(values) - 1)
    before = np.floor(positions).astype(np.intp)
    after = np.minimum(before + 1, len(values) - 1)
    share = (positions - before)[:, None]
    return np.asarray((1 - share) * values[before] + share * values[after])
