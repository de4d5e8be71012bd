"""The labels of a knowledge base for the primitives of a recording.

Every unlabelled primitive takes the label of its cheapest valid match (see
`kineme.transfer.matching`), and stays without one where none is cheap
enough. Its confidence is the margin: the share by which the next label costs more,
from 0 (both cost the same) to 1.

A recording that is too short has no activities, so there is nothing to name. Its features are
searched for each labelled primitive (see `kineme.transfer.subsequences.search`); of matches that
overlap, the nearest stays. Matches of one label that follow each other are the primitives of one
activity.

Source: Vögele, Krüger and Klein 2014, section 6.1; threshold, margin and
spreading through clusters are our own.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import as_floats, check_flag, check_type, is_number
from kineme.errors import ParameterError
from kineme.segments.editing.rows import replace_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment, SegmentTable, choose_kind
from kineme.transfer.knowledge import FPS, KnowledgeBase, find_working_frames
from kineme.transfer.matching import Primitives, compute_label_costs, number_movements
from kineme.transfer.subsequences import THRESHOLD, search

Row = tuple[int, int, str]

_FOLLOWS_S = 0.3  # matches of one label this near to each other are of one activity


class Found(NamedTuple):
    """Where, in samples, a labelled primitive was found, and its distance."""

    start: int
    stop: int
    label: str
    distance: float


def find_by_search(
    features: NDArray[np.floating], knowledge: KnowledgeBase, threshold: float
) -> list[Found]:
    """Matches of labelled primitives that do not overlap, in time order."""
    borders = np.concatenate([[0], np.cumsum(knowledge.lengths)])
    matches: list[Found] = []
    for label, start, stop in zip(knowledge.labels, borders[:-1], borders[1:], strict=True):
        found = search(knowledge.features[start:stop], features, threshold=threshold)
        spans = zip(*(column.tolist() for column in found), strict=True)
        matches += [Found(a, b, str(label), distance) for a, b, distance in spans]
    occupied = np.zeros(len(features), np.bool_)
    kept = []
    for match in sorted(matches, key=lambda match: match.distance):
        if not occupied[match.start : match.stop].any():
            occupied[match.start : match.stop] = True
            kept.append(match)
    return sorted(kept)


def segment_as_found(segmentation: Segmentation, found: list[Found]) -> Segmentation:
    """Return the recording cut into what was found: labelled activities and primitives."""
    frames_per_sample = segmentation.fps / FPS
    primitives: list[Row] = []
    for match in found:
        start = round(match.start * frames_per_sample)
        stop = min(round(match.stop * frames_per_sample), segmentation.n_frames)
        if primitives and primitives[-1][2] == match.label:
            last = primitives[-1]
            if start - last[1] <= _FOLLOWS_S * segmentation.fps:
                primitives[-1] = (last[0], start, last[2])
        primitives.append((start, stop, match.label))
    activities: list[Row] = []
    for start, stop, label in primitives:
        follows = bool(activities) and activities[-1][1:] == (start, label)
        activities.append((activities.pop()[0] if follows else start, stop, label))
    names = {label: number for number, label in enumerate(sorted({row[2] for row in activities}))}
    levels: tuple[tuple[Level, list[Row]], ...]
    levels = ("activity", activities), ("primitive", primitives)
    rows = [
        Segment(
            level,
            choose_kind(level, transition=not label),
            start,
            stop,
            start / segmentation.fps,
            stop / segmentation.fps,
            cluster=names.get(label, -1),
            label=label,
        )
        for level, spans in levels
        for start, stop, label in _fill_between(spans, segmentation.n_frames)
    ]
    return replace_rows(segmentation, rows, [])


def _fill_between(rows: list[Row], n_frames: int) -> list[Row]:
    """Return the rows, and what lies between them without a label."""
    tiled: list[Row] = []
    at = 0
    for start, stop, label in [*rows, (n_frames, n_frames, "")]:
        if start > at:
            tiled.append((at, start, ""))
        if stop > start:
            tiled.append((start, stop, label))
        at = stop
    return tiled


REACH = 2.0
"""Thresholds up to which a match with the next label is looked for."""
SIMILAR = 0.6
"""Cost up to which the repetitions of one person are the same movement."""
LARGEST = 1e6
"""Threshold above which nothing more is found; no cost comes near it."""


def transfer_labels(
    segmentation: Segmentation,
    features: ArrayLike,
    knowledge: KnowledgeBase,
    *,
    threshold: float = THRESHOLD,
    spread: bool = False,
) -> Segmentation:
    """Return the same segments, with labels from the knowledge base and the margin as confidence.

    A recording without activities, as one that is too short to repeat anything, is searched for
    every known primitive, and cut into what is found. Labels that are there already stay. An
    activity is called as most of its frames are. ``provenance["transfer"]`` holds the threshold
    and, for each primitive, the cost of its match (null: no label came from one).

    Parameters
    ----------
    segmentation : Segmentation
        Its primitives are labelled, or its activities where it has none;
        transitions are not.
    features : (samples, 40) array
        Of the same recording, fifteen samples a second, as `transfer_features` gives them.
    knowledge : KnowledgeBase
    threshold : float
        Largest cost of a match: 0 is equal, 1.41 has nothing in common. Lower: fewer
        labels, more of them right.
    spread : bool
        Whether a cluster takes the label that most of its members got, its confidence for
        the others being the share of them that did.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        Features of another recording, or a threshold that is not above 0.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> from kineme.transfer import transfer_features
    >>> motion = kineme.read(bundled_recording())
    >>> truth = kineme.read_segments(bundled_truth(), fps=motion.fps, n_frames=motion.n_frames)
    >>> knowledge = kineme.KnowledgeBase.from_recording(motion, truth)
    >>> features = transfer_features(motion)
    >>> named = kineme.transfer_labels(kineme.segment(motion), features, knowledge)
    >>> named.activities[0].label
    'walk'
    """
    check_type(segmentation, Segmentation, "transfer_labels", "kineme.segment(motion) gives one")
    check_type(knowledge, KnowledgeBase, "transfer_labels", "KnowledgeBase.load(path) gives one")
    if not (is_number(threshold) and threshold > 0):
        raise ParameterError(f"the threshold must be a number above 0, not {threshold!r:.60}")
    check_flag(spread, "spread")
    threshold = min(float(threshold), LARGEST)
    features = _check_features(features, segmentation)
    table = segmentation.table
    if not ((table.kind != "transition") | (table.label != "")).any():
        return _search_labels(segmentation, features, knowledge, threshold, spread=spread)
    level: Level = "primitive" if len(segmentation.primitives) else "activity"
    rows = segmentation.level(level)
    labels = rows.label.astype(object)
    margins, costs = rows.confidence.copy(), np.full(len(rows), np.nan)
    unnamed = np.flatnonzero((rows.kind != "transition") & (rows.label == ""))
    if len(unnamed) and len(knowledge):
        unknown = _list_primitives(rows.select(unnamed), features, segmentation.fps)
        found, names = _list_costs(unknown, knowledge, REACH * threshold)
        named = _choose_cheapest(found, names, threshold)
        other = _find_other_movements(named[0], named[2], number_movements(unknown, SIMILAR))
        named[0][other], named[1][other], named[2][other] = "", np.nan, np.nan
        labels[unnamed], margins[unnamed], costs[unnamed] = named
    if spread:
        _spread_in_clusters(labels, margins, rows.cluster, unnamed)
    of_level = table.level == level
    all_labels, all_margins = table.label.astype(object), table.confidence.copy()
    all_labels[of_level], all_margins[of_level] = labels, margins
    if level == "primitive":
        activities = table.level == "activity"
        all_labels[activities] = _label_activities(segmentation, labels)
    table = table.with_columns(label=all_labels.astype(np.str_), confidence=all_margins)
    provenance = _make_provenance(segmentation, labels[unnamed], costs, threshold, spread=spread)
    return replace(segmentation, table=table, provenance=provenance, hierarchy=None)


def name_primitives(segmentation: Segmentation, labels: Segmentation) -> Segmentation:
    """Return the same segments, each called as most of its frames are in ``labels``.

    Parameters
    ----------
    segmentation : Segmentation
    labels : Segmentation
        Of the same recording, from a person. Its activities count; a segment stays
        without a label where most frames have none.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        The two are of recordings of different length.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.transfer import name_primitives
    >>> truth = kineme.read_segments(bundled_truth(), fps=60)
    >>> name_primitives(truth, truth).primitives[0].label
    'walk'
    """
    if labels.n_frames != segmentation.n_frames:
        raise ParameterError(
            f"the labels are of {labels.n_frames} frames, the recording has {segmentation.n_frames}"
        )
    per_frame = labels.per_frame("label", level="activity").astype(object)
    names = [
        Counter(per_frame[row.start_frame : row.stop_frame]).most_common(1)[0][0]
        for row in segmentation
    ]
    table = segmentation.table.with_columns(label=np.array(names, dtype=np.str_))
    return replace(segmentation, table=table, hierarchy=None)


def _search_labels(
    segmentation: Segmentation,
    features: Floats,
    knowledge: KnowledgeBase,
    threshold: float,
    *,
    spread: bool,
) -> Segmentation:
    """Known primitives, found in a recording without activities; the same segments without any."""
    found = find_by_search(features, knowledge, threshold)
    result = segment_as_found(segmentation, found) if found else segmentation
    labels = np.array([match.label for match in found], np.str_)
    costs = np.array([match.distance for match in found])
    provenance = _make_provenance(segmentation, labels, costs, threshold, spread=spread)
    return replace(result, provenance=provenance, hierarchy=None)


def _list_costs(
    unknown: Primitives, knowledge: KnowledgeBase, radius: float
) -> tuple[Floats, NDArray[np.str_]]:
    """Costs (primitives, names), and the names; without a match the radius."""
    names, codes = np.unique(knowledge.labels, return_inverse=True)
    costs = compute_label_costs(unknown, knowledge.primitives(), codes, len(names), radius=radius)
    return np.minimum(costs, radius), names


def _choose_cheapest(
    costs: Floats, names: NDArray[np.str_], threshold: float
) -> tuple[NDArray[Any], Floats, Floats]:
    """Label, margin and cost of each row; empty and nan where nothing is within the threshold."""
    best = costs.argmin(axis=1)
    cost = costs[np.arange(len(costs)), best]
    others = costs.copy()
    others[np.arange(len(costs)), best] = np.inf
    # With one label alone the radius stands for the next: matches that cost more were not searched.
    following = np.minimum(others.min(axis=1), REACH * threshold)
    margin = 1 - cost / np.maximum(following, 1e-12)
    valid = cost <= threshold
    return (
        np.where(valid, names[best].astype(object), ""),
        np.where(valid, margin, np.nan),
        np.where(valid, cost, np.nan),
    )


def _find_other_movements(
    labels: NDArray[Any], costs: Floats, movements: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Which rows are another movement than the cheapest match of their label in the recording.

    Another movement keeps the label only where its match costs no more than one repetition of a
    person costs by another.
    """
    other = np.zeros(len(labels), np.bool_)
    for label in set(labels.tolist()) - {""}:
        named = np.flatnonzero(labels == label)
        first = named[costs[named].argmin()]
        other[named] = (movements[named] != movements[first]) & (costs[named] > SIMILAR)
    return other


