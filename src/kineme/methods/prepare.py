"""What a method sees of a recording: features at its working rate, between the gaps.

A motion is seen by the poses of head, hands and feet in the body's own frame, else by rotations
of joints or distances of points; channels by their values over their standard deviations.
Distances of channels are divided by √(window · channels), so that a radius R means the same
whatever the number of channels: the generalised radius r = R √(window · channels) of Krüger et
al. 2017. The published methods' lengths, metres of a body, become standard deviations (see their
presets). The method ``kineme`` takes its unit from the recording itself: the distance at which
its samples recur, of which noise and irregularity are part.

Places of a body's points among the channels say where somebody stands and which way they face,
and only then how. So they are replaced by how far points are from each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import (
    EndEffectors,
    body_size,
    compute_distance_features,
    end_effectors,
    mirror_features,
    pose_features,
    round_offsets,
    stack,
)
from kineme.features.channels import resample_channels, standardize_channels
from kineme.features.distances import SIZE, have_bones
from kineme.features.effectors import Names, suggest_remedy
from kineme.features.emg import emg_envelope
from kineme.features.rotations import joint_quaternions, log_maps
from kineme.methods.base import Mirror, Preset
from kineme.recordings import Motion, Signals
from kineme.recordings.coordinates import group_axes, is_body
from kineme.recordings.operations import resample, split_at_gaps


@dataclass(frozen=True)
class RecordedSpan:
    """A span of a recording without a gap.

    Attributes
    ----------
    start, stop : int
        Its frames of the recording.
    n_samples : int
        How many samples it has at the working rate.
    """

    start: int
    stop: int
    n_samples: int


@dataclass(frozen=True, eq=False)
class Prepared:
    """Features of a recording at the working rate of a preset.

    Attributes
    ----------
    features : sequence of (samples, dims) arrays
        One of each span without a gap.
    spans : sequence of RecordedSpan
    notes : sequence of str
        What is to be known of them.
    mirror : callable, optional
        Exchanges left and right in the features, where they have these.
    joints : bool
        Whether channels are places of joints, and the preset wants to be told.
    """

    features: Sequence[Floats]
    spans: Sequence[RecordedSpan]
    notes: Sequence[str]
    mirror: Mirror | None = None
    joints: bool = False


def prepare_motion(motion: Motion, preset: Preset, effectors: Names | None) -> Prepared:
    """Return the features of a motion between its gaps, at the working rate of the preset.

    Parameters
    ----------
    motion : Motion
    preset : Preset
    effectors : joints, optional
        To take for head, hands and feet where names do not tell. Where these are not found
        either, the distances between points are looked at instead of a body.

    Raises
    ------
    MotionError
        The joints named are not those of a body, or there is a single point.
    ParameterError
        Mirroring where nothing tells left from right.
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
            notes.append(f"{error}: seen by the positions of head, hands and feet")
    # The body does not change its size: the longest span tells it best.
    longest = max((span for _, span in spans), key=lambda span: span.n_frames)
    try:
        found = end_effectors(motion, names=effectors)
        size = body_size(longest, found) if preset.unit == "body sizes" else 1.0
        poses = [pose_features(span, effectors=found) for span in motions]
        notes.append(f"end effectors: {found.describe(motion.skeleton)}")
    except MotionError as error:
        if effectors is not None:
            raise
        size = SIZE
        poses, note = _measure_distances(motions, preset, error)
        notes += note
    return Prepared(
        [_stack_poses(pose, preset, size) for pose in poses], recorded, notes, mirror_features
    )


def compute_motion_features(
    motion: Motion, preset: Preset, *, effectors: EndEffectors | None = None
) -> Floats:
    """Features (frames, dims) of a motion at the preset's working rate.

    In metres for the published methods; for ``kineme`` in body sizes, over the
    root of the number of stacked poses, so that distances do not depend on
    either.
    """
    effectors = effectors or end_effectors(motion)
    size = body_size(motion, effectors) if preset.unit == "body sizes" else 1.0
    pose = pose_features(resample(motion, preset.working_fps), effectors=effectors)
    return _stack_poses(pose, preset, size)


def _compute_rotations(motion: Motion, preset: Preset) -> Floats:
    turned = joint_quaternions(motion)
    if preset.view == "rotation vectors":
        return log_maps(turned)
    return turned.reshape(motion.n_frames, -1)


def _measure_distances(
    motions: list[Motion], preset: Preset, error: MotionError
) -> tuple[list[Floats], list[str]]:
    """Return the distances between the points of each span, and notes that say so and why."""
    reason = error.reason if isinstance(error, EndEffectorError) else str(error)
    if getattr(preset, "mirror", False):
        raise ParameterError(
            f"{reason}, so nothing tells left from right: name five joints with --effectors, "
            f"or leave out mirroring"
        ) from error
    # All spans together, so that they have the same axes.
    features, points = compute_distance_features(
        np.concatenate([span.positions for span in motions])
    )
    names = motions[0].skeleton.names
    note = (
        f"{reason}: segmented by the distances between {len(points)} of its {len(names)} points; "
        + suggest_remedy(motions[0].skeleton)
    )
    notes = [note, f"points: {', '.join(names[point] for point in points)}"]
    # Ends of the spans but the last, as `np.split` takes them.
    ends = np.cumsum([span.n_frames for span in motions])[:-1]
    return np.split(features, ends), notes


