"""Compute the features that a method analyses: at its working rate, for each span between gaps.

Features of a motion are the positions of head, hands and feet in the body's own frame, or else
rotations of joints or distances between points. Features of channels are their values divided by
their standard deviations.

Distances of channels are divided by √(window · channels), so that a radius R does not depend on
the number of channels: the generalised radius r = R √(window · channels) of Krüger et al. 2017.
Lengths of the published methods are converted from metres to standard deviations (see their
presets).

Coordinates of a body's points depend mostly on where somebody stands and which way they face. So
channels with such coordinates are replaced by distances between the points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import (
    compute_distance_features,
    end_effectors,
    measure_body_size,
    mirror_features,
    pose_features,
    round_offsets,
    stack,
)
from kineme.features.channels import emg_envelope, resample_channels, standardize_channels
from kineme.features.distances import SIZE, have_bones
from kineme.features.effectors import Names, suggest_remedy
from kineme.features.pose import compute_joint_quaternions, compute_log_maps
from kineme.methods.base import Mirror, Preset
from kineme.recordings import Motion, Signals
from kineme.recordings.column_names import group_axes, is_body
from kineme.recordings.operations import resample, split_at_gaps

Indices = NDArray[np.intp]
MAX_NAMED_CHANNELS = 8
"""Largest number of channels that a note names."""
AXES = "xyz"
SMOOTHING = 0.15
"""Standard deviation of the Gaussian filter of joint positions, s. Joints estimated from video
jitter as much as hands move."""


@dataclass(frozen=True)
class RecordedSpan:
    """A span of a recording without gaps: its frames, and its samples at the working rate."""

    start: int
    stop: int
    n_samples: int


@dataclass(frozen=True, eq=False)
class Prepared:
    """Features of a recording at the working rate of a preset."""

    features: Sequence[Floats]
    """One array (samples, dims) for each span without gaps."""
    spans: Sequence[RecordedSpan]
    notes: Sequence[str]
    """How the features were made, for the result's notes."""
    mirror: Mirror | None = None
    """Swaps left and right in the features; None if they have no sides."""
    joints: bool = False
    """Whether the features are distances between joints, made from channels."""


def prepare_motion(motion: Motion, preset: Preset, effectors: Names | None) -> Prepared:
    """Return the features of a motion between its gaps, at the working rate of the preset.

    ``effectors`` are joints to use as head, hands and feet if their names are not recognised. If no
    body is found, features are distances between points.

    Raises
    ------
    MotionError
        The named joints are not those of a body, or there is only one point.
    ParameterError
        The preset mirrors, but left and right are unknown.
    """
    spans = split_at_gaps(motion)
    motions = [resample(span, preset.working_fps) for _, span in spans]
    recorded = [
        RecordedSpan(start, start + span.n_frames, resampled.n_frames)
        for (start, span), resampled in zip(spans, motions, strict=True)
    ]
    notes = []
    if preset.view != "poses":
        try:
            return Prepared([_compute_rotations(span, preset) for span in motions], recorded, [])
        except MotionError as error:
            notes.append(f"{error}: segmented by the positions of head, hands and feet")
    # The size of a body is constant: measure it in the longest span.
    longest = max((span for _, span in spans), key=lambda span: span.n_frames)
    try:
        ends = end_effectors(motion, names=effectors)
        size = measure_body_size(longest, ends) if preset.unit == "body sizes" else 1.0
        poses = [pose_features(span, effectors=ends) for span in motions]
        notes.append(f"end effectors: {ends.describe(motion.skeleton)}")
    except MotionError as error:
        if effectors is not None:
            raise
        size = SIZE
        poses, distance_notes = _measure_distances(motions, preset, error)
        notes += distance_notes
    return Prepared(
        [_stack_poses(pose, preset, size) for pose in poses], recorded, notes, mirror_features
    )


def compute_motion_features(motion: Motion, preset: Preset) -> Floats:
    """Compute the features (frames, dims) of a motion at the preset's working rate.

    They are in metres for the published methods. For ``kineme`` they are in body sizes,
    divided by the root of the number of stacked poses, so that distances do not depend
    on the body or on the stacking.
    """
    effectors = end_effectors(motion)
    size = measure_body_size(motion, effectors) if preset.unit == "body sizes" else 1.0
    pose = pose_features(resample(motion, preset.working_fps), effectors=effectors)
    return _stack_poses(pose, preset, size)


def _compute_rotations(motion: Motion, preset: Preset) -> Floats:
    quaternions = compute_joint_quaternions(motion)
    if preset.view == "rotation vectors":
        return compute_log_maps(quaternions)
    return quaternions.reshape(motion.n_frames, -1)


def _measure_distances(
    motions: list[Motion], preset: Preset, error: MotionError
) -> tuple[list[Floats], list[str]]:
    """Return the distances between points for each span, and notes that explain this choice."""
    reason = error.reason if isinstance(error, EndEffectorError) else str(error)
    if getattr(preset, "mirror", False):
        raise ParameterError(
            f"{reason}, so left and right are unknown: name five joints with --effectors or "
            "turn mirroring off"
        ) from error
    # All spans together, so that they share the same principal axes.
    features, points = compute_distance_features(
        np.concatenate([span.positions for span in motions])
    )
    names = motions[0].skeleton.names
    note = (
        f"{reason}: segmented by the distances between {len(points)} of its {len(names)} points; "
        + suggest_remedy(motions[0].skeleton)
    )
    notes = [note, f"points: {', '.join(names[point] for point in points)}"]
    return _split_rows(features, [span.n_frames for span in motions]), notes


