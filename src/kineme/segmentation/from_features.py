"""From features to segments: any array of frames × dims, with or without a body.

The analyses count frames of the working rate, results those of the recording;
they meet here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.methods.numbering import by_first_appearance
from kineme.methods.presets import (
    DEFAULT,
    ActionPreset,
    Preset,
    RegionPreset,
    resolve_preset,
)
from kineme.methods.stages import Progress
from kineme.segmentation.parts import Columns, Part, gaps_between, in_source_frames
from kineme.segments.segmentation import Segmentation

if TYPE_CHECKING:
    from kineme.methods.recurrence.analysis import ActionAnalysis
    from kineme.methods.region_growing.analysis import Analysis, Mirror

# Scores below which a result is to be looked at: activities whose moments are nearly as
# much like another action's, and counts that others fit nearly as well.
UNSURE_ACTION, UNSURE_COUNT = 0.25, 0.5


def analyze(
    features: ArrayLike,
    preset: str | Preset = DEFAULT,
    *,
    mirror: Mirror | None = None,
    progress: Progress | None = None,
) -> Analysis | ActionAnalysis:
    """What each stage of a method finds in a sequence of features.

    Parameters
    ----------
    features : (frames, dims)
        Search vectors at the working rate, in the unit that the preset's lengths are in.
    preset : by name or as it is; its class says which method
    mirror : exchanges left and right in such features, for presets that mirror;
        `kineme.mirror_features` for those of motions
    progress : called with the name of each stage before it runs

    Returns
    -------
    `Analysis` from the published methods, `ActionAnalysis` from ``kineme``

    Raises
    ------
    ParameterError : no such preset, a preset of no known method, features of another shape,
        empty or not finite, or a preset that mirrors what has no left and right
    """
    chosen = resolve_preset(preset)
    # Each method brings compiled code of its own, loaded only where it is used.
    if isinstance(chosen, ActionPreset):
        from kineme.methods.recurrence.analysis import analyze_actions

        return analyze_actions(features, chosen, progress=progress)
    if isinstance(chosen, RegionPreset):
        from kineme.methods.region_growing.analysis import analyze_regions

        return analyze_regions(features, chosen, mirror=mirror, progress=progress)
    raise ParameterError(f"no method goes with a preset of type {type(chosen).__name__}")


def segment_features(
    features: ArrayLike,
    preset: Preset,
    *,
    n_frames: int,
    fps: float,
    parts: Sequence[Part] | None = None,
    mirror: Mirror | None = None,
    source: Mapping[str, Any] | None = None,
    notes: Sequence[str] = (),
    timings: Mapping[str, float] | None = None,
    progress: Progress | None = None,
) -> tuple[Segmentation, Analysis | ActionAnalysis]:
    """The segments of a recording, and what each stage found on the way to them.

    Parameters
    ----------
    features : (frames, dims)
        Search vectors at the working rate, in the unit that the preset's lengths are in.
    preset : whose class says which method
    n_frames, fps : of the recording, in whose frames the result counts
    parts : the stretches of it that the features are of, where these are not all
    mirror : exchanges left and right in the features, where they have these
    source : ``path``, ``format`` and ``sha256`` of the recording
    notes : sentences on what was inferred so far
    timings : seconds spent so far, per stage
    progress : called with the name of each stage before it runs

    Raises
    ------
    ParameterError : a preset of no known method, or features it cannot take
    """
    analysis = analyze(features, preset, mirror=mirror, progress=progress)
    if isinstance(preset, ActionPreset):
        columns = _action_columns(cast("ActionAnalysis", analysis))
    else:
        columns = _region_columns(cast("Analysis", analysis))
    parts = parts or [Part(0, n_frames, int(columns["stop_frame"].max()))]
    columns = in_source_frames(columns, parts, n_frames, fps / preset.working_fps)
    doubts = _doubts(columns, fps) if isinstance(preset, ActionPreset) else []
    provenance: dict[str, Any] = {
        "kineme": __version__,
        "preset": preset.name,
        "parameters": {k: v for k, v in asdict(preset).items() if k != "name"},
        "input": {"path": None, "format": None, "sha256": None, **(source or {})},
        "notes": [*notes, *doubts],
    }
    if gaps := gaps_between(parts, n_frames):
        provenance["gaps"] = [list(gap) for gap in gaps]
    result = Segmentation.from_columns(
        columns,
        n_frames=n_frames,
        fps=fps,
        provenance=provenance,
        timings={**(timings or {}), **analysis.timings},
    )
    return result, analysis


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
                f"look at the repetitions {where}: another number of them fits nearly as well "
                f"(score {agreement:.2f})"
            )
    return sentences


def _kinds(is_activity: NDArray[np.bool_], parents: NDArray[np.intp]) -> NDArray[np.str_]:
    kinds = np.where(is_activity, "activity", "transition")
    return np.concatenate([kinds, kinds[parents]])


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
