"""Which label each segment takes, of those that its matches have, and with what confidence."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.segments.segmentation import Segmentation
from kineme.transfer.knowledge import KnowledgeBase
from kineme.transfer.matching import Floats, Primitives, label_costs

REACH = 2.0
"""Thresholds up to which a match with the next label is looked for."""
SIMILAR = 0.6
"""Cost up to which the repetitions of one person are the same movement."""


def costs_of(
    unknown: Primitives, knowledge: KnowledgeBase, radius: float
) -> tuple[Floats, NDArray[np.str_]]:
    """Costs (primitives, names), and the names; what has no valid path costs the radius."""
    names, codes = np.unique(knowledge.labels, return_inverse=True)
    costs = label_costs(unknown, knowledge.primitives(), codes, len(names), radius=radius)
    return np.minimum(costs, radius), names


def cheapest(
    costs: Floats, names: NDArray[np.str_], threshold: float
) -> tuple[NDArray[Any], Floats, Floats]:
    """Label, margin and cost of each row; empty and nan where nothing is within the threshold."""
    best = costs.argmin(axis=1)
    cost = costs[np.arange(len(costs)), best]
    others = costs.copy()
    others[np.arange(len(costs)), best] = np.inf
    # With one label alone the radius stands for the next: nothing dearer was looked at.
    following = np.minimum(others.min(axis=1), REACH * threshold)
    margin = 1 - cost / np.maximum(following, 1e-12)
    valid = cost <= threshold
    return (
        np.where(valid, names[best].astype(object), ""),
        np.where(valid, margin, np.nan),
        np.where(valid, cost, np.nan),
    )


def another_movement(
    labels: NDArray[Any], costs: Floats, movements: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Which rows are not, by their person's own standard, what bears their name in the recording.

    That is the movement of the cheapest match; another one keeps the name only where it is as near
    to the knowledge as one person's repetitions are to each other.
    """
    other = np.zeros(len(labels), np.bool_)
    for label in set(labels.tolist()) - {""}:
        named = np.flatnonzero(labels == label)
        first = named[costs[named].argmin()]
        other[named] = (movements[named] != movements[first]) & (costs[named] > SIMILAR)
    return other


def spread_in_clusters(
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


def activity_labels(segmentation: Segmentation, labels: NDArray[Any]) -> list[str]:
    """The label of each activity: its own, else that of more than half of its frames."""
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
