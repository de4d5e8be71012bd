"""From a motion to its segments, in one call."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ParameterError
from kineme.features import (
    EndEffectors,
    body_size,
    end_effectors,
    mirror_features,
    offsets_in_frames,
    pose_features,
    stack,
)
from kineme.features.effectors import Names
from kineme.motion import Motion
from kineme.operations import resample, split_at_gaps
from kineme.segmentation.from_features import segment_features
from kineme.segmentation.parts import Part
from kineme.segmentation.presets import DEFAULT, ActionPreset, Preset, resolve_preset
from kineme.segmentation.result import Segmentation
from kineme.segmentation.stages import Progress

if TYPE_CHECKING:
    from kineme.segmentation.action_analysis import ActionAnalysis
    from kineme.segmentation.analysis import Analysis


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
        :mod:`kineme.segmentation.presets`.
    effectors : joints to take for head, hands and feet where names do not tell
    progress : called with the name of each stage before it runs
    **overrides : constants of the preset to change, such as ``radius=0.5``

    Raises
    ------
    EndEffectorError : head, hands or feet were not found
    ParameterError : no such preset or constant, a value it cannot take, or no motion
    """
    if not isinstance(motion, Motion):
        raise ParameterError(
            f"segment takes a Motion, not {type(motion).__name__}: kineme.read(path) gives one; "
            f"channels go to segment_signals, arrays to Segmenter"
        )
    chosen = resolve_preset(preset, **overrides)
    return segment_and_analysis(motion, chosen, effectors=effectors, progress=progress)[0]


def segment_and_analysis(
    motion: Motion,
    preset: Preset,
    *,
    effectors: Names | None = None,
    progress: Progress | None = None,
) -> tuple[Segmentation, Analysis | ActionAnalysis]:
    """The segments, and what each stage found on the way to them (for pictures)."""
    if progress is not None:
        progress("features")
    start = time.perf_counter()
    found = end_effectors(motion, names=effectors)
    features, parts = _seen_features(motion, preset, found)
    seconds = time.perf_counter() - start
    source = motion.provenance
    return segment_features(
        features,
        preset,
        n_frames=motion.n_frames,
        fps=motion.fps,
        parts=parts,
        mirror=mirror_features,
        source={"path": source.path, "format": source.format, "sha256": source.sha256},
        notes=[*source.notes, f"end effectors: {found.describe(motion.skeleton)}"],
        timings={"features": seconds},
        progress=progress,
    )


def motion_features(
    motion: Motion, preset: Preset, *, effectors: EndEffectors | None = None
) -> NDArray[np.float64]:
    """Search vectors (frames, dims) of a motion at the preset's working rate.

    In metres for the published methods; for ``kineme`` in body sizes, over the
    root of the number of stacked poses, so that distances do not depend on
    either.
    """
    effectors = effectors or end_effectors(motion)
    size = body_size(motion, effectors) if isinstance(preset, ActionPreset) else 1.0
    return _search_vectors(motion, preset, effectors, size)


def _seen_features(
    motion: Motion, preset: Preset, effectors: EndEffectors
) -> tuple[NDArray[np.float64], list[Part]]:
    """Search vectors of the stretches between a motion's gaps, and which these are."""
    if not motion.gaps:
        features = motion_features(motion, preset, effectors=effectors)
        return features, [Part(0, motion.n_frames, len(features))]
    stretches = split_at_gaps(motion)
    longest = max((part for _, part in stretches), key=lambda part: part.n_frames)
    size = body_size(longest, effectors) if isinstance(preset, ActionPreset) else 1.0
    rows = [_search_vectors(part, preset, effectors, size) for _, part in stretches]
    parts = [
        Part(start, start + part.n_frames, len(found))
        for (start, part), found in zip(stretches, rows, strict=True)
    ]
    return np.concatenate(rows), parts


def _search_vectors(
    motion: Motion, preset: Preset, effectors: EndEffectors, size: float
) -> NDArray[np.float64]:
    pose = pose_features(resample(motion, preset.working_fps), effectors=effectors)
    stacked = stack(pose, offsets_in_frames(preset.offsets, preset.working_fps))
    if isinstance(preset, ActionPreset):
        stacked /= size * np.sqrt(len(preset.offsets))
    return stacked
