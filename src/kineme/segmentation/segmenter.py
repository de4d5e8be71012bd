"""From a motion to its segments, in one call."""

from __future__ import annotations

import time
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kineme._version import __version__
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
from kineme.operations import resample
from kineme.segmentation.numbering import by_first_appearance
from kineme.segmentation.presets import (
    DEFAULT,
    ActionPreset,
    Preset,
    RegionPreset,
    resolve_preset,
)
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
    which the preset looks at it.

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
) -> tuple[Segmentation, Analysis | ActionAnalysis]:
    """The segments, and what each stage found on the way to them (for pictures)."""
    if progress is not None:
        progress("features")
    start = time.perf_counter()
    found = end_effectors(motion, names=effectors)
    features = motion_features(motion, preset, effectors=found)
    seconds = time.perf_counter() - start
    # Each method brings compiled code of its own, loaded only where it is used.
    analysis: Analysis | ActionAnalysis
    if isinstance(preset, ActionPreset):
        from kineme.segmentation.action_analysis import analyze_actions

        analysis = analyze_actions(features, preset, progress=progress)
        columns = _action_columns(analysis)
    elif isinstance(preset, RegionPreset):
        from kineme.segmentation.analysis import analyze

        analysis = analyze(features, preset, mirror=mirror_features, progress=progress)
        columns = _region_columns(analysis)
    else:
        raise ParameterError(f"no method goes with a preset of type {type(preset).__name__}")
    source = motion.provenance
    columns = _at_source_rate(columns, motion, preset.working_fps)
    notes = [*source.notes, f"end effectors: {found.describe(motion.skeleton)}"]
    if isinstance(preset, ActionPreset):
        notes += _doubts(columns, motion.fps)
    provenance = {
        "kineme": __version__,
        "preset": preset.name,
        "parameters": {k: v for k, v in asdict(preset).items() if k != "name"},
        "input": {"path": source.path, "format": source.format, "sha256": source.sha256},
        "notes": notes,
    }
    timings = {"features": seconds, **analysis.timings}
    result = Segmentation.from_columns(
        columns,
        n_frames=motion.n_frames,
        fps=motion.fps,
        provenance=provenance,
        timings=timings,
    )
    return result, analysis


def motion_features(
    motion: Motion, preset: Preset, *, effectors: EndEffectors | None = None
) -> NDArray[np.float64]:
    """Search vectors (frames, dims) of a motion at the preset's working rate.

    In metres for the published methods; for ``kineme`` in body sizes, over the
    root of the number of stacked poses, so that distances do not depend on
    either.
    """
    effectors = effectors or end_effectors(motion)
    pose = pose_features(resample(motion, preset.working_fps), effectors=effectors)
    stacked = stack(pose, offsets_in_frames(preset.offsets, preset.working_fps))
    if isinstance(preset, ActionPreset):
        stacked /= body_size(motion, effectors) * np.sqrt(len(preset.offsets))
    return stacked


Columns = dict[str, NDArray[Any]]


def _region_columns(analysis: Analysis) -> Columns:
    parents = np.searchsorted(analysis.blocks, analysis.segments[:-1], side="right") - 1
    clusters = _cluster_numbers(analysis, parents)
    of_blocks = _main_clusters(clusters, parents, np.diff(analysis.segments))
    return {
        "level": np.repeat(["activity", "primitive"], [len(of_blocks), len(parents)]),
        "kind": _kinds(analysis.repeats, parents),
        "start_frame": np.concatenate([analysis.blocks[:-1], analysis.segments[:-1]]),
        "stop_frame": np.concatenate([analysis.blocks[1:], analysis.segments[1:]]),
        "cluster": np.concatenate([of_blocks, clusters]),
        "score": np.concatenate([analysis.repetition, analysis.clustering.scores]),
    }


def _action_columns(analysis: ActionAnalysis) -> Columns:
    parents = np.searchsorted(analysis.blocks, analysis.segments[:-1], side="right") - 1
    return {
        "level": np.repeat(["activity", "primitive"], [len(analysis.labels), len(parents)]),
        "kind": _kinds(analysis.labels >= 0, parents),
        "start_frame": np.concatenate([analysis.blocks[:-1], analysis.segments[:-1]]),
        "stop_frame": np.concatenate([analysis.blocks[1:], analysis.segments[1:]]),
        "cluster": np.concatenate([analysis.labels, analysis.labels[parents]]),
        "score": np.concatenate([analysis.confidence, analysis.agreement]),
    }


# Scores below which a result is to be looked at: activities whose moments are nearly as
# much like another action's, and counts that few poses agree on.
UNSURE_ACTION, UNSURE_COUNT = 0.25, 0.4


def _doubts(columns: Columns, fps: float) -> list[str]:
    """A sentence for each activity that the method is not sure of."""
    activity = (columns["level"] == "activity") & (columns["kind"] == "activity")
    sentences = []
    for row in np.flatnonzero(activity):
        start, stop = columns["start_frame"][row], columns["stop_frame"][row]
        where = f"at {start / fps:.2f} to {stop / fps:.2f} s"
        if columns["score"][row] < UNSURE_ACTION:
            sentences.append(
                f"look at the activity {where}: it is nearly as much like another "
                f"(confidence {columns['score'][row]:.2f})"
            )
        inside = (columns["level"] == "primitive") & (columns["start_frame"] == start)
        agreement = columns["score"][inside][0]
        if agreement < UNSURE_COUNT:
            sentences.append(
                f"look at the repetitions {where}: only {agreement:.0%} of the poses agree "
                "on their number"
            )
    return sentences


def _kinds(is_activity: NDArray[np.bool_], parents: NDArray[np.intp]) -> NDArray[np.str_]:
    kinds = np.where(is_activity, "activity", "transition")
    return np.concatenate([kinds, kinds[parents]])


def _at_source_rate(columns: Columns, motion: Motion, working_fps: float) -> Columns:
    """The columns in frames of the motion, without rows that vanish there."""
    ratio = motion.fps / working_fps
    last = columns["stop_frame"].max()
    frames = {}
    for name in ("start_frame", "stop_frame"):
        at_source = np.rint(columns[name] * ratio).astype(np.int64)
        frames[name] = np.where(columns[name] == last, motion.n_frames, at_source)
    columns = {**columns, **frames}
    # At low frame rates two borders may fall on the same frame.
    full = columns["start_frame"] < columns["stop_frame"]
    return {name: column[full] for name, column in columns.items()}


def _cluster_numbers(analysis: Analysis, parents: NDArray[np.intp]) -> NDArray[np.int64]:
    """Numbers from 0 by first appearance; -1 for transitions that nothing else is like."""
    labels = analysis.clustering.labels
    lonely = np.bincount(labels)[labels] == 1
    named = ~(lonely & ~analysis.repeats[parents])
    return by_first_appearance(np.where(named, labels, -1))


def _main_clusters(
    clusters: NDArray[np.int64], parents: NDArray[np.intp], lengths: NDArray[np.int64]
) -> NDArray[np.int64]:
    """For each block the cluster that most of its frames are in; -1 where that is none."""
    frames = np.zeros((int(parents.max()) + 1, int(clusters.max()) + 2), np.int64)
    np.add.at(frames, (parents, clusters), lengths)  # those in no cluster: the last column
    main = frames.argmax(axis=1)
    return np.where(main == frames.shape[1] - 1, -1, main)
