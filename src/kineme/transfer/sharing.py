"""One number for one movement, over several recordings.

Recording by recording, clusters of bodies are looked for in those before as label
transfer looks for labels, with the clusters' numbers for names. Those of signals are
found anew over all recordings, see `kineme.transfer.vocabulary`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ParameterError
from kineme.recordings import Motion, Signals
from kineme.segments.editing.rows import renumber_clusters
from kineme.segments.segmentation import Segmentation
from kineme.transfer.channel_samples import channel_samples
from kineme.transfer.features import transfer_features
from kineme.transfer.knowledge import KnowledgeBase
from kineme.transfer.labels import transfer_labels
from kineme.transfer.matching import THRESHOLD
from kineme.transfer.vocabulary import share_by_samples


def share_clusters(
    recordings: Sequence[Motion] | Sequence[Signals],
    segmentations: Sequence[Segmentation],
    *,
    threshold: float = THRESHOLD,
    n_clusters: int | None = None,
) -> list[Segmentation]:
    """Return the same segments, in which equal cluster numbers are equal movements everywhere.

    Of motions the clusters of the first keep their numbers. A later cluster takes the number that
    most of its members match in the recordings before, if more than half match it. Of two clusters
    of one recording only the one with more matches takes it. All others are numbered on.

    Of signals each activity takes one of the clusters that the samples of all recordings
    have together; repetitions have the cluster of their activity.

    Parameters
    ----------
    recordings : sequence of Motion or of Signals
        Signals of the same channels.
    segmentations : sequence of Segmentation
        One for each; labels are neither used nor changed.
    threshold : float
        Of motions, largest cost of a match; see `transfer_labels`.
    n_clusters : int, optional
        Of signals, how many clusters to tell apart; found out by default.

    Returns
    -------
    list of Segmentation

    Raises
    ------
    EndEffectorError
        Head, hands or feet were not found.
    ParameterError
        Other segmentations than the recordings', signals of other channels, or both
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
            f"segments of {[s.n_frames for s in segmentations]} frames do not belong to recordings "
            f"of {[r.n_frames for r in recordings]}"
        )
    signals = [each for each in recordings if isinstance(each, Signals)]
    if not signals:
        motions = [each for each in recordings if isinstance(each, Motion)]
        return _numbered_on(motions, segmentations, threshold)
    if len(signals) < len(recordings):
        raise ParameterError("clusters are shared over motions or over signals, not over both")
    samples = [channel_samples(each) for each in signals]
    return share_by_samples(samples, segmentations, n_clusters=n_clusters)


def _numbered_on(
    motions: Sequence[Motion], segmentations: Sequence[Segmentation], threshold: float
) -> list[Segmentation]:
    """Return the clusters of motions by the numbers of those before, or by the next ones."""
    base: KnowledgeBase | None = None
    shared, following = [], 0
    for motion, found in zip(motions, segmentations, strict=True):
        old = sorted(set(found.table.cluster.tolist()) - {-1})
        numbers = _numbers_before(motion, found, base, threshold) if base else {}
        for cluster in old:
            if cluster not in numbers:
                numbers[cluster] = following if base else cluster
                following = max(following, numbers[cluster]) + 1
        shared.append(renumber_clusters(found, numbers))
        if old:
            named = _named_by_cluster(shared[-1])
            examples = KnowledgeBase.from_recording(motion, named)
            base = base + examples if base else examples
    return shared


def _numbers_before(
    motion: Motion, found: Segmentation, base: KnowledgeBase, threshold: float
) -> dict[int, int]:
    """Return the numbers of the clusters that are found in the knowledge."""
    unnamed = found.table.with_columns(label=np.full(len(found), ""))
    bare = replace(found, table=unnamed, hierarchy=None)
    named = transfer_labels(bare, transfer_features(motion), base, threshold=threshold)
    rows = named.primitives if len(named.primitives) else named.activities
    matches: list[tuple[int, int, int]] = []
    for cluster in sorted(set(rows.cluster.tolist()) - {-1}):
        cluster_labels = rows.label[rows.cluster == cluster].tolist()
        name, count = Counter(cluster_labels).most_common(1)[0]
        if name and count > len(cluster_labels) / 2:
            matches.append((-count, cluster, int(name)))
    numbers: dict[int, int] = {}
    for _, cluster, number in sorted(matches):
        if number not in numbers.values():
            numbers[cluster] = number
    return numbers


def _named_by_cluster(found: Segmentation) -> Segmentation:
    """Return every segment of a cluster labelled with its number, all others without label."""
    labels: NDArray[np.str_] = np.array(
        [str(c) if c >= 0 else "" for c in found.table.cluster.tolist()]
    )
    return replace(found, table=found.table.with_columns(label=labels), hierarchy=None)
