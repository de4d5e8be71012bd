"""Views: the same statistics of channels in several scales, as no one scale fits all sensors.

A scale has two choices. What channels have in common is movement where sensors are on both legs,
and only position where channels are positions of joints: it is left in, or reduced. And some
sensors separate activities by what varies most, others by what changes seldom: statistics are
divided by one or the other. The first and the last view are opposite in both. The last one is taken
if it agrees with all views more than the first by a margin (`choose_view`). Of few channels, views
of half of them are among these, as an answer that depends on one channel is doubtful.

Where channels are positions of joints, their velocities are added: sitting down and standing up
have the same positions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme.features.channels import Mixture, Reduction, compute_statistics

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Labels = NDArray[np.int64]

DIGITS = 9
"""Agreements are equal if so many decimals are: rounding decides nothing."""

STILL = 0.05
"""Least restlessness of a statistic, as a share of that of all of them."""
VELOCITY_OVER = 0.6
"""Seconds before and after a sample, between which velocities are taken."""
TINY = 1e-9
"""Deviations below it are rounding."""


@dataclass(frozen=True, eq=False)
class Views:
    """All views of a recording, `preset.rate` times a second.

    Attributes
    ----------
    views : list of (samples, dims) array
        All channels, in each of the scales that the preset names.
    halves : list of (samples, dims) array
        Half of the channels, in the first and in the last of these.
    """

    views: list[NDArray[np.float32]]
    halves: list[NDArray[np.float32]]


class Scale(NamedTuple):
    """Constants of one view; see `KinemeConstants`."""

    shared: float
    weight: float
    restless_over: float


def compute_views(
    channels: Floats,
    preset: KinemeConstants,
    *,
    joints: bool = False,
) -> Views:
    """Return the statistics of the channels in each of the scales that the preset names.

    Parameters
    ----------
    channels : (frames, channels) array
        At the working rate of the preset.
    preset : KinemeConstants
    joints : bool
        Whether channels are of the positions of joints.
    """
    centred = channels - channels.mean(axis=0)
    scaled = np.asarray(centred / _measure_deviations(centred), np.float64)
    scales = [*map(Scale, preset.shared, preset.weights, preset.restless_over)]
    requested = [(np.arange(scaled.shape[1]), scale) for scale in scales]
    if len(scales) > 1 and preset.half_views:
        halves = split_by_speed(scaled)
        # An answer that half of the channels gives as well depends on no single channel.
        requested += [(half, scale) for half in halves for scale in (scales[0], scales[-1])]
    found = _make_scales(scaled, requested, preset, preset.velocity_weight if joints else 0.0)
    return Views(found[: len(scales)], found[len(scales) :])


def append_velocities(
    view: NDArray[np.float32], channels: int, steps: int, weight: float
) -> NDArray[np.float32]:
    """Return view and, `weight` times, how its means change from `steps` before to `steps` after.

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
    """Return the half of the channels that changes less from frame to frame, and the other half.

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


def _make_scales(
    scaled: Floats,
    requested: Sequence[tuple[Ints, Scale]],
    preset: KinemeConstants,
    velocity_weight: float,
) -> list[NDArray[np.float32]]:
    """A view for each request of channels and a scale, with velocities if they have a weight."""
    mixtures = {
        # Scales that reduce the same variance share one mixture, which takes most of the time.
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
    found = []
    for channels, scale in requested:
        values = statistics[channels.tobytes(), scale.shared]
        view = (
            divide_by_change(values, round(preset.samples(scale.restless_over)), scale.weight)
            if scale.restless_over
            else divide_by_deviation(values, len(channels), scale.weight)
        )
        steps = max(1, round(preset.samples(VELOCITY_OVER)))
        weight = velocity_weight
        found.append(append_velocities(view, len(channels), steps, weight) if weight else view)
    return found


def reduce_shared(scaled: Floats, most: float) -> Reduction | None:
    """Return what reduces the variance that channels share; each keeps a deviation of 1.

    None where nothing is reduced. Memory grows with the smaller side of the array, squared.

    Parameters
    ----------
    scaled : (frames, channels) array
        With a mean of 0 and a deviation of 1, or 0 where nothing changes.
    most : float
        Largest variance in any direction of the space of channels.
    """
    frames, channels = scaled.shape
    if most >= channels:  # they cannot share more
        return None
    if channels <= frames:
        variances, directions = np.linalg.eigh(scaled.T @ scaled / frames)
        large = variances > most
        variances, directions = variances[large], directions[:, large]
    else:  # the frames' Gram matrix has the same eigenvalues, and is smaller
        variances, weights = np.linalg.eigh(scaled @ scaled.T / frames)
        large = variances > most
        variances = variances[large]
        # Left singular vectors times the data give the right ones.
        directions = scaled.T @ (weights[:, large] / np.sqrt(frames * variances))
    factors = np.sqrt(most / variances)
    # Variance of each channel, less what its large directions lose.
    left = (scaled**2).mean(axis=0) - directions**2 @ (variances - most)
    left = np.sqrt(np.maximum(left, 0.0))
    return Reduction(directions, factors, 1 / np.where(left > TINY, left, 1.0))


def divide_by_deviation(statistics: Floats, channels: int, weight: float) -> NDArray[np.float32]:
    """Means, and each band, divided by their whole deviation to the power `weight`.

    Parameters
    ----------
    statistics : (samples, groups * channels) array
    channels : int
    weight : float
        1 gives each group the same weight, 0 leaves them as they are.
    """
    centred = statistics - statistics.mean(axis=0)
    # Columns are grouped: means of all channels, then energies of all in each band.
    groups = centred.reshape(len(centred), -1, channels)
    deviations = np.sqrt((groups**2).mean(axis=(0, 2), keepdims=True))
    scaled = groups / np.where(deviations > TINY, deviations, 1.0) ** weight
    return np.ascontiguousarray(scaled.reshape(centred.shape), np.float32)


def divide_by_change(statistics: Floats, steps: int, weight: float) -> NDArray[np.float32]:
    """Return each statistic divided by its mean change over so many samples to the power `weight`.

    Examples
    --------
    >>> restless = np.column_stack([np.arange(8) % 2, np.arange(8) // 4])
    >>> divide_by_change(restless.astype(float), 1, 1.0).std(axis=0).round(2).tolist()
    [0.5, 3.5]
    """
    centred = statistics - statistics.mean(axis=0)
    # Of a short recording a third is enough to see a change.
    steps = max(1, min(steps, len(centred) // 3))
    changes = np.abs(centred[steps:] - centred[:-steps])
    restless = changes.mean(axis=0) if len(changes) else np.zeros(centred.shape[1])
    # A statistic that never changes would grow without bounds.
    least = STILL * float(np.sqrt((restless**2).mean()))
    if least < TINY:
        return np.ascontiguousarray(centred, np.float32)
    return np.ascontiguousarray(centred / np.maximum(restless, least) ** weight, np.float32)


def _measure_deviations(centred: Floats) -> Floats:
    """Return the standard deviation of each column; 1 where nothing changes."""
    deviations: Floats = np.sqrt((centred**2).mean(axis=0))
    return np.where(deviations > TINY, deviations, 1.0)


def choose_view(
    answers: Sequence[Labels], others: Sequence[Labels] = (), *, margin: float = 0.0
) -> int:
    """Return 0 for the first answer or the place of the last: the one that agrees more with all.

    Parameters
    ----------
    answers : sequence of (samples,) array
        Per answer the cluster of each sample.
    others : sequence of (samples,) array
        Answers that count, but cannot be taken.
    margin : float
        Mutual information, in the mean over all, by which the last must agree more to be taken.

    Examples
    --------
    >>> first, other, last = np.array([[0, 1, 0, 1, 0], [0, 0, 0, 1, 1], [0, 0, 1, 1, 1]])
    >>> choose_view([first, other, last]), choose_view([first, other, last], margin=0.5)
    (2, 0)
    """
    voters = [*answers, *others]
    first, last = (
        sum(measure_mutual_information(answers[one], voter) for voter in voters) for one in (0, -1)
    )
    needed = first + margin * len(voters)
    return len(answers) - 1 if round(last - needed, DIGITS) > 0 else 0


def measure_mutual_information(first: Labels, second: Labels) -> float:
    """Return mutual information of two clusterings of the same samples, over their mean entropy.

    Examples
    --------
    >>> measure_mutual_information(np.array([0, 0, 1, 1]), np.array([5, 5, 3, 3]))
    1.0
    >>> measure_mutual_information(np.array([0, 0, 1, 1]), np.array([0, 1, 0, 1]))
    0.0
    """
    # Two labels as one number, so that one count gives the table of both.
    width = int(second.max()) + 1
    together = np.bincount(first * width + second, minlength=(int(first.max()) + 1) * width)
    table = together.reshape(-1, width)
    one, other = _measure_entropy(table.sum(axis=1)), _measure_entropy(table.sum(axis=0))
    if one + other == 0:
        return 1.0
    return max(0.0, 2 * (1 - _measure_entropy(table.ravel()) / (one + other)))


def _measure_entropy(counts: Labels) -> float:
    """Of the shares that counts are."""
    shares = counts[counts > 0] / counts.sum()
    return float(-(shares * np.log(shares)).sum()) + 0.0
