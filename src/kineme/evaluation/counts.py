"""Are repetitions counted right, where their true number is known?"""

from __future__ import annotations

import numpy as np

from kineme.errors import ParameterError
from kineme.evaluation.annotation import Annotation
from kineme.evaluation.labelling import TRANSITION, Labelling


def found_counts(truth: Annotation, primitives: Labelling) -> list[int]:
    """How many primitives have their middle in each action of the truth.

    Actions are cut at the mean marks; transitions are no primitives.

    Parameters
    ----------
    truth : Annotation
        Of one recording at one frame rate.
    primitives : Labelling
        See `truth`.
    """
    middles = [
        (start + stop) / 2
        for label, start, stop in zip(
            primitives.labels, primitives.starts, primitives.stops, strict=True
        )
        if label != TRANSITION
    ]
    borders = truth.at_means().borders
    return np.histogram(middles, bins=borders)[0].tolist() if middles else [0] * len(truth.labels)


def count_errors(truth: Annotation, primitives: Labelling) -> tuple[float, float]:
    """Mean difference from the true number of repetitions, and the share counted exactly.

    Parameters
    ----------
    truth : Annotation
        Of one recording at one frame rate.
    primitives : Labelling
        See `truth`.

    Raises
    ------
    ParameterError
        The truth knows no count.
    """
    errors = [
        abs(found - true)
        for found, true in zip(found_counts(truth, primitives), truth.counts, strict=False)
        if true is not None
    ]
    if not errors:
        raise ParameterError("the truth knows no number of repetitions")
    return float(np.mean(errors)), float(np.mean(np.array(errors) == 0))