def _stack_poses(pose: Floats, preset: Preset, size: float) -> Floats:
    stacked = stack(pose, round_offsets(preset.offsets, preset.working_fps))
    if preset.unit == "body sizes":
        # Root of the offsets: stacking several poses does not make distances larger.
        stacked /= size * np.sqrt(len(preset.offsets))
    return stacked


# Names of channels in a note.
NAMED = 8


def prepare_signals(
    signals: Signals,
    preset: Preset,
    *,
    emg: bool = False,
    standardize: bool = True,
    unit: float | None = None,
) -> Prepared:
    """Return the features of signals between their gaps, at the working rate of the preset.

    Parameters
    ----------
    signals : Signals
    preset : Preset
        For signals, see `kineme.methods.resolve_preset`.
    emg : bool
        Take the envelopes of muscle signals first.
    standardize : bool
        Divide each channel by its standard deviation.
    unit : float, optional
        What one unit of the preset's lengths is in these channels; by default the preset
        finds out.
    """
    values = emg_envelope(signals.values, signals.fps) if emg else signals.values
    rows, spans = [], []
    for start, stop in signals.spans():
        row = resample_channels(
            values[start:stop], signals.fps, preset.working_fps, smoothing=preset.smoothing
        )
        rows.append(row)
        spans.append(RecordedSpan(start, stop, len(row)))
    notes = _describe_channels(signals, values, emg=emg, standardize=standardize)
    descriptive = standardize and not emg  # what channels are may be told by their names and values
    points = find_joints(signals) if preset.accepts_joints and descriptive else None
    if points is not None:
        rows = replace_by_distances(rows, points, preset.working_fps)
        notes.append(f"{len(points)} points with bones: seen by how far they are from each other")
    features = _stack_channels(rows, preset, standardize=standardize)
    if unit is None:
        unit = preset.signal_unit(features)
    named = "standard deviations" if standardize else "units of the channels"
    if unit != 1:
        features = features / unit
        notes.append(f"lengths are in units of {unit:.3g} {named}")
    elif preset.unit != "any":
        notes.append(f"lengths are in {named}")
    # Ends of the spans but the last, as `np.split` takes them.
    ends = np.cumsum([span.n_samples for span in spans])[:-1]
    split = np.split(features, ends)
    return Prepared(split, spans, notes, joints=points is not None)


def _stack_channels(rows: list[Floats], preset: Preset, *, standardize: bool) -> Floats:
    """Features of all spans; their distances are root mean squares over window and channels."""
    ends = np.cumsum([len(row) for row in rows])[:-1]
    joined = np.concatenate(rows)
    scaled = standardize_channels(joined) if standardize else joined
    offsets = round_offsets(preset.offsets, preset.working_fps)
    # Stacked within each span: frames of two spans are no neighbours.
    stacked = np.concatenate([stack(row, offsets) for row in np.split(scaled, ends)])
    # Root mean square over window and channels.
    return np.asarray(stacked / np.sqrt(stacked.shape[1]), np.float64)


def _describe_channels(
    signals: Signals, values: Floats, *, emg: bool, standardize: bool
) -> list[str]:
    shown = ", ".join(signals.names[:NAMED]) + (", …" if signals.n_channels > NAMED else "")
    scaled = "each divided by its standard deviation" if standardize else "as they are"
    notes = [f"channels: {shown}, {scaled}"]
    steady = values.min(axis=0) == values.max(axis=0)
    if steady.any() and standardize:
        names = [name for name, still in zip(signals.names, steady, strict=True) if still]
        notes.append(f"never change and carry no weight: {', '.join(names)}")
    if emg:
        notes.append("muscle signals: rectified and low-passed")
    return notes


Indices = NDArray[np.intp]

AXES = "xyz"
STEADY = 0.15
"""Seconds: places are smoothed by a normal curve that deviates by this. Joints that a camera
guesses shake as much as hands move."""


def find_joints(signals: Signals) -> Indices | None:
    """Return the channels that are x, y and z of a body's points, by their names and by its bones.

    Parameters
    ----------
    signals : Signals

    Returns
    -------
    (points, 3) array or None
        None where there is no body.
    """
    points = [
        [signals.names.index(axes[axis]) for axis in AXES]
        for name, axes in group_axes(signals.names).items()
        if is_body(name) and len(axes) == len(AXES)
    ]
    if not points:
        return None
    values = np.concatenate([signals.values[slice(*span)] for span in signals.spans()])
    # Frames, points, axes.
    return np.array(points) if have_bones(values[:, points]) else None


def replace_by_distances(rows: Sequence[Floats], points: Indices, fps: float) -> list[Floats]:
    """What distances between the points tell in place of their coordinates, and other channels.

    Parameters
    ----------
    rows : sequence of (samples, channels) array
        One of each span of the recording.
    points : (points, 3) array
        The channels that are their coordinates.
    fps : float
        Samples per second.
    """
    from scipy.ndimage import gaussian_filter1d

    places = [
        # The columns of all points in a row; back to points and axes below.
        gaussian_filter1d(row[:, points.ravel()], STEADY * fps, axis=0, mode="nearest")
        for row in rows
    ]
    posture, _ = compute_distance_features(np.concatenate(places).reshape(-1, *points.shape))
    # Channels that are no coordinates stay as they are.
    others = np.delete(np.concatenate(rows), points.ravel(), axis=1)
    ends = np.cumsum([len(row) for row in rows])[:-1]
    return np.split(np.hstack([posture, others]), ends)
