"""Views: the same statistics of channels in several scales, as no single scale fits all sensors.

A scale makes two choices. First, the variance that channels share is kept or reduced: for sensors
on both legs it is movement, for positions of joints it is only the position of the body. Second,
statistics are divided by their deviation or by their change over time: some sensors separate
activities by what varies most, others by what changes seldom. The first and the last view differ in
both. The last view is chosen if it agrees with all views by a margin more than the first does
(`choose_view`). For signals, views of half of the channels also vote, because a result that depends
on a single channel is unreliable.

If channels are positions of joints, their velocities are added, because sitting down and standing
up have the same positions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme.features.channels import Mixture, Reduction, choose_frames, compute_statistics

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Labels = NDArray[np.int64]

DIGITS = 9
"""Number of decimals of agreements that are compared, so that rounding errors decide nothing."""

MIN_CHANGE = 0.05
"""Smallest change of a statistic, as a share of the root mean square of all changes."""
VELOCITY_WINDOW = 0.6
"""Seconds before and after a sample from which its velocity is computed."""
TINY = 1e-9
"""Deviation below which a channel is constant."""


@dataclass(frozen=True, eq=False)
class Views:
    """All views of a recording, each (samples, dims) at `preset.rate`."""

    views: list[NDArray[np.float32]]
    """All channels, in each scale of the preset."""
    halves: list[NDArray[np.float32]]
    """Each half of the channels, in the first and in the last scale."""


class Scale(NamedTuple):
    """Constants of one view; see `KinemeConstants`."""

    shared: float
    weight: float
    change_window: float


def compute_views(
    channels: Floats,
    preset: KinemeConstants,
    *,
    joints: bool = False,
) -> Views:
    """Compute the statistics of channels (frames, channels) in each scale of the preset.

    Channels are at the working rate. ``joints`` tells whether they are computed from positions of
    joints.
    """
    centred = channels - channels.mean(axis=0)
    deviations = np.sqrt((centred**2).mean(axis=0))
    scaled = np.asarray(centred / np.where(deviations > TINY, deviations, 1.0), np.float64)
    scales = [*map(Scale, preset.shared, preset.weights, preset.restless_over)]
    requested = [(np.arange(scaled.shape[1]), scale) for scale in scales]
    if len(scales) > 1 and preset.half_views:
        halves = split_by_speed(scaled)
        # A result that half of the channels confirm does not depend on a single channel.
        requested += [(half, scale) for half in halves for scale in (scales[0], scales[-1])]
    views = _make_views(scaled, requested, preset, preset.velocity_weight if joints else 0.0)
    return Views(views[: len(scales)], views[len(scales) :])


def compute_first_view(
    channels: Floats, preset: KinemeConstants, *, joints: bool = False
) -> tuple[NDArray[np.float32], Ints]:
    """Return the first view of channels, and the frame of each of its samples."""
    preset = preset.select_view(0)
    frames = choose_frames(len(channels), preset.working_fps, preset.rate)
    return compute_views(channels, preset, joints=joints).views[0], frames


def append_velocities(
    view: NDArray[np.float32], channels: int, steps: int, weight: float
) -> NDArray[np.float32]:
    """Append velocities to a view: `weight` times the change of its means over 2 `steps`.

    Examples
    --------
    >>> append_velocities(np.float32([[0], [1], [5], [5]]), 1, 1, 0.5)[:, 1].tolist()
    [0.5, 2.5, 2.0, 0.0]
    """
    means, at = view[:, :channels], np.arange(len(view))
    after, before = np.minimum(at + steps, len(view) - 1), np.maximum(at - steps, 0)
    velocities = weight * (means[after] - means[before])
    return np.ascontiguousarray(np.column_stack([view, velocities]), np.float32)


def split_by_speed(scaled: Floats) -> list[Ints]:
    """Return the slower half of the channels, by mean change per frame, and the faster half.

    Examples
    --------
    >>> frames = np.arange(100)[:, None]
    >>> [half.tolist() for half in split_by_speed(np.sin(frames * [0.1, 2, 0.2, 1]))]
    [[0, 2], [1, 3]]
    """
    if scaled.shape[1] < 2:
        return []
    order = np.argsort(np.abs(np.diff(scaled, axis=0)).sum(axis=0), kind="stable")
    middle = (len(order) + 1) // 2
    return [np.sort(order[:middle]), np.sort(order[middle:])]


def _make_views(
    scaled: Floats,
    requested: Sequence[tuple[Ints, Scale]],
    preset: KinemeConstants,
    velocity_weight: float,
) -> list[NDArray[np.float32]]:
    """Return a view for each request of channels and scale, with velocities if weighted."""
    mixtures = {
        # Scales with the same reduction share one mixture, which takes most of the run time.
        (channels.tobytes(), scale.shared): Mixture(
            channels, reduce_shared(scaled[:, channels], scale.shared)
        )
        for channels, scale in requested
    }
    mixed = compute_statistics(
        scaled,
        list(mixtures.values()),
        preset.working_fps,
        rate=preset.rate,
        window=preset.averaging,
        bands=preset.bands,
    )
    statistics = dict(zip(mixtures, mixed, strict=True))
    views = []
    for channels, scale in requested:
        values = statistics[channels.tobytes(), scale.shared]
        view = (
            divide_by_change(values, round(preset.samples(scale.change_window)), scale.weight)
            if scale.change_window
            else divide_by_deviation(values, len(channels), scale.weight)
        )
        if velocity_weight:
            steps = max(1, round(preset.samples(VELOCITY_WINDOW)))
            view = append_velocities(view, len(channels), steps, velocity_weight)
        views.append(view)
    return views


def reduce_shared(scaled: Floats, most: float) -> Reduction | None:
    """Return a map that reduces the variance that channels share, and keeps deviations of 1.

    Return None if nothing is reduced. ``scaled`` (frames, channels) has a mean of 0 and a deviation
    of 1, or 0 for constant channels. ``most`` is the largest variance in any direction of the space
    of channels. Memory grows with the square of the smaller side of the array.
    """
    frames, channels = scaled.shape
    if most >= channels:  # the total variance is `channels`
        return None
    if channels <= frames:
        variances, directions = np.linalg.eigh(scaled.T @ scaled / frames)
        large = variances > most
        variances, directions = variances[large], directions[:, large]
    else:  # the Gram matrix of frames is smaller and has the same eigenvalues
        variances, weights = np.linalg.eigh(scaled @ scaled.T / frames)
        large = variances > most
        variances = variances[large]
        # Left singular vectors times the data give the right singular vectors.
        directions = scaled.T @ (weights[:, large] / np.sqrt(frames * variances))
    factors = np.sqrt(most / variances)
    # Remaining variance of each channel, then its deviation.
    remaining = (scaled**2).mean(axis=0) - directions**2 @ (variances - most)
    remaining = np.sqrt(np.maximum(remaining, 0.0))
    return Reduction(directions, factors, 1 / np.where(remaining > TINY, remaining, 1.0))


def divide_by_deviation(statistics: Floats, channels: int, weight: float) -> NDArray[np.float32]:
    """Divide means, and each band, by their overall deviation to the power `weight`.

    Statistics are (samples, groups * channels). A weight of 1 gives each group the same weight, 0
    does not change them.
    """
    centred = statistics - statistics.mean(axis=0)
    # Columns are grouped: means of all channels, then energies of all in each band.
    groups = centred.reshape(len(centred), -1, channels)
    deviations = np.sqrt((groups**2).mean(axis=(0, 2), keepdims=True))
    scaled = groups / np.where(deviations > TINY, deviations, 1.0) ** weight
    return np.ascontiguousarray(scaled.reshape(centred.shape), np.float32)


def divide_by_change(statistics: Floats, steps: int, weight: float) -> NDArray[np.float32]:
    """Divide each statistic by its mean change over `steps` samples to the power `weight`.

    Examples
    --------
    >>> restless = np.column_stack([np.arange(8) % 2, np.arange(8) // 4])
    >>> divide_by_change(restless.astype(float), 1, 1.0).std(axis=0).round(2).tolist()
    [0.5, 3.5]
    """
    centred = statistics - statistics.mean(axis=0)
    # At most a third of a short recording.
    steps = max(1, min(steps, len(centred) // 3))
    changes = np.abs(centred[steps:] - centred[:-steps])
    mean_change = changes.mean(axis=0) if len(changes) else np.zeros(centred.shape[1])
    # A lower limit, or statistics that hardly change would grow without bounds.
    least = MIN_CHANGE * float(np.sqrt((mean_change**2).mean()))
    if least < TINY:
        return np.ascontiguousarray(centred, np.float32)
    return np.ascontiguousarray(centred / np.maximum(mean_change, least) ** weight, np.float32)


def choose_view(
    answers: Sequence[Labels], others: Sequence[Labels] = (), *, margin: float = 0.0
) -> int:
    """Return the index of the first or the last answer: the one that agrees more with all.

    An answer holds the cluster of each sample in one view. ``others`` vote, but cannot be chosen.
    The last must agree more by a mean mutual information of ``margin`` to be chosen.

    Examples
    --------
    >>> first, other, last = np.array([[0, 1, 0, 1, 0], [0, 0, 0, 1, 1], [0, 0, 1, 1, 1]])
    >>> choose_view([first, other, last]), choose_view([first, other, last], margin=0.5)
    (2, 0)
    """
    voters = [*answers, *others]
    first, last = (
        sum(measure_mutual_information(answers[index], voter) for voter in voters)
        for index in (0, -1)
    )
    needed = first + margin * len(voters)
    return len(answers) - 1 if round(last - needed, DIGITS) > 0 else 0


def measure_mutual_information(first: Labels, second: Labels) -> float:
    """Return the mutual information of two clusterings, divided by their mean entropy.

    It is 1 if both have one cluster only.

    Examples
    --------
    >>> measure_mutual_information(np.array([0, 0, 1, 1]), np.array([5, 5, 3, 3]))
    1.0
    >>> measure_mutual_information(np.array([0, 0, 1, 1]), np.array([0, 1, 0, 1]))
    0.0
    """
    # Contingency table, by counting pairs of labels as one number.
    width = int(second.max()) + 1
    counts = np.bincount(first * width + second, minlength=(int(first.max()) + 1) * width)
    table = counts.reshape(-1, width)
    # Sum of the entropies of both clusterings; 0 if each has only one cluster.
    total = _measure_entropy(table.sum(axis=1)) + _measure_entropy(table.sum(axis=0))
    if total == 0:
        return 1.0
    return max(0.0, 2 * (1 - _measure_entropy(table.ravel()) / total))


def _measure_entropy(counts: Labels) -> float:
    """Return the entropy of the distribution of counts, in nats."""
    shares = counts[counts > 0] / counts.sum()
    return float(-(shares * np.log(shares)).sum()) + 0.0
