"""From a motion to its segments, in one call."""

from __future__ import annotations

import time
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._version import __version__
from kineme.features import (
    EndEffectors,
    end_effectors,
    offsets_in_frames,
    pose_features,
    stack,
)
from kineme.features.effectors import Names
from kineme.motion import Motion
from kineme.operations import resample
from kineme.segmentation.analysis import Analysis, Progress, analyze
from kineme.segmentation.presets import Preset, resolve_preset
from kineme.segmentation.result import Segmentation


def segment(
    motion: Motion,
    *,
    preset: str | Preset = "voegele2014",
    effectors: Names | None = None,
    progress: Progress | None = None,
    **overrides: Any,
) -> Segmentation:
    """Activities, transitions and primitives of a motion, as one table.

    Frames and seconds are those of the motion given, whatever the rate at
    which the preset looks at it.

    Parameters
    ----------
    motion : Motion
        At least one frame. What is too short or never repeats is one segment.
    preset : str or Preset
        ``voegele2014`` or ``krueger2017``; see :mod:`kineme.segmentation.presets`.
    effectors : joints to take for head, hands and feet where names do not tell
    progress : called with the name of each stage before it runs
    **overrides : constants of the preset to change, such as ``radius=0.5``

    Raises
    ------
    EndEffectorError : head, hands or feet were not found
    ParameterError : no such preset or constant, or a value it cannot take
    """
    chosen = resolve_preset(preset, **overrides)
    return segment_and_analysis(motion, chosen, effectors=effectors, progress=progress)[0]


def segment_and_analysis(
    motion: Motion,
    preset: Preset,
    *,
    effectors: Names | None = None,
    progress: Progress | None = None,
) -> tuple[Segmentation, Analysis]:
    """The segments, and what each stage found on the way to them (for pictures)."""
    if progress is not None:
        progress("features")
    start = time.perf_counter()
    found = end_effectors(motion, names=effectors)
    features = motion_features(motion, preset, effectors=found)
    seconds = time.perf_counter() - start
    analysis = analyze(features, preset, progress=progress)
    source = motion.provenance
    provenance = {
        "kineme": __version__,
        "preset": preset.name,
        "parameters": {k: v for k, v in asdict(preset).items() if k != "name"},
        "input": {"path": source.path, "format": source.format, "sha256": source.sha256},
        "notes": [*source.notes, f"end effectors: {found.describe(motion.skeleton)}"],
    }
    timings = {"features": seconds, **analysis.timings}
    return _table(analysis, motion, preset.working_fps, provenance, timings), analysis


def motion_features(
    motion: Motion, preset: Preset, *, effectors: EndEffectors | Names | None = None
) -> NDArray[np.float64]:
    """Search vectors (frames, dims) of a motion at the preset's working rate, in metres."""
    pose = pose_features(resample(motion, preset.working_fps), effectors=effectors)
    return stack(pose, offsets_in_frames(preset.offsets, preset.working_fps))


def _table(
    analysis: Analysis,
    motion: Motion,
    working_fps: float,
    provenance: dict[str, Any],
    timings: dict[str, float],
) -> Segmentation:
    blocks, segments = (
        _source_frames(borders, motion.fps / working_fps, motion.n_frames)
        for borders in (analysis.blocks, analysis.segments)
    )
    parents = np.searchsorted(analysis.blocks, analysis.segments[:-1], side="right") - 1
    clusters = _cluster_numbers(analysis, parents)
    kinds = np.where(analysis.repeats, "activity", "transition")
    columns: dict[str, NDArray[Any]] = {
        "level": np.repeat(["activity", "primitive"], [len(kinds), len(parents)]),
        "kind": np.concatenate([kinds, kinds[parents]]),
        "start_frame": np.concatenate([blocks[:-1], segments[:-1]]),
        "stop_frame": np.concatenate([blocks[1:], segments[1:]]),
        "cluster": np.concatenate([_main_clusters(clusters, parents, np.diff(segments)), clusters]),
        "score": np.concatenate([analysis.repetition, analysis.clustering.scores]),
    }
    # at low frame rates two borders may fall on the same frame
    full = columns["start_frame"] < columns["stop_frame"]
    return Segmentation.from_columns(
        {name: column[full] for name, column in columns.items()},
        n_frames=motion.n_frames,
        fps=motion.fps,
        provenance=provenance,
        timings=timings,
    )


def _source_frames(
    borders: NDArray[np.int64], ratio: float, n_frames: int
) -> NDArray[np.int64]:
    frames: NDArray[np.int64] = np.rint(borders * ratio).astype(np.int64)
    frames[-1] = n_frames
    return frames


def _cluster_numbers(analysis: Analysis, parents: NDArray[np.intp]) -> NDArray[np.int64]:
    """Numbers from 0 by first appearance; -1 for transitions that nothing else is like."""
    labels = analysis.clustering.labels
    lonely = np.bincount(labels)[labels] == 1
    named = ~(lonely & ~analysis.repeats[parents])
    numbers = np.full(len(labels), -1)
    _, first, inverse = np.unique(labels[named], return_index=True, return_inverse=True)
    numbers[named] = np.argsort(np.argsort(first))[inverse]
    return numbers


def _main_clusters(
    clusters: NDArray[np.int64], parents: NDArray[np.intp], lengths: NDArray[np.int64]
) -> NDArray[np.int64]:
    """For each block the cluster that most of its frames are in; -1 where that is none."""
    frames = np.zeros((int(parents.max()) + 1, int(clusters.max()) + 2), np.int64)
    np.add.at(frames, (parents, clusters), lengths)  # those in no cluster: the last column
    main = frames.argmax(axis=1)
    return np.where(main == frames.shape[1] - 1, -1, main)
