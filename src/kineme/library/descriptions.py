"""Compute what a library stores of a recording: segments, matching features and embeddings.

Bodies are described by `kineme.features.canonical`, which does not depend on the person. Channels
are described by posture and energy (`kineme.features.channels`), scaled by their standard deviation
in the recording, so that one threshold serves for bodies and any number of channels. They are
comparable between recordings of the same channels only.

The module that samples channels is imported only when an analysis is made, which keeps searches
fast to start.
"""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Float32s, Floats
from kineme._util.checks import format_count
from kineme.errors import MotionError
from kineme.features.canonical import MATCHING_FPS, compute_features_and_poses
from kineme.features.channels import (
    compute_channel_statistics,
    emg_envelope,
    resample_channels,
    standardize_channels,
)
from kineme.library.storage.layout import BODIES, EMBEDDED
from kineme.library.storage.tables import LARGEST_SAMPLE, Analysis
from kineme.methods.kineme.preset import SENSORS
from kineme.methods.segmenter import SegmentOptions, segment_with_options
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import to_samples
from kineme.transfer.embeddings import describe_curve, embedding

UNIT = 0.5
"""Scale of channel features relative to the RMS over channels; correct matches end at a distance
of 0.85 then, as for bodies."""
IN_GAP = 100.0
"""Value of all features in gaps: too far from others for a match."""


@dataclass(frozen=True, eq=False)
class Description:
    """Features (samples, dims) of a recording for search, comparable within a vocabulary.

    Without features the vocabulary is empty, and ``reason`` says why. A body has ``poses``
    (samples, 17) for embeddings.
    """

    vocabulary: str
    features: Float32s
    fps: float
    reason: str = ""
    poses: Floats | None = None

    def select(self, start_s: float, stop_s: float) -> Float32s:
        """Return the samples between two times, at least one."""
        return self.features[self._samples(start_s, stop_s)]

    def embedding(self, start_s: float, stop_s: float) -> Float32s:
        """Return the embedding (`EMBEDDED` numbers) of a segment; 0 if there are no features."""
        samples = self._samples(start_s, stop_s)
        if self.poses is not None:
            return embedding(self.poses[samples])
        found = np.zeros(EMBEDDED, np.float32)
        if len(self.features):
            numbers = describe_curve(self.features[samples].astype(np.float64))
            found[: min(EMBEDDED, len(numbers))] = numbers[:EMBEDDED]
        return found

    def _samples(self, start_s: float, stop_s: float) -> slice:
        return slice(*to_samples((start_s, stop_s), self.fps, max(len(self.features), 1)))


def describe(recording: Motion | Signals, options: SegmentOptions) -> Description:
    """Return the features of a recording, or the reason if it has no recognised body."""
    if isinstance(recording, Signals):
        vocabulary = sha256("\0".join(recording.names).encode()).hexdigest()[:8]
        features = compute_signal_features(recording, emg=options.emg)
        named = f"{format_count(recording.n_channels, 'channel')}, {vocabulary}"
        return Description(named, features, SENSORS.rate)
    try:
        features, poses = compute_features_and_poses(recording, effectors=options.effectors)
    except MotionError as error:
        return Description("", np.empty((0, 0), np.float32), MATCHING_FPS, str(error))
    return Description(BODIES, features, MATCHING_FPS, poses=poses)


def compute_signal_features(signals: Signals, *, emg: bool = False) -> Float32s:
    """Return features (samples, dims) of channels at `SENSORS.rate` per second."""
    preset = SENSORS.at_most(signals.fps)
    values = emg_envelope(signals.values, signals.fps) if emg else signals.values
    spans = signals.spans()
    rows = [
        resample_channels(values[a:b], signals.fps, preset.working_fps, smoothing=preset.smoothing)
        for a, b in spans
    ]
    scaled = standardize_channels(np.concatenate(rows))
    statistics = compute_channel_statistics(
        scaled, preset.working_fps, rate=preset.rate, window=preset.averaging, bands=preset.bands
    )
    unit = UNIT * np.sqrt(scaled.shape[1])
    samples: Float32s = (statistics / unit).astype(np.float32)
    if not signals.gaps:
        return samples
    n = int((signals.n_frames - 1) / signals.fps * preset.rate + 1e-9) + 1
    features = np.full((n, samples.shape[1]), IN_GAP, np.float32)
    first = 0.0  # recorded seconds before the span, without gaps
    for start, stop in spans:
        # Samples of the whole recording that lie in the span, and their row in `found`.
        at = np.arange(np.ceil(start / signals.fps * preset.rate), n)
        at = at[at / preset.rate < stop / signals.fps].astype(np.int64)
        sample = np.rint((at / preset.rate - start / signals.fps + first) * preset.rate)
        features[at] = samples[np.minimum(sample.astype(np.int64), len(samples) - 1)]
        first += (stop - start) / signals.fps
    return features


def make_analysis(
    recording: Motion | Signals, options: SegmentOptions
) -> tuple[Analysis, NDArray[np.float32], NDArray[np.float32] | None]:
    """Return the analysis of a recording, its features (samples, dims), and channel samples.

    Channel samples exist for signals only; a row holds the second, means and deviations.
    """
    from kineme.transfer.embeddings import compute_channel_samples

    segmentation, _ = segment_with_options(recording, options)
    described = describe(recording, options)
    embeddings = np.zeros((len(segmentation.table), EMBEDDED), np.float32)
    for row, each in enumerate(segmentation.table):
        if each.kind != "transition":
            embeddings[row] = described.embedding(each.start_s, each.stop_s)
    samples = None
    if isinstance(recording, Signals):
        rows = np.clip(compute_channel_samples(recording).rows, -LARGEST_SAMPLE, LARGEST_SAMPLE)
        samples = rows.astype(np.float32)
    reason = f"not searched: {described.reason}" if described.reason else ""
    facts = {
        "format": recording.provenance.format or "",
        "n_frames": recording.n_frames,
        "fps": recording.fps,
        "vocabulary": described.vocabulary,
        "features_fps": described.fps,
        "samples": len(described.features),
        "moments": 0 if samples is None else len(samples),
        "notes": [*segmentation.provenance["notes"], *filter(None, [reason])],
    }
    return Analysis(facts, segmentation.table, embeddings), described.features, samples
