"""The labels of a knowledge base for the primitives of a recording.

Every unlabelled primitive takes the label of its cheapest valid match (see
`kineme.transfer.matching`), and stays without one where none is cheap
enough. Its confidence is the margin: the share by which the next label is dearer,
from 0 (a toss-up) to 1.

Source: Vögele, Krüger and Klein 2014, section 6.1; threshold, margin and
spreading through clusters are our own.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import as_floats, check_flag, check_type, is_number
from kineme.errors import ParameterError
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, SegmentTable
from kineme.transfer.choosing import (
    REACH,
    SIMILAR,
    activity_labels,
    another_movement,
    cheapest,
    costs_of,
    spread_in_clusters,
)
from kineme.transfer.features import FPS, working_frames
from kineme.transfer.knowledge import KnowledgeBase
from kineme.transfer.matching import THRESHOLD, Floats, Primitives, same_movements
from kineme.transfer.unsegmented import found_by_search, segmented_as_found

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
    """The same segments, with labels from the knowledge base and the margin as confidence.

    A recording without activities, as one that is too short to repeat anything, is searched for
    all that is known, and cut into what is found there. Labels that are there already stay. An
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
    features = _checked(features, segmentation)
    table = segmentation.table
    if not ((table.kind != "transition") | (table.label != "")).any():
        return _searched(segmentation, features, knowledge, threshold, spread=spread)
    level: Level = "primitive" if len(segmentation.primitives) else "activity"
    rows = segmentation.level(level)
    labels = rows.label.astype(object)
    margins, costs = rows.confidence.copy(), np.full(len(rows), np.nan)
    unnamed = np.flatnonzero((rows.kind != "transition") & (rows.label == ""))
    if len(unnamed) and len(knowledge):
        unknown = _primitives(rows.select(unnamed), features, segmentation.fps)
        found, names = costs_of(unknown, knowledge, REACH * threshold)
        named = cheapest(found, names, threshold)
        other = another_movement(named[0], named[2], same_movements(unknown, SIMILAR))
        named[0][other], named[1][other], named[2][other] = "", np.nan, np.nan
        labels[unnamed], margins[unnamed], costs[unnamed] = named
    if spread:
        spread_in_clusters(labels, margins, rows.cluster, unnamed)
    of_level = table.level == level
    all_labels, all_margins = table.label.astype(object), table.confidence.copy()
    all_labels[of_level], all_margins[of_level] = labels, margins
    if level == "primitive":
        activities = table.level == "activity"
        all_labels[activities] = activity_labels(segmentation, labels)
    return Segmentation(
        table.with_columns(label=all_labels.astype(np.str_), confidence=all_margins),
        segmentation.n_frames,
        segmentation.fps,
        _provenance(segmentation, labels[unnamed], costs, threshold, spread=spread),
        segmentation.timings,
        annotation=segmentation.annotation,
    )


def name_primitives(segmentation: Segmentation, labels: Segmentation) -> Segmentation:
    """The same segments, each called as most of its frames are in ``labels``.

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


def _searched(
    segmentation: Segmentation,
    features: Floats,
    knowledge: KnowledgeBase,
    threshold: float,
    *,
    spread: bool,
) -> Segmentation:
    """What is known, found in a recording without activities; the same segments if nothing is."""
    found = found_by_search(features, knowledge, threshold)
    result = segmented_as_found(segmentation, found) if found else segmentation
    labels = np.array([match.label for match in found], np.str_)
    costs = np.array([match.distance for match in found])
    provenance = _provenance(segmentation, labels, costs, threshold, spread=spread)
    return replace(result, provenance=provenance, hierarchy=None)


def _checked(features: ArrayLike, segmentation: Segmentation) -> Floats:
    array = as_floats(features, "features")
    expected = segmentation.n_frames * FPS / segmentation.fps
    if array.ndim != 2 or abs(len(array) - expected) > 2:
        raise ParameterError(
            f"features have the shape {array.shape}, the recording {expected:.0f} frames at "
            f"{FPS:g} Hz: make them with transfer_features()"
        )
    return array


def _primitives(rows: SegmentTable, features: Floats, fps: float) -> Primitives:
    """The rows with their frames; those of a cluster that touch are a run."""
    starts, stops = working_frames(rows, fps, len(features))
    follows = (rows.start_frame[1:] == rows.stop_frame[:-1]) & (
        rows.cluster[1:] == rows.cluster[:-1]
    )
    frames = np.concatenate([features[a:b] for a, b in zip(starts, stops, strict=True)])
    return Primitives(frames, stops - starts, np.concatenate([[0], np.cumsum(~follows)]))


def _provenance(
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
