"""The accuracies of the published protocols, as their authors coded them.

They are here to be comparable, not to be trusted: `strict_and_tolerant`
never looks at clusters and rises with every cut. Uniform cuts twice a second
pass every published method.

Sources: Vögele, Krüger, Klein 2014, section 5.1, and the authors' program of
2017; for `majority_accuracy` arXiv 2308.14865. The program's spans are
closed and share their border frames: ``[start, stop)`` of this package is
``start .. min(stop, frames - 1)`` there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.evaluation.annotation import Annotation
from kineme.evaluation.labelling import TRANSITION, Ints, Labelling


def strict_and_tolerant(truth: Annotation, found: Labelling) -> tuple[float, float]:
    """Shares of the truth covered, with and without the uncertain spans.

    Every found activity goes to the interval of the truth that it overlaps
    most (the first of equals; uncertain spans are intervals too). For each
    interval the hull of its activities is intersected with it. Strict: the
    sum of these intersections over the sum of all lengths. Tolerant: the same
    over the actions alone. Labels play no part.

    Parameters
    ----------
    truth : Annotation
        Of one recording at one frame rate.
    found : Labelling
        See `truth`.
    """
    start, stop, certain = _closed_spans(truth)
    first = found.starts
    last = np.minimum(found.stops, found.frames - 1)
    overlap = np.minimum(last[:, None], stop) - np.maximum(first[:, None], start) + 1
    owner = np.argmax(np.maximum(overlap, 0), axis=1)
    covered = np.zeros(start.size)
    for i in np.unique(owner):
        own = owner == i
        hull = min(stop[i], last[own].max()) - max(start[i], first[own].min()) + 1
        covered[i] = max(0, hull)
    length = stop - start + 1
    return (
        float(covered.sum() / length.sum()),
        float(covered[certain].sum() / length[certain].sum()),
    )


def majority_accuracy(truth: Annotation, found: Labelling) -> tuple[float, float]:
    """Shares of frames labelled right, of all frames and outside the uncertain spans.

    A cluster takes the class that more than half of its frames have, else
    ``transition``. Cutting into many clusters is not punished.
    """
    wanted = truth.labelling().per_frame()
    names = found.per_frame()
    given = np.full(names.shape, TRANSITION, dtype=object)
    for name in set(found.labels):
        own = names == name
        classes, counts = np.unique(wanted[own].astype(str), return_counts=True)
        if 2 * counts.max() > own.sum():
            given[own] = classes[np.argmax(counts)]
    right = given == wanted
    return float(right.mean()), float(right[wanted != TRANSITION].mean())


def _closed_spans(truth: Annotation) -> tuple[Ints, Ints, NDArray[np.bool_]]:
    """First and last frames of actions and uncertain spans in turn, and which are actions."""
    marks = np.stack([truth.earliest, truth.latest], axis=1).ravel()
    start = np.concatenate([[0], marks])
    stop = np.concatenate([marks, [truth.frames - 1]])
    certain = np.zeros(start.size, np.bool_)
    certain[::2] = [label != TRANSITION for label in truth.labels]
    return start, stop, certain
