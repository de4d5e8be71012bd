"""What a method sees of a motion: poses of a body, rotations of joints, or distances of points."""

from __future__ import annotations

import numpy as np

from kineme._arrays import Floats
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import (
    EndEffectors,
    body_size,
    distance_features,
    end_effectors,
    mirror_features,
    offsets_in_frames,
    pose_features,
    stack,
)
from kineme.features.distances import SIZE
from kineme.features.effectors import Names, remedy
from kineme.features.rotations import joint_quaternions, log_maps
from kineme.methods.base import Preset
from kineme.recordings import Motion
from kineme.recordings.operations import resample, split_at_gaps
from kineme.segmentation.spans import RecordedSpan
from kineme.segmentation.views import View


def view_of_motion(motion: Motion, preset: Preset, effectors: Names | None) -> View:
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
        RecordedSpan(start, start + span.n_frames, at_rate.n_frames)
        for (start, span), at_rate in zip(spans, motions, strict=True)
    ]
    notes = []
    if preset.view != "poses":
        try:
            return View([_rotations(span, preset) for span in motions], recorded, [])
        except MotionError as error:
            notes.append(f"{error}: seen by the positions of head, hands and feet")
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
        poses, note = _without_a_body(motions, preset, error)
        notes += note
    return View([_features(pose, preset, size) for pose in poses], recorded, notes, mirror_features)


def motion_features(
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
    return _features(pose, preset, size)


def _rotations(motion: Motion, preset: Preset) -> Floats:
    turned = joint_quaternions(motion)
    if preset.view == "rotation vectors":
        return log_maps(turned)
    return turned.reshape(motion.n_frames, -1)


def _without_a_body(
    motions: list[Motion], preset: Preset, error: MotionError
) -> tuple[list[Floats], list[str]]:
    """Return the distances between the points of each span, and notes that say so and why."""
    reason = error.reason if isinstance(error, EndEffectorError) else str(error)
    if getattr(preset, "mirror", False):
        raise ParameterError(
            f"{reason}, so nothing tells left from right: name five joints with --effectors, "
            f"or leave out mirroring"
        ) from error
    features, points = distance_features(np.concatenate([span.positions for span in motions]))
    names = motions[0].skeleton.names
    note = (
        f"{reason}: segmented by the distances between {len(points)} of its {len(names)} points; "
        + remedy(motions[0].skeleton)
    )
    notes = [note, f"points: {', '.join(names[point] for point in points)}"]
    ends = np.cumsum([span.n_frames for span in motions])[:-1]
    return np.split(features, ends), notes


def _features(pose: Floats, preset: Preset, size: float) -> Floats:
    stacked = stack(pose, offsets_in_frames(preset.offsets, preset.working_fps))
    if preset.unit == "body sizes":
        stacked /= size * np.sqrt(len(preset.offsets))
    return stacked