def _spread_in_clusters(
    labels: NDArray[Any], margins: Floats, clusters: NDArray[np.int64], unnamed: NDArray[np.intp]
) -> None:
    """Give every cluster's members the label that most of them have; a person's label stays."""
    for cluster in set(clusters[unnamed].tolist()) - {-1}:
        named = Counter(label for label in labels[clusters == cluster] if label)
        if not named:
            continue
        winner, votes = named.most_common(1)[0]
        others = [row for row in unnamed if clusters[row] == cluster and labels[row] != winner]
        labels[others] = winner
        margins[others] = votes / named.total()


def _label_activities(segmentation: Segmentation, labels: NDArray[Any]) -> list[str]:
    """Return the label of each activity: its own, else that of more than half of its frames."""
    primitives = segmentation.primitives
    names = []
    for row in segmentation.activities:
        inside = np.flatnonzero(primitives.activity == row.activity)
        frames: Counter[str] = Counter()
        for p in inside:
            frames[labels[p]] += int(primitives.stop_frame[p] - primitives.start_frame[p])
        name, most = frames.most_common(1)[0] if frames else ("", 0)
        wide = most > (row.stop_frame - row.start_frame) / 2
        names.append(row.label or (name if wide and row.kind == "activity" else ""))
    return names


def _check_features(features: ArrayLike, segmentation: Segmentation) -> Floats:
    array = as_floats(features, "features")
    expected = segmentation.n_frames * FPS / segmentation.fps
    if array.ndim != 2 or abs(len(array) - expected) > 2:
        raise ParameterError(
            f"features have the shape {array.shape}, the recording {expected:.0f} frames at "
            f"{FPS:g} Hz: make them with transfer_features()"
        )
    return array


def _list_primitives(rows: SegmentTable, features: Floats, fps: float) -> Primitives:
    """Return the rows with their frames; those of a cluster that touch are a run."""
    starts, stops = find_working_frames(rows, fps, len(features))
    follows = (rows.start_frame[1:] == rows.stop_frame[:-1]) & (
        rows.cluster[1:] == rows.cluster[:-1]
    )
    frames = np.concatenate([features[a:b] for a, b in zip(starts, stops, strict=True)])
    return Primitives(frames, stops - starts, np.concatenate([[0], np.cumsum(~follows)]))


def _make_provenance(
    segmentation: Segmentation,
    given: NDArray[Any],
    costs: Floats,
    threshold: float,
    *,
    spread: bool,
) -> dict[str, Any]:
    counts = Counter(label for label in given if label)
    named = ", ".join(f"{label} {count}" for label, count in sorted(counts.items())) or "none"
    note = f"{counts.total()} of {len(given)} unlabelled primitives labelled: {named}"
    return {
        **segmentation.provenance,
        "transfer": {
            "threshold": threshold,
            "spread": spread,
            "costs": [None if math.isnan(cost) else round(cost, 4) for cost in costs.tolist()],
        },
        "notes": [*segmentation.provenance.get("notes", []), note],
    }
