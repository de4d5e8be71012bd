"""Label the primitives of a recording by a knowledge base.

Every unlabelled primitive takes the label of its cheapest match (see
`kineme.transfer.matching`), if that is cheap enough. Its confidence is the margin: 1 - cost / cost
of the next label, from 0 (equal costs) to 1.

A recording that is too short has no activities to label. Its features are searched for each
labelled primitive (see `kineme.transfer.matching.search`); of overlapping matches the nearest
is kept. Consecutive matches with the same label become the primitives of one activity.

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
from kineme.segments.editing.borders import replace_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment, SegmentTable, choose_kind
from kineme.transfer.knowledge import FPS, KnowledgeBase, join_features
from kineme.transfer.matching import (
    THRESHOLD,
    Primitives,
    choose_disjoint,
    compute_label_costs,
    number_movements,
    search,
)

Row = tuple[int, int, str]
"""Start, stop and label."""
_MAX_GAP_S = 0.3
"""Largest gap between two matches of one activity, s."""
SEARCH_FACTOR = 2.0
"""Factor of the threshold up to which costs are searched, to measure the margin."""
SIMILAR = 0.6
"""Largest cost at which repetitions of one person are the same movement."""
MAX_THRESHOLD = 1e6
"""Largest threshold, far above all costs."""


def transfer_labels(
    segmentation: Segmentation,
    features: ArrayLike,
    knowledge: KnowledgeBase,
    *,
    threshold: float = THRESHOLD,
    spread: bool = False,
) -> Segmentation:
    """Label segments by a knowledge base, with the margin as confidence.

    Existing labels are kept. An activity takes the label of most of its frames. A recording
    without activities, because it is too short to repeat anything, is searched for every labelled
    primitive and divided into the matches. ``provenance["transfer"]`` holds the threshold and the
    cost of the match of each primitive (null if it got no label).

    Parameters
    ----------
    segmentation : Segmentation
        Its primitives are labelled, or its activities if it has no primitives.
        Transitions are not labelled.
    features : (samples, 40) array
        Features of the same recording, fifteen per second, as returned by `transfer_features`.
    knowledge : KnowledgeBase
    threshold : float
        Largest cost of a match: 0 is equal, 1.41 has nothing in common. A lower threshold
        gives fewer labels, but more of them are right.
    spread : bool
        Whether all members of a cluster take the label that most of them got. The
        confidence of the others is the share of members with this label.

    Raises
    ------
    ParameterError
        The features belong to another recording, or the threshold is not above 0.

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
    threshold = min(float(threshold), MAX_THRESHOLD)
    features = _check_features(features, segmentation)
    table = segmentation.table
    if not ((table.kind != "transition") | (table.label != "")).any():
        return _search_labels(segmentation, features, knowledge, threshold, spread=spread)
    # Work on one level; activities then follow from their primitives.
    level: Level = "primitive" if len(segmentation.primitives) else "activity"
    rows = segmentation.level(level)
    labels = rows.label.astype(object)
    margins, costs = rows.confidence.copy(), np.full(len(rows), np.nan)
    unnamed = np.flatnonzero((rows.kind != "transition") & (rows.label == ""))
    if len(unnamed) and len(knowledge):
        unknown = _list_primitives(rows.select(unnamed), features, segmentation.fps)
        # Label, margin and cost of each row.
        best = _choose_cheapest(unknown, knowledge, threshold)
        rejected = _find_rejected_labels(best[0], best[2], number_movements(unknown, SIMILAR))
        best[0][rejected], best[1][rejected], best[2][rejected] = "", np.nan, np.nan
        labels[unnamed], margins[unnamed], costs[unnamed] = best
    if spread:
        _spread_in_clusters(labels, margins, rows.cluster, unnamed)
    is_level = table.level == level
    all_labels, all_margins = table.label.astype(object), table.confidence.copy()
    all_labels[is_level], all_margins[is_level] = labels, margins
    if level == "primitive":
        activities = table.level == "activity"
        all_labels[activities] = _label_activities(segmentation, labels)
    table = table.with_columns(label=all_labels.astype(np.str_), confidence=all_margins)
    provenance = _make_provenance(segmentation, labels[unnamed], costs, threshold, spread=spread)
    return replace(segmentation, table=table, provenance=provenance, hierarchy=None)


