"""Accuracies of the published protocols, as their authors coded them.

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

from kineme._util.arrays import Ints
from kineme.evaluation.comparison import Comparison, count_frames
from kineme.evaluation.score import Score, choose_number
from kineme.evaluation.truth import TRANSITION, UNLABELLED, Truth


def strict_and_tolerant(compared: Comparison) -> tuple[float, float]:
    """Return the covered shares of the truth, with and without the uncertain spans.

    Every found activity goes to the interval of the truth that it overlaps
    most (the first of equals; uncertain spans are intervals too). For each
    interval the hull of its activities is intersected with it. Strict: the
    sum of these intersections over the sum of all lengths. Tolerant: the same
    over the actions alone. Labels play no part.

    Examples
    --------
    >>> from kineme.evaluation import Labelling
    >>> truth = Truth(("walk", "run"), [40], [50], [60], frames=100, fps=30)
    >>> found = Labelling.from_cuts([50], ["0", "1"], frames=100, fps=30)
    >>> strict, tolerant = strict_and_tolerant(Comparison.of(truth, found))
    >>> round(strict, 2), round(tolerant, 2)
    (0.79, 1.0)
    """
    start, stop, certain = _closed_spans(compared.spans.actions)
    found = compared.spans.activities
    first = found.starts
    # Closed spans, as in the authors' program: each ends on the first frame of the next.
    last = np.minimum(found.stops, found.frames - 1)
    owner = np.array(
        [
            # Length of the overlap in frames of closed spans; `argmax` takes the first of equals.
            np.argmax(np.maximum(np.minimum(b, stop) - np.maximum(a, start) + 1, 0))
            for a, b in zip(first, last, strict=True)
        ]
    )
    covered = np.zeros(start.size)
    for i in np.unique(owner):
        rows = owner == i
        # The hull of all activities of the interval, cut to it; + 1 for closed spans.
        hull = min(stop[i], last[rows].max()) - max(start[i], first[rows].min()) + 1
        covered[i] = max(0, hull)
    length = stop - start + 1
    return (
        float(covered.sum() / length.sum()),
        float(covered[certain].sum() / length[certain].sum()),
    )


def majority_accuracy(compared: Comparison) -> tuple[float, float]:
    """Return the shares of right frames, of all frames and outside the uncertain spans.

    A cluster takes the class that more than half of its frames have, else
    none. Cutting into many clusters is not punished.

    Examples
    --------
    >>> majority_accuracy(Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=10))
    (0.75, 0.75)
    """
    clusters, classes, frames = count_frames(compared.found, compared.truth)
    most = frames.max(axis=1)
    # A class needs more than half of the cluster's frames.
    given = np.where(2 * most > frames.sum(axis=1), classes[frames.argmax(axis=1)], UNLABELLED)
    right = given[np.searchsorted(clusters, compared.found)] == compared.truth
    return float(right.mean()), float(right[compared.truth != UNLABELLED].mean())


def _closed_spans(truth: Truth) -> tuple[Ints, Ints, NDArray[np.bool_]]:
    """First and last frames of actions and uncertain spans in turn, and which are actions."""
    # Each border gives two marks: actions and uncertain spans alternate.
    borders = np.stack([truth.earliest, truth.latest], axis=1).ravel()
    start = np.concatenate([[0], borders])
    stop = np.concatenate([borders, [truth.frames - 1]])
    certain = np.zeros(start.size, np.bool_)
    # Every second span, from the first on, is an action.
    certain[::2] = [label != TRANSITION for label in truth.labels]
    return start, stop, certain


SCORES = (
    Score("strict", "strict", "share of the truth that is covered", "published protocols",
          choose_number(strict_and_tolerant, 0)),
    Score("tolerant", "tolerant", "strict, without the spans in which borders are uncertain",
          "published protocols", choose_number(strict_and_tolerant, 1)),
    Score("majority", "majority",
          "share of frames right, a cluster being what most of its frames are",
          "published protocols", choose_number(majority_accuracy, 0)),
    Score("majority_agreed", "majority, agreed", "majority, of frames on which people agree",
          "published protocols", choose_number(majority_accuracy, 1)),
)  # fmt: skip
