"""Make variants of a recording and measure how far their segmentations agree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import bridge_line
from kineme.evaluation import Comparison, one_to_one_accuracy
from kineme.features.channels import filter_low, resample_channels
from kineme.formats.keypoints.poses import CUTOFF
from kineme.recordings import Motion, Signals
from kineme.recordings.operations import resample, scale, turn
from kineme.segments.segmentation import Segmentation

RATES = (25.0, 30.0, 60.0, 120.0)
CUT_S = 2.0
NOISE_M = 0.002
VIDEO_FPS, VIEW, DEPTH = 30.0, np.deg2rad(30), 0.5
"""Frames per second of a video, angle of the camera in radians, share of depth that is kept."""
JITTER, ZOOM, ZOOM_S = 0.02, 0.05, 1.0
"""Noise as a share of the body's height; largest change of scale, and how fast it changes in s."""
HIDDEN_S, EVERY_S = 0.3, 10.0
"""Seconds for which a joint is hidden, and mean seconds between two such times."""
NOISE_SHARE = 0.02
"""Standard deviation of the noise, as a share of that of each channel."""
COMPARED = 30.0
"""Samples per second at which two segmentations are compared."""


class Variant(NamedTuple):
    """A changed recording, where it starts in the original, and its relative speed."""

    name: str
    recording: Motion | Signals
    start_s: float = 0.0
    speed: float = 1.0


def make_variants(recording: Motion | Signals) -> Iterator[Variant]:
    """Yield the recording at other rates and speeds, cut, with noise, turned and scaled."""
    noise = np.random.default_rng(0)
    for rate in RATES:
        if abs(rate - recording.fps) > 1:
            yield Variant(f"{rate:g} Hz", _resample(recording, rate))
    late = round(CUT_S * recording.fps)
    if recording.n_frames > 4 * late:
        yield Variant("2 s cut off", recording[late:], start_s=CUT_S)
    for speed in (0.8, 1.25):
        yield Variant(
            f"{speed:g} of the speed", replace(recording, fps=recording.fps * speed), 0.0, speed
        )
    if isinstance(recording, Signals):
        spread = NOISE_SHARE * recording.values.std(axis=0)
        values = recording.values + noise.normal(0, 1, recording.values.shape) * spread
        yield Variant("noise", replace(recording, values=values))
        return
    places = recording.positions + noise.normal(0, NOISE_M, recording.positions.shape)
    yield Variant("noise", Motion(recording.skeleton, places, recording.fps, gaps=recording.gaps))
    yield Variant("points alone", Motion(recording.skeleton, recording.positions, recording.fps))
    yield Variant("turned", turn(recording, 2.0))
    yield Variant("0.9 of the size", scale(recording, 0.9))
    yield Variant("1.1 of the size", scale(recording, 1.1))
    yield Variant("as a video", _imitate_video(recording, noise))


def _imitate_video(motion: Motion, noise: np.random.Generator) -> Motion:
    """Return the motion like poses of a video: one view, noise, filled holes, smoothed."""
    from scipy.ndimage import gaussian_filter1d

    viewed = turn(resample(motion, VIDEO_FPS), VIEW)
    root = viewed.skeleton.parents.index(-1)
    positions = (viewed.positions - viewed.positions[:, [root]]) * (1, 1, DEPTH)
    n, joints, _ = positions.shape
    height = float(np.median(np.ptp(positions[..., 1], axis=1)))
    drift = gaussian_filter1d(noise.normal(0, 1, n), ZOOM_S * VIDEO_FPS)
    positions *= (1 + ZOOM * drift / np.abs(drift).max())[:, None, None]
    positions += noise.normal(0, JITTER * height, positions.shape)
    for joint in range(joints):
        for start in np.flatnonzero(noise.random(n) < 1 / (EVERY_S * VIDEO_FPS)).tolist():
            hidden = np.zeros(n, np.bool_)
            hidden[start : start + round(HIDDEN_S * VIDEO_FPS)] = True
            for axis in range(3):
                bridge_line(positions[:, joint, axis], hidden)
    smooth = filter_low(positions.reshape(n, -1), VIDEO_FPS, CUTOFF, round(VIDEO_FPS))
    return Motion(viewed.skeleton, smooth.reshape(positions.shape), VIDEO_FPS, gaps=viewed.gaps)


def _resample(recording: Motion | Signals, rate: float) -> Motion | Signals:
    if isinstance(recording, Motion):
        return resample(recording, rate)
    return Signals(
        resample_channels(recording.values, recording.fps, rate, smoothing=0.0),
        rate,
        recording.names,
    )


def measure_agreement(here: Segmentation, there: Segmentation, variant: Variant) -> float:
    """Return the share of time in the same cluster, with clusters matched one to one."""
    length = there.n_frames / there.fps * variant.speed
    times = np.arange(0, length, 1 / COMPARED)
    own = _sample_clusters(here, times + variant.start_s)
    other = _sample_clusters(there, times / variant.speed)
    return one_to_one_accuracy(Comparison(own, other, fps=COMPARED))


def _sample_clusters(found: Segmentation, times: NDArray[np.float64]) -> NDArray[np.int64]:
    frames = np.clip((times * found.fps).astype(np.int64), 0, found.n_frames - 1)
    return found.per_frame(level="activity")[frames]
