"""The same movement in other guises, and how far two answers to it are the same."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from _joined import clusters_of
from kineme._util.arrays import bridge_line
from kineme.features.channels import resample_channels
from kineme.features.filters import filter_low
from kineme.formats.keypoints.poses import CUTOFF
from kineme.recordings import Motion, Signals
from kineme.recordings.operations import resample, scale, turn
from kineme.segments.segmentation import Segmentation

RATES = (25.0, 30.0, 60.0, 120.0)
CUT_S = 2.0
NOISE_M = 0.002
VIDEO_FPS, VIEW, DEPTH = 30.0, np.deg2rad(30), 0.5
"""Of a camera: frames a second, the angle from which it looks, and the share of depth it keeps."""
JITTER, ZOOM, ZOOM_S = 0.02, 0.05, 1.0
"""Of poses from video: noise as a share of the height; change of scale, and its seconds."""
HIDDEN_S, EVERY_S = 0.3, 10.0
"""Seconds for which a joint is not seen, and in which that happens once to each."""
NOISE_SHARE = 0.02
"""Of the deviation of each channel."""
COMPARED = 30.0
"""Moments a second at which two answers are compared."""


class Guise(NamedTuple):
    """A recording in another guise, where it begins in the first, and how much faster it is."""

    name: str
    recording: Motion | Signals
    start_s: float = 0.0
    speed: float = 1.0


def guises(recording: Motion | Signals) -> Iterator[Guise]:
    """The recording at other rates and speeds, cut, with noise; bodies turned and scaled, too."""
    noise = np.random.default_rng(0)
    for rate in RATES:
        if abs(rate - recording.fps) > 1:
            yield Guise(f"{rate:g} Hz", _at(recording, rate))
    late = round(CUT_S * recording.fps)
    if recording.n_frames > 4 * late:
        yield Guise("2 s cut off", recording[late:], start_s=CUT_S)
    for speed in (0.8, 1.25):
        yield Guise(
            f"{speed:g} of the speed", replace(recording, fps=recording.fps * speed), 0.0, speed
        )
    if isinstance(recording, Signals):
        spread = NOISE_SHARE * recording.values.std(axis=0)
        values = recording.values + noise.normal(0, 1, recording.values.shape) * spread
        yield Guise("noise", replace(recording, values=values))
        return
    places = recording.positions + noise.normal(0, NOISE_M, recording.positions.shape)
    yield Guise("noise", Motion(recording.skeleton, places, recording.fps, gaps=recording.gaps))
    yield Guise("points alone", Motion(recording.skeleton, recording.positions, recording.fps))
    yield Guise("turned", turn(recording, 2.0))
    yield Guise("0.9 of the size", scale(recording, 0.9))
    yield Guise("1.1 of the size", scale(recording, 1.1))
    yield Guise("as a video", _film(recording, noise))


def _film(motion: Motion, noise: np.random.Generator) -> Motion:
    """Return the motion as poses of a video have it, after reading has filled and smoothed them."""
    from scipy.ndimage import gaussian_filter1d

    seen = turn(resample(motion, VIDEO_FPS), VIEW)
    root = seen.skeleton.parents.index(-1)
    places = (seen.positions - seen.positions[:, [root]]) * (1, 1, DEPTH)
    n, joints, _ = places.shape
    height = float(np.median(np.ptp(places[..., 1], axis=1)))
    drift = gaussian_filter1d(noise.normal(0, 1, n), ZOOM_S * VIDEO_FPS)
    places *= (1 + ZOOM * drift / np.abs(drift).max())[:, None, None]
    places += noise.normal(0, JITTER * height, places.shape)
    for joint in range(joints):
        for start in np.flatnonzero(noise.random(n) < 1 / (EVERY_S * VIDEO_FPS)).tolist():
            hidden = np.zeros(n, np.bool_)
            hidden[start : start + round(HIDDEN_S * VIDEO_FPS)] = True
            for axis in range(3):
                bridge_line(places[:, joint, axis], hidden)
    flat = filter_low(places.reshape(n, -1), VIDEO_FPS, CUTOFF, round(VIDEO_FPS))
    return Motion(seen.skeleton, flat.reshape(places.shape), VIDEO_FPS, gaps=seen.gaps)


def _at(recording: Motion | Signals, rate: float) -> Motion | Signals:
    if isinstance(recording, Motion):
        return resample(recording, rate)
    return Signals(
        resample_channels(recording.values, recording.fps, rate, smoothing=0.0),
        rate,
        recording.names,
    )


def agreement(here: Segmentation, there: Segmentation, guise: Guise) -> float:
    """The share of moments in the same cluster, each of the one standing for one of the other."""
    length = there.n_frames / there.fps * guise.speed
    times = np.arange(0, length, 1 / COMPARED)
    own = _clusters_at(here, times + guise.start_s)
    other = _clusters_at(there, times / guise.speed)
    _, a = np.unique(own, return_inverse=True)
    _, b = np.unique(other, return_inverse=True)
    together = np.zeros((a.max() + 1, b.max() + 1))
    np.add.at(together, (a, b), 1)
    return float(together[linear_sum_assignment(-together)].sum() / len(times))


def _clusters_at(found: Segmentation, times: NDArray[np.float64]) -> NDArray[np.int64]:
    frames = np.clip((times * found.fps).astype(np.int64), 0, found.n_frames - 1)
    return clusters_of(found)[frames]