def _stack_poses(pose: Floats, preset: Preset, size: float) -> Floats:
    stacked = stack(pose, round_offsets(preset.offsets, preset.working_fps))
    if preset.unit == "body sizes":
        # Root of the number of poses: stacking does not make distances larger.
        stacked /= size * np.sqrt(len(preset.offsets))
    return stacked


def prepare_signals(
    signals: Signals,
    preset: Preset,
    *,
    emg: bool = False,
    standardize: bool = True,
    unit: float = 1.0,
) -> Prepared:
    """Return the features of signals between their gaps, at the working rate of the preset.

    The preset is one for signals, see `kineme.methods.resolve_preset`. With ``emg``, envelopes of
    muscle signals are computed first. With ``standardize``, channels are divided by their standard
    deviations. A distance of ``unit``, in these or else in the unit of the channels, is one unit of
    the preset's lengths.
    """
    values = emg_envelope(signals.values, signals.fps) if emg else signals.values
    rows, spans = [], []
    for start, stop in signals.spans():
        part = resample_channels(
            values[start:stop], signals.fps, preset.working_fps, smoothing=preset.smoothing
        )
        rows.append(part)
        spans.append(RecordedSpan(start, stop, len(part)))
    notes = _describe_channels(signals, values, emg=emg, standardize=standardize)
    # Names and values of channels are meaningful only if they are neither embeddings nor EMG.
    is_descriptive = standardize and not emg
    points = find_joints(signals) if preset.accepts_joints and is_descriptive else None
    if points is not None:
        rows = replace_by_distances(rows, points, preset.working_fps)
        notes.append(f"{len(points)} points with bones: segmented by the distances between them")
    features = _stack_channels(rows, preset, standardize=standardize)
    unit_name = "standard deviations" if standardize else "units of the channels"
    if unit != 1:
        features = features / unit
        notes.append(f"lengths are in units of {unit:.3g} {unit_name}")
    elif preset.unit != "any":
        notes.append(f"lengths are in {unit_name}")
    parts = _split_rows(features, [span.n_samples for span in spans])
    return Prepared(parts, spans, notes, joints=points is not None)


def _stack_channels(rows: list[Floats], preset: Preset, *, standardize: bool) -> Floats:
    """Stack and scale the channels of all spans; distances become root mean squares."""
    joined, lengths = np.concatenate(rows), [len(row) for row in rows]
    scaled = standardize_channels(joined) if standardize else joined
    offsets = round_offsets(preset.offsets, preset.working_fps)
    # Stack within each span: frames of different spans are not neighbours.
    stacked = np.concatenate([stack(row, offsets) for row in _split_rows(scaled, lengths)])
    # Dividing by the root of the columns turns a distance into a root mean square.
    return np.asarray(stacked / np.sqrt(stacked.shape[1]), np.float64)


def _describe_channels(
    signals: Signals, values: Floats, *, emg: bool, standardize: bool
) -> list[str]:
    """Return notes on the channels and how they are scaled."""
    shown = ", ".join(signals.names[:MAX_NAMED_CHANNELS])
    if signals.n_channels > MAX_NAMED_CHANNELS:
        shown += ", …"
    scaled = "each divided by its standard deviation" if standardize else "as they are"
    notes = [f"channels: {shown}, {scaled}"]
    is_constant = values.min(axis=0) == values.max(axis=0)
    if is_constant.any() and standardize:
        names = [name for name, still in zip(signals.names, is_constant, strict=True) if still]
        notes.append(f"channels that never change are ignored: {', '.join(names)}")
    if emg:
        notes.append("muscle signals: rectified and low-passed")
    return notes


def find_joints(signals: Signals) -> Indices | None:
    """Find the channels that are x, y and z of a body's points, by their names and bone lengths.

    Return an array (points, 3), or None if there is no body.
    """
    points = [
        [signals.names.index(axes[axis]) for axis in AXES]
        for name, axes in group_axes(signals.names).items()
        if is_body(name) and len(axes) == len(AXES)
    ]
    if not points:
        return None
    values = np.concatenate([signals.values[slice(*span)] for span in signals.spans()])
    # Indexed by (points, 3): values become (frames, points, axes).
    return np.array(points) if have_bones(values[:, points]) else None


def replace_by_distances(rows: Sequence[Floats], points: Indices, fps: float) -> list[Floats]:
    """Replace the coordinates of points by features of the distances between them.

    There is one array of rows (samples, channels) for each span of the recording. ``points``
    (points, 3) are the channels that are coordinates.
    """
    from scipy.ndimage import gaussian_filter1d

    positions = [
        gaussian_filter1d(row[:, points.ravel()], SMOOTHING * fps, axis=0, mode="nearest")
        for row in rows
    ]
    posture, _ = compute_distance_features(np.concatenate(positions).reshape(-1, *points.shape))
    # Other channels are kept unchanged.
    others = np.delete(np.concatenate(rows), points.ravel(), axis=1)
    return _split_rows(np.hstack([posture, others]), [len(row) for row in rows])


def _split_rows(rows: Floats, lengths: list[int]) -> list[Floats]:
    """Split rows into spans of these lengths."""
    return np.split(rows, np.cumsum(lengths)[:-1])
