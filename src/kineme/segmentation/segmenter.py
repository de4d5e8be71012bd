"""From a motion to its segments, in one call."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kineme._checks import check_type
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
from kineme.features.effectors import Names
from kineme.methods.presets import (
    DEFAULT,
    ActionPreset,
    Preset,
    RegionPreset,
    resolve_preset,
)
from kineme.methods.stages import Progress
from kineme.recordings.motion import Motion
from kineme.recordings.operations import resample, split_at_gaps
from kineme.segmentation.from_features import segment_features
from kineme.segmentation.parts import Part
from kineme.segments.segmentation import Segmentation

if TYPE_CHECKING:
    from kineme.methods.recurrence.analysis import ActionAnalysis
    from kineme.methods.region_growing.analysis import Analysis

Floats = NDArray[np.float64]


def segment(
    motion: Motion,
    *,
    preset: str | Preset = DEFAULT,
    effectors: Names | None = None,
    progress: Progress | None = None,
    **overrides: Any,
) -> Segmentation:
    """Activities, transitions and primitives of a motion, as one table.

    Frames and seconds are those of the motion given, whatever the rate at
    which the preset looks at it. A gap of the motion is a transition; what lies
    around it is analysed together.

    Parameters
    ----------
    motion : Motion
        At least one frame. What is too short or never repeats is one segment.
    preset : str or Preset
        ``kineme``, ``voegele2014`` or ``krueger2017``; see
        :mod:`kineme.methods.presets`.
    effectors : joints to take for head, hands and feet where names do not tell. Where these are
        not found either, the distances between points are looked at instead of a body
    progress : called with the name of each stage before it runs
    **overrides : constants of the preset to change, such as ``radius=0.5``

    Raises
    ------
    MotionError : the joints named are not those of a body, or there is a single point
    ParameterError : no such preset or constant, a value it cannot take, a preset for signals, no
        motion, or mirroring where nothing tells left from right
    """
    chosen = resolve_preset(preset, **overrides)
    return segment_and_analysis(motion, chosen, effectors=effectors, progress=progress)[0]


def segment_and_analysis(
    motion: Motion,
    preset: str | Preset = DEFAULT,
    *,
    effectors: Names | None = None,
    progress: Progress | None = None,
) -> tuple[Segmentation, Analysis | ActionAnalysis]:
    """The segments, and what each stage found on the way to them (for pictures).

    Parameters and errors are those of `segment`; constants are changed by ``Preset.replace``.
    """
    advice = "kineme.read(path) gives one; channels go to segment_signals, arrays to Segmenter"
    check_type(motion, Motion, "segment", advice)
    preset = resolve_preset(preset)
    if preset.unit == "standard deviations":
        raise ParameterError(
            f"the lengths of this {preset.name} are in standard deviations of signals: "
            f"give motions one in metres"
        )
    if progress is not None:
        progress("features")
    start = time.perf_counter()
    seen = _seen(motion, preset, effectors)
    seconds = time.perf_counter() - start
    source = motion.provenance
    return segment_features(
        np.concatenate(seen.features),
        preset,
        n_frames=motion.n_frames,
        fps=motion.fps,
        parts=seen.parts,
        mirror=mirror_features,
        source={"path": source.path, "format": source.format, "sha256": source.sha256},
        notes=[*source.notes, *seen.notes],
        timings={"features": seconds},
        progress=progress,
    )


def motion_features(
    motion: Motion, preset: Preset, *, effectors: EndEffectors | None = None
) -> Floats:
    """Search vectors (frames, dims) of a motion at the preset's working rate.

    In metres for the published methods; for ``kineme`` in body sizes, over the
    root of the number of stacked poses, so that distances do not depend on
    either.
    """
    effectors = effectors or end_effectors(motion)
    size = body_size(motion, effectors) if isinstance(preset, ActionPreset) else 1.0
    pose = pose_features(resample(motion, preset.working_fps), effectors=effectors)
    return _search_vectors(pose, preset, size)


@dataclass(frozen=True)
class _Seen:
    """Search vectors of the stretches between a motion's gaps, and what to know of them."""

    features: list[Floats]
    parts: list[Part]
    notes: list[str]


def _seen(motion: Motion, preset: Preset, effectors: Names | None) -> _Seen:
    """What there is to see of a motion: a body, or else the distances between its points."""
    stretches = split_at_gaps(motion)
    looked = [resample(part, preset.working_fps) for _, part in stretches]
    longest = max((part for _, part in stretches), key=lambda part: part.n_frames)
    try:
        found = end_effectors(motion, names=effectors)
        size = body_size(longest, found) if isinstance(preset, ActionPreset) else 1.0
        poses = [pose_features(part, effectors=found) for part in looked]
        notes = [f"end effectors: {found.describe(motion.skeleton)}"]
    except MotionError as error:
        if effectors is not None:
            raise
        size = SIZE
        poses, notes = _without_a_body(looked, preset, error)
    parts = [
        Part(start, start + part.n_frames, len(pose))
        for (start, part), pose in zip(stretches, poses, strict=True)
    ]
    return _Seen([_search_vectors(pose, preset, size) for pose in poses], parts, notes)


def _without_a_body(
    stretches: list[Motion], preset: Preset, error: MotionError
) -> tuple[list[Floats], list[str]]:
    """The distances between the points of each stretch, and notes that say so and why."""
    reason = error.reason if isinstance(error, EndEffectorError) else str(error)
    if isinstance(preset, RegionPreset) and preset.mirror:
        raise ParameterError(
            f"{reason}, so nothing tells left from right: name five joints with --effectors, "
            f"or leave out mirroring"
        ) from error
    features, points = distance_features(np.concatenate([part.positions for part in stretches]))
    names = stretches[0].skeleton.names
    said = (
        f"{reason}: segmented by the distances between {len(points)} of its {len(names)} points; "
        f"name five joints with --effectors to be looked at as a body"
    )
    notes = [said, f"points: {', '.join(names[point] for point in points)}"]
    ends = np.cumsum([part.n_frames for part in stretches])[:-1]
    return np.split(features, ends), notes


def _search_vectors(pose: Floats, preset: Preset, size: float) -> Floats:
    stacked = stack(pose, offsets_in_frames(preset.offsets, preset.working_fps))
    if isinstance(preset, ActionPreset):
        stacked /= size * np.sqrt(len(preset.offsets))
    return stacked