def name_primitives(segmentation: Segmentation, labels: Segmentation) -> Segmentation:
    """Label each segment as most of its frames are labelled in ``labels``.

    Parameters
    ----------
    segmentation : Segmentation
    labels : Segmentation
        Labels of the same recording by a person. Its activities are used. A segment gets no
        label if most of its frames have none.

    Raises
    ------
    ParameterError
        The recordings have different lengths.

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
            f"the labels have {labels.n_frames} frames, but the recording has "
            f"{segmentation.n_frames}"
        )
    per_frame = labels.per_frame("label", level="activity").astype(object)
    names = [
        Counter(per_frame[row.start_frame : row.stop_frame]).most_common(1)[0][0]
        for row in segmentation
    ]
    table = segmentation.table.with_columns(label=np.array(names, dtype=np.str_))
    return replace(segmentation, table=table, hierarchy=None)


def _check_features(features: ArrayLike, segmentation: Segmentation) -> Floats:
    array = as_floats(features, "features")
    # Tolerate two samples, for rounding of the rate and the length.
    expected = segmentation.n_frames * FPS / segmentation.fps
    if array.ndim != 2 or abs(len(array) - expected) > 2:
        raise ParameterError(
            f"features have the shape {array.shape}, the recording {expected:.0f} frames at "
            f"{FPS:g} Hz: make them with transfer_features()"
        )
    return array


def _list_primitives(rows: SegmentTable, features: Floats, fps: float) -> Primitives:
    """Return the rows as primitives; adjacent ones of a cluster form a run."""
    follows = (rows.start_frame[1:] == rows.stop_frame[:-1]) & (
        rows.cluster[1:] == rows.cluster[:-1]
    )
    runs = np.concatenate([[0], np.cumsum(~follows)])
    return Primitives(*join_features(rows, fps, features), runs)


def _choose_cheapest(
    unknown: Primitives, knowledge: KnowledgeBase, threshold: float
) -> tuple[NDArray[Any], Floats, Floats]:
    """Return label, margin and cost of each row; empty and nan if none is within the threshold."""
    names, codes = np.unique(knowledge.labels, return_inverse=True)
    radius = SEARCH_FACTOR * threshold
    costs = compute_label_costs(unknown, knowledge.primitives(), codes, len(names), radius=radius)
    # Matches beyond the search radius are unknown, so the next label costs at most this much.
    ordered = np.sort(np.column_stack([costs, np.full(len(costs), radius)]), axis=1)
    best, cost, second = costs.argmin(axis=1), ordered[:, 0], ordered[:, 1]
    margin = 1 - cost / np.maximum(second, 1e-12)
    valid = cost <= threshold
    return (
        np.where(valid, names[best].astype(object), ""),
        np.where(valid, margin, np.nan),
        np.where(valid, cost, np.nan),
    )


def _find_rejected_labels(
    labels: NDArray[Any], costs: Floats, movements: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Mark rows that lose their label, as they are not the movement of its cheapest match.

    ``movements`` numbers the movement of each row. A row of another movement loses the label only
    if its cost is above `SIMILAR`, the largest cost between repetitions of one person.
    """
    is_rejected = np.zeros(len(labels), np.bool_)
    for label in set(labels.tolist()) - {""}:
        named = np.flatnonzero(labels == label)
        cheapest = named[costs[named].argmin()]
        is_other = movements[named] != movements[cheapest]
        is_rejected[named] = is_other & (costs[named] > SIMILAR)
    return is_rejected


def _spread_in_clusters(
    labels: NDArray[Any], margins: Floats, clusters: NDArray[np.int64], unnamed: NDArray[np.intp]
) -> None:
    """Give members of a cluster the label of most of them; labels by people are kept."""
    for cluster in set(clusters[unnamed].tolist()) - {-1}:
        named = Counter(label for label in labels[clusters == cluster] if label)
        if not named:
            continue
        winner, votes = named.most_common(1)[0]
        others = [row for row in unnamed if clusters[row] == cluster and labels[row] != winner]
        labels[others] = winner
        margins[others] = votes / named.total()


