"""Renumber the clusters of segmentations, so that equal numbers are equal movements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from hashlib import sha256
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Ints
from kineme.errors import ParameterError
from kineme.features.canonical import MATCHING_FPS, compute_features_and_poses
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import to_samples
from kineme.segments.editing.borders import renumber_clusters
from kineme.segments.segmentation import Segmentation
from kineme.transfer.clusters import (
    CONSTANTS,
    ClusterSet,
    Features,
    LocalCluster,
    assign_to_centres,
    find_local_clusters,
    find_samples_in,
    keep_numbers,
    link_clusters,
    list_spans,
)
from kineme.transfer.embeddings import (
    ChannelSamples,
    compute_channel_samples,
    embedding,
    fit_units,
    thin_samples,
)
from kineme.transfer.matching import THRESHOLD


def share_clusters(
    recordings: Sequence[Motion] | Sequence[Signals],
    segmentations: Sequence[Segmentation],
    *,
    threshold: float = THRESHOLD,
    n_clusters: int | None = None,
) -> list[Segmentation]:
    """Renumber clusters, so that equal numbers are equal movements in all recordings.

    Clusters of motions are merged if a search finds them in each other. Clusters of the first
    recording keep their numbers; others get new ones.

    For signals, the samples of all recordings are clustered together. Each activity takes the
    nearest of these clusters, and repetitions that of their activity.

    Parameters
    ----------
    recordings : sequence of Motion or of Signals
        Signals must have the same channels.
    segmentations : sequence of Segmentation
        One for each recording; labels are neither used nor changed.
    threshold : float
        For motions: largest mean distance at which clusters are merged.
    n_clusters : int, optional
        For signals: number of clusters; estimated by default.

    Raises
    ------
    EndEffectorError
        Head, hands or feet were not found.
    ParameterError
        The segmentations do not belong to the recordings, channels differ, or there are both
        motions and signals.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> from kineme.transfer import share_clusters
    >>> motion = kineme.read(bundled_recording())
    >>> truth = kineme.read_segments(bundled_truth(), fps=motion.fps, n_frames=motion.n_frames)
    >>> one, other = share_clusters([motion, motion], [truth, truth])
    >>> other.repetitions() == one.repetitions()
    True
    """
    if [r.n_frames for r in recordings] != [s.n_frames for s in segmentations]:
        raise ParameterError(
            f"segments of {[s.n_frames for s in segmentations]} frames do not match "
            f"recordings of {[r.n_frames for r in recordings]}"
        )
    signals = [each for each in recordings if isinstance(each, Signals)]
    if not signals:
        motions = [each for each in recordings if isinstance(each, Motion)]
        return _share_by_search(motions, segmentations, threshold)
    if len(signals) < len(recordings):
        raise ParameterError("clusters can be shared between motions or between signals, not both")
    samples = [compute_channel_samples(each) for each in signals]
    return share_by_samples(samples, segmentations, n_clusters=n_clusters)


def assign_to_labels(
    signals: Signals, labels: Ints, others: Signals, spans: Sequence[tuple[int, int]]
) -> Ints:
    """Label each span of other signals by the label whose samples are nearest on average.

    ``labels`` (frames,) are those of ``signals``; ``spans`` are frames [start, stop) of ``others``.
    Raise ParameterError if the channels differ.
    """
    if signals.names != others.names:
        raise ParameterError(
            f"signals have the channels {', '.join(others.names)}, not {', '.join(signals.names)}"
        )
    known, new = compute_channel_samples(signals).rows, compute_channel_samples(others).rows
    # Both are scaled by the labelled signals.
    to_features = fit_units(known)
    points, unknown = to_features(known), to_features(new)
    frames = np.rint(known[:, 0] * signals.fps).astype(np.intp)
    sample_labels = labels[np.minimum(frames, len(labels) - 1)]
    distinct = np.unique(sample_labels)
    centres = np.array([points[sample_labels == label].mean(axis=0) for label in distinct])
    means = [
        unknown[find_samples_in(new[:, 0], np.array([span]) / others.fps)].mean(axis=0)
        for span in spans
    ]
    distances = ((np.array(means)[:, None] - centres) ** 2).sum(axis=2)
    return np.asarray(distinct[distances.argmin(axis=1)], np.int64)


def _share_by_search(
    motions: Sequence[Motion], segmentations: Sequence[Segmentation], threshold: float
) -> list[Segmentation]:
    """Return segmentations of bodies with common cluster numbers; see `link_clusters`."""
    # Features for the search, and poses for embeddings.
    described = [compute_features_and_poses(motion) for motion in motions]
    local = [
        each
        for number, found in enumerate(segmentations)
        for each in find_local_clusters(found.table, number)
    ]

    def cut_span(values: NDArray[Any], span: tuple[float, float]) -> NDArray[Any]:
        """Return the samples of a span in seconds."""
        return values[slice(*to_samples(span, MATCHING_FPS, len(values)))]

    def load(each: LocalCluster) -> Features:
        features, _ = described[each.recording]
        return cut_span(features, each.example), cut_span(features, each.context)

    embeddings = [
        embedding(cut_span(described[each.recording][1], (each.start_s, each.stop_s)))
        for each in local
    ]
    clusters = ClusterSet(local, np.array(embeddings), load)
    constants = replace(CONSTANTS, join=threshold)
    keys = [str(number) for number in range(len(motions))]
    # Common cluster of each local cluster, as a renumbering of each recording.
    shared = link_clusters(clusters, keys, constants).cluster.tolist()
    numbers: list[dict[int, int]] = [{} for _ in motions]
    for each, cluster in zip(local, shared, strict=True):
        numbers[each.recording][each.cluster] = cluster
    result = [renumber_clusters(*each) for each in zip(segmentations, numbers, strict=True)]
    if not result:
        return result
    # Clusters of the first recording keep the numbers that they had.
    first = segmentations[0].table
    kept_numbers = keep_numbers(
        {0: list_spans(first.columns(), first.cluster)},
        {i: list_spans(r.table.columns(), r.table.cluster) for i, r in enumerate(result)},
        next_number=int(first.cluster.max()) + 1,
    )
    return [renumber_clusters(each, kept_numbers) for each in result]


def share_by_samples(
    samples: Sequence[ChannelSamples],
    segmentations: Sequence[Segmentation],
    *,
    n_clusters: int | None = None,
) -> list[Segmentation]:
    """Share clusters of signals, from their samples; see `share_clusters`."""
    for each in samples:
        if each.names != samples[0].names:
            raise ParameterError(
                "clusters can only be shared between recordings with the same channels, "
                f"not {', '.join(samples[0].names):.80} and of {', '.join(each.names):.80}"
            )
    rows = [each.rows for each in samples]
    # Sums depend on the order of recordings: sort them by content.
    order = sorted(range(len(rows)), key=lambda i: sha256(rows[i].tobytes()).digest())
    activities = [segmentations[i].activities for i in order]
    assigned = assign_to_centres(
        [partial(thin_samples, rows[i]) for i in order],
        [len(rows[i]) for i in order],
        [[np.array([[row.start_s, row.stop_s]]) for row in each] for each in activities],
        n_clusters=n_clusters,
    ).cluster
    parts = np.split(assigned, np.cumsum([len(each) for each in activities])[:-1])
    shared = list(segmentations)
    for i, clusters in zip(order, parts, strict=True):
        found, table = segmentations[i], segmentations[i].table
        # Rows of both levels take the cluster of their activity, except transitions.
        action = np.where(found.activities.kind == "activity", clusters, -1)[table.activity]
        cluster = np.where(table.kind != "transition", action, -1)
        changed = table.with_columns(cluster=cluster, action=action)
        shared[i] = replace(found, table=changed, hierarchy=None)
    return shared
