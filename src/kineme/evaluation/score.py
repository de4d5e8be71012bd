"""Define scores, register them, and compute all scores of one result, for tables and files.

A score is a function of a `Comparison` of truth and result. It returns a number for one recording,
or None if it is undefined. Over a folder, numbers are averaged. If a function returns a `Ratio`,
parts and totals are summed over the recordings first, so long recordings have more weight.

Other packages add scores with `register`, or through the entry point group ``kineme.scores``.

Undefined scores are nan in Python, empty in CSV and Markdown, and null in JSON.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple, Protocol, get_args

from numpy.typing import ArrayLike

from kineme._util.checks import Registry, check_one_of
from kineme._util.files import atomic_write
from kineme._version import __version__
from kineme.errors import KinemeError, KinemeWarning, WriteError
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.truth import Labelling, Truth
from kineme.labels.delimited import open_new_text, write_rows
from kineme.segments.segmentation import Segmentation

Counted = Literal["frames", "segments", "borders", "repetitions", "clusters", "published protocols"]
OUTPUTS = (".json", ".csv")
DISAGREEMENT = 0.2
"""Difference of border F1 and Edit above which a table has an explanation."""
COST = {"seconds": "seconds", "seconds_per_hour": "seconds per hour"}
"""Run times, which are shown below the scores."""


class Ratio(NamedTuple):
    """A score that is a part of a total, such as right frames of all frames.

    Examples
    --------
    >>> Ratio(9, 12).value
    0.75
    """

    part: float
    total: float

    @property
    def value(self) -> float:
        """Return part / total; nan if the total is 0."""
        return self.part / self.total if self.total else math.nan


Value = float | Ratio | None


@dataclass(frozen=True)
class Score:
    """A measure of a result against a truth.

    Parameters
    ----------
    name : str
        Name in JSON and CSV, such as ``f1@50``.
    title : str
        Title in tables, such as ``F1@50``.
    help : str
        What it measures, in a sentence.
    level : str
        What is counted: "frames", "segments", "borders", "repetitions" or "clusters"; or
        "published protocols". Tables are grouped by it.
    function : callable
        Returns a number or a `Ratio` for a `Comparison`; None if undefined.

    Examples
    --------
    >>> import numpy as np
    >>> score = scores()["mof"]
    >>> score.title, score.level
    ('MoF', 'frames')
    >>> walk, run, other = 0, 1, 7
    >>> compared = Comparison(np.array([walk, walk, run]), np.array([other, other, other]), fps=1)
    >>> round(get_value(score.function(compared)), 3)
    0.667
    """

    name: str
    title: str
    help: str
    level: Counted
    function: Callable[[Comparison], Value]

    def __post_init__(self) -> None:
        check_one_of(self.level, get_args(Counted), f"level of {self.name!r:.60}")


SCORES: Registry[Score] = Registry(
    Score,
    "score",
    "kineme.scores",
    home="kineme.evaluation",
    builtins=("measures:SCORES",),
)
"""Scores by name, in display order."""


def scores() -> Mapping[str, Score]:
    """Return the scores by name, the package's own first.

    Returns
    -------
    Mapping of str to Score
        In display order.

    Examples
    --------
    >>> list(scores())[:3]
    ['mof', 'one_to_one', 'one_to_one_agreed']
    """
    return SCORES


def register(new: Score, *, replace: bool = False) -> None:
    """Register a score for `kineme evaluate`.

    Parameters
    ----------
    new : Score
    replace : bool
        Whether it may replace a score of the same name.

    Raises
    ------
    ParameterError
        A score of this name exists, or the argument is not a Score.

    Examples
    --------
    >>> def cuts_per_minute(compared):
    ...     return 60 * (len(compared.found_runs) - 1) * compared.fps / len(compared.found)
    >>> title, help = "cuts a minute", "how often the result changes"
    >>> register(Score("cuts", title, help, "borders", cuts_per_minute))
    >>> get_value(scores()["cuts"].function(Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=2)))
    30.0
    >>> SCORES.remove("cuts")
    """
    SCORES.register(new, replace=replace)


def compute_results(compared: Comparison) -> dict[str, float | Ratio]:
    """Compute all scores of a comparison by name, without undefined ones.

    A score that fails is left out, with a `KinemeWarning`.
    """
    found = {name: _compute_result(score, compared) for name, score in scores().items()}
    return {name: result for name, result in found.items() if result is not None}


def compute_scores(compared: Comparison) -> dict[str, float]:
    """Compute all scores of a comparison as numbers, by name."""
    return {name: get_value(result) for name, result in compute_results(compared).items()}


def evaluate(
    truth: Truth | Segmentation,
    found: Segmentation | Labelling,
    *,
    positions: ArrayLike | None = None,
    features: ArrayLike | None = None,
) -> dict[str, float]:
    """Compute all scores of a result by name, in display order; 1 is best, except as noted.

    Scores of frames and clusters use the clusters of activities if any activity has a cluster or
    label, and otherwise those of primitives. The cluster of a segment without one is its label, or
    else unique. Scores of repetitions use the primitives. Frames before the first and after the
    last action of the truth do not count. Names that end in ``ratio`` are found over true numbers.
    ``count_error`` (best at 0) and ``count_exact`` need counts in the truth, ``repetition_f1``
    needs repetitions.

    Parameters
    ----------
    truth : Truth or Segmentation
        A `Truth` is compared at its own frame rate, labels at 30 Hz, or at the result's rate if
        that is lower.
    found : Segmentation or Labelling
        The result.
    positions : array_like, (frames, joints, 3), optional
        Metres, y up, at the rate of comparison.
    features : array_like, (frames, dims), optional
        Stacked, at the rate of comparison.

    Raises
    ------
    ParameterError
        The result or data have another length than the truth, or the truth has no activity.

    Examples
    --------
    >>> truth = Truth(("walk", "run"), [40], [50], [60], frames=100, fps=30)
    >>> found = Labelling.from_cuts([48], ["0", "1"], frames=100, fps=30)
    >>> result = evaluate(truth, found)
    >>> result["border_f1"], round(result["one_to_one"], 2)
    (1.0, 0.8)
    """
    compared = Comparison.of(truth, found, positions=positions, features=features)
    return compute_scores(compared.without_silence())


def get_value(result: Value) -> float:
    """Convert a number or ratio to a number; None to nan."""
    number = result.value if isinstance(result, Ratio) else result
    return math.nan if number is None else float(number)


def pool_scores(results: Iterable[Value]) -> float:
    """Pool the results of many recordings: the ratio of sums for ratios, the mean for numbers.

    Examples
    --------
    >>> pool_scores([Ratio(1, 10), Ratio(9, 10)]), pool_scores([0.2, 0.4])
    (0.5, 0.30000000000000004)
    """
    kept = list(results)
    # Ratios are pooled by their sums.
    ratios = [result for result in kept if isinstance(result, Ratio)]
    if ratios:
        return Ratio(sum(r.part for r in ratios), sum(r.total for r in ratios)).value
    # Leave out recordings for which the score is undefined.
    numbers = [value for value in map(get_value, kept) if math.isfinite(value)]
    return sum(numbers) / len(numbers) if numbers else math.nan


def _compute_result(score: Score, compared: Comparison) -> Value:
    try:
        return score.function(compared)
    except KinemeError:
        raise
    except Exception as error:  # noqa: BLE001 (scores of other packages may raise anything)
        reason = f"{type(error).__name__}: {error}"
        text = f"the score {score.name!r:.60} was left out, since it failed: {reason:.200}"
        warnings.warn(text, KinemeWarning, stacklevel=2)
        return None


def choose_number(
    measure: Callable[[Comparison], Sequence[float] | None], number: int
) -> Callable[[Comparison], float | None]:
    """Return a score function that selects one of several numbers computed together."""

    def function(compared: Comparison) -> float | None:
        numbers = compared.once(measure)
        return None if numbers is None else numbers[number]

    return function


def make_score_rows(
    columns: Mapping[str, Mapping[str, float]],
) -> list[tuple[str, list[tuple[str, list[str]]]]]:
    """Return groups of rows to print: the title of each group, and name and cells of each row.

    ``columns`` are scores by column title. Scores that are undefined in all columns are left out.
    """
    titles: dict[str, dict[str, str]] = {}
    for name, score in scores().items():
        titles.setdefault(score.level, {})[name] = score.title
    groups = []
    for group, names in {**titles, "cost": COST}.items():
        rows = [
            (title, [format_score(values.get(name, math.nan)) for values in columns.values()])
            for name, title in names.items()
            if any(math.isfinite(values.get(name, math.nan)) for values in columns.values())
        ]
        if rows:
            groups.append((group, rows))
    return groups


def explain_disagreement(columns: Mapping[str, Mapping[str, float]]) -> str:
    """Return why scores of borders and of classes disagree, or "" if they do not."""
    for values in columns.values():
        by_class = values.get("edit", math.nan)
        # The comparison is False for nan.
        if values.get("border_f1", math.nan) - by_class > DISAGREEMENT:
            return (
                "The borders are better than the classes: Edit, F1@k and frame accuracy "
                "also need the right class, and each cluster is matched with one label. "
                "Look for labels that share a cluster or have several."
            )
    return ""


def format_score(value: float) -> str:
    """Format a score with three decimals; empty for nan."""
    return f"{value:.3f}" if math.isfinite(value) else ""


def write_records(records: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write records as JSON (with the version) or CSV, by suffix."""
    suffix = path.suffix.lower()
    if suffix not in OUTPUTS:
        raise WriteError(path, f"scores are written as {' or '.join(OUTPUTS)}")
    with open_new_text(path, newline="\n" if suffix == ".json" else "") as file:
        if suffix == ".json":
            file.write(f"{format_json(records)}\n")
        else:
            names = list(dict.fromkeys(name for record in records for name in record))
            rows = map(to_plain, records)
            write_rows(file, names, ([row.get(name) for name in names] for row in rows))


def format_json(records: Sequence[Mapping[str, Any]]) -> str:
    """Format records as one JSON object, with the version."""
    content = {"kineme": __version__, "scores": [to_plain(record) for record in records]}
    return json.dumps(content, indent=1, ensure_ascii=False)


class Result(Protocol):
    """Interface of results over a folder."""

    def to_json(self) -> str: ...

    def records(self) -> Sequence[Mapping[str, Any]]: ...


def write_result(result: Result, path: Path) -> None:
    """Write all of a result as JSON, or its records as CSV, by suffix."""
    if path.suffix.lower() != ".json":
        write_records(result.records(), path)
        return
    with atomic_write(path) as draft:
        draft.write_text(f"{result.to_json()}\n", encoding="utf-8")


def to_finite(value: Any) -> Any:
    """Return the value, or None for nan and infinity."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def to_plain(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return the record with None in place of nan and infinity."""
    return {name: to_finite(value) for name, value in record.items()}