def _label_activities(segmentation: Segmentation, labels: NDArray[Any]) -> list[str]:
    """Return the label of each activity: its own, or that of more than half of its frames."""
    primitives = segmentation.primitives
    names = []
    for row in segmentation.activities:
        inside = np.flatnonzero(primitives.activity == row.activity)
        frames: Counter[str] = Counter()
        for p in inside:
            frames[labels[p]] += int(primitives.stop_frame[p] - primitives.start_frame[p])
        name, most = frames.most_common(1)[0] if frames else ("", 0)
        is_majority = most > (row.stop_frame - row.start_frame) / 2
        names.append(row.label or (name if is_majority and row.kind == "activity" else ""))
    return names


def _make_provenance(
    segmentation: Segmentation,
    labels: NDArray[Any],
    costs: Floats,
    threshold: float,
    *,
    spread: bool,
) -> dict[str, Any]:
    """Return the provenance with the costs of labels and a note on their number."""
    counts = Counter(label for label in labels if label)
    named = ", ".join(f"{label} {count}" for label, count in sorted(counts.items())) or "none"
    note = f"{counts.total()} of {len(labels)} unlabelled primitives labelled: {named}"
    return {
        **segmentation.provenance,
        "transfer": {
            "threshold": threshold,
            "spread": spread,
            "costs": [None if math.isnan(cost) else round(cost, 4) for cost in costs.tolist()],
        },
        "notes": [*segmentation.provenance.get("notes", []), note],
    }


def _search_labels(
    segmentation: Segmentation,
    features: Floats,
    knowledge: KnowledgeBase,
    threshold: float,
    *,
    spread: bool,
) -> Segmentation:
    """Search labelled primitives in a recording without activities, and divide it into matches."""
    matches = find_by_search(features, knowledge, threshold)
    result = segment_by_matches(segmentation, matches) if matches else segmentation
    labels = np.array([match.label for match in matches], np.str_)
    costs = np.array([match.distance for match in matches])
    provenance = _make_provenance(segmentation, labels, costs, threshold, spread=spread)
    return replace(result, provenance=provenance, hierarchy=None)


class LabelMatch(NamedTuple):
    """A match of a labelled primitive: span in samples, label, and distance."""

    start: int
    stop: int
    label: str
    distance: float


def find_by_search(
    features: NDArray[np.floating], knowledge: KnowledgeBase, threshold: float
) -> list[LabelMatch]:
    """Find matches of labelled primitives that do not overlap, in time order."""
    borders = np.concatenate([[0], np.cumsum(knowledge.lengths)])
    matches: list[LabelMatch] = []
    for label, start, stop in zip(knowledge.labels, borders[:-1], borders[1:], strict=True):
        example_matches = search(knowledge.features[start:stop], features, threshold=threshold)
        spans = zip(*(column.tolist() for column in example_matches), strict=True)
        matches += [LabelMatch(a, b, str(label), distance) for a, b, distance in spans]
    # Nearest first, so that the nearest of overlapping matches is kept.
    matches.sort(key=lambda match: match.distance)
    starts, stops = [match.start for match in matches], [match.stop for match in matches]
    return sorted(matches[i] for i in choose_disjoint(starts, stops, len(features)).tolist())


def segment_by_matches(segmentation: Segmentation, matches: list[LabelMatch]) -> Segmentation:
    """Replace the segments of a recording by matches: labelled activities and primitives."""
    frames_per_sample = segmentation.fps / FPS
    primitives: list[Row] = []
    for match in matches:
        start = round(match.start * frames_per_sample)
        stop = min(round(match.stop * frames_per_sample), segmentation.n_frames)
        if primitives:
            last_start, last_stop, last_label = primitives[-1]
            # Close a small gap to the previous match of the same label.
            is_near = start - last_stop <= _MAX_GAP_S * segmentation.fps
            if is_near and last_label == match.label:
                primitives[-1] = (last_start, start, last_label)
        primitives.append((start, stop, match.label))
    activities: list[Row] = []
    for start, stop, label in primitives:
        # Adjacent primitives with the same label extend the activity.
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
    return replace_rows(segmentation, rows)


def _fill_between(rows: list[Row], n_frames: int) -> list[Row]:
    """Fill the spans between rows with rows without a label."""
    filled: list[Row] = []
    last_stop = 0
    for start, stop, label in [*rows, (n_frames, n_frames, "")]:
        if start > last_stop:
            filled.append((last_stop, start, ""))
        if stop > start:
            filled.append((start, stop, label))
        last_stop = stop
    return filled
