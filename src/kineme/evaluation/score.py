"""What a score is, and which there are: one object each, registered under its name.

A score compares the labels of a recording frame by frame (a `Comparison`): what people say,
and what a method found. Its function gives a number for one recording. Over a folder, numbers
are averaged; a function that gives a `Ratio` has its parts and wholes summed over the
recordings first, so that long recordings weigh more.

Other packages add scores by `register`, or by naming them in the entry point group
``kineme.scores``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple, get_args

from kineme._checks import check_one_of
from kineme._registry import Registry
from kineme.evaluation.comparison import Comparison

Counted = Literal["frames", "segments", "borders", "clusters"]


class Ratio(NamedTuple):
    """A score that is a part of a whole, such as frames right of all frames."""

    part: float
    whole: float

    @property
    def value(self) -> float:
        """The part over the whole; nan where there is no whole."""
        return self.part / self.whole if self.whole else math.nan


@dataclass(frozen=True)
class Score:
    """One way of judging a result.

    Parameters
    ----------
    name : str
        In JSON and CSV, such as ``f1@50``.
    title : str
        In tables, such as ``F1@50``.
    help : str
        What it measures, in a sentence.
    level : {"frames", "segments", "borders", "clusters"}
        What is counted; tables are grouped by it.
    function : callable
        From a `Comparison` to a number or a `Ratio`.

    Examples
    --------
    >>> import numpy as np
    >>> score = scores()["mof"]
    >>> score.title, score.level
    ('MoF', 'frames')
    >>> walk, run, other = 0, 1, 7
    >>> compared = Comparison(np.array([walk, walk, run]), np.array([other, other, other]), fps=1)
    >>> round(value_of(score.function(compared)), 3)
    0.667
    """

    name: str
    title: str
    help: str
    level: Counted
    function: Callable[[Comparison], float | Ratio]

    def __post_init__(self) -> None:
        check_one_of(self.level, get_args(Counted), f"level of {self.name!r:.60}")


SCORES: Registry[Score] = Registry(
    Score,
    "score",
    "kineme.scores",
    home="kineme.evaluation",
    own=("label_scores:SCORES", "segmental_scores:SCORES", "cut_scores:SCORES"),
)
"""In the order in which they are shown."""


def scores() -> Mapping[str, Score]:
    """The scores by name, the package's own first.

    Returns
    -------
    Mapping of str to Score
        In the order in which they are shown.

    Examples
    --------
    >>> list(scores())[:3]
    ['mof', 'one_to_one', 'ari']
    """
    return SCORES


def register(new: Score, *, replace: bool = False) -> None:
    """Make a score known to `kineme evaluate`.

    Parameters
    ----------
    new : Score
        What is added.
    replace : bool
        Whether it takes the place of a score of the same name.

    Raises
    ------
    ParameterError
        There is a score of this name, or it is none.
    """
    SCORES.register(new, replace=replace)


def value_of(result: float | Ratio) -> float:
    """The number that a score's function gave, be it one or a ratio."""
    return result.value if isinstance(result, Ratio) else float(result)


def over_all(results: Iterable[float | Ratio]) -> float:
    """One number for many recordings: of ratios the sums' ratio, of numbers the mean.

    Parameters
    ----------
    results : iterable
        What a score's function gave for each recording; nan is left out.

    Returns
    -------
    float
        nan where there is nothing to average.

    Examples
    --------
    >>> over_all([Ratio(1, 10), Ratio(9, 10)]), over_all([0.2, 0.4])
    (0.5, 0.30000000000000004)
    """
    kept = list(results)
    ratios = [result for result in kept if isinstance(result, Ratio)]
    if ratios:
        return Ratio(sum(r.part for r in ratios), sum(r.whole for r in ratios)).value
    numbers = [value for value in map(value_of, kept) if math.isfinite(value)]
    return sum(numbers) / len(numbers) if numbers else math.nan
