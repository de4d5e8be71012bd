"""Define scores, register them, and give all of one result, also as tables and in files.

A score is a function of a `Comparison`: what people say of a recording, and what a method found
there. It gives a number for one recording, or None where the two do not tell. Over a folder,
numbers are averaged; a function that gives a `Ratio` has its parts and totals summed over the
recordings first, so that long recordings weigh more.

Other packages add scores by `register`, or by naming them in the entry point group
``kineme.scores``.

nan, which a score is where it cannot be had, is empty in CSV and Markdown and null in JSON.
"""

from __future__ import annotations

import csv
import json
import math
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple, Protocol, get_args

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.checks import Registry, check_one_of
from kineme._util.files import atomic_write
from kineme._version import __version__
from kineme.errors import KinemeError, KinemeWarning, WriteError
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.label_truth import make_labelling
from kineme.evaluation.truth import Labelling, Truth
from kineme.formats.delimited import as_text
from kineme.segments.segmentation import Segmentation

Counted = Literal["frames", "segments", "borders", "repetitions", "clusters", "published protocols"]


class Ratio(NamedTuple):
    """A score that is a part of a total, such as frames right of all frames.

    Examples
    --------
    >>> Ratio(9, 12).value
    0.75
    """

    part: float
    total: float

    @property
    def value(self) -> float:
        """Return the part over the total; nan where there is none."""
        return self.part / self.total if self.total else math.nan


Value = float | Ratio | None


@dataclass(frozen=True)
class Score:
    """One measure of a result beside a truth.

    Parameters
    ----------
    name : str
        In JSON and CSV, such as ``f1@50``.
    title : str
        In tables, such as ``F1@50``.
    help : str
        What it measures, in a sentence.
    level : str
        What is counted: "frames", "segments", "borders", "repetitions" or "clusters"; or
        "published protocols". Tables are grouped by it.
    function : callable
        From a `Comparison` to a number or a `Ratio`; None where it cannot be had.

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
"""In the order in which they are shown."""


def scores() -> Mapping[str, Score]:
    """Return the scores by name, the package's own first.

    Returns
    -------
    Mapping of str to Score
        In the order in which they are shown.

    Examples
    --------
    >>> list(scores())[:3]
    ['mof', 'one_to_one', 'one_to_one_agreed']
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
    """Return all scores of a comparison by name, those left out that cannot be had.

    A score that fails costs itself only: a `KinemeWarning` names it.
    """
    found = {name: _compute_result(score, compared) for name, score in scores().items()}
    return {name: result for name, result in found.items() if result is not None}


def evaluate(
    truth: Truth,
    clusters: Labelling,
    *,
    activities: Labelling | None = None,
    primitives: Labelling | None = None,
    positions: ArrayLike | None = None,
    features: ArrayLike | None = None,
) -> dict[str, float]:
    """Return all scores by name, in reading order; best is 1 unless the name says otherwise.

    Scores of frames and clusters read ``clusters``; those of borders read ``activities``, those
    of repetitions ``primitives``. Names that end in ``ratio`` are found over true. ``count_error``
    and ``count_exact`` appear where the truth knows counts, ``repetition_f1`` where it has
    repetitions; of these ``count_error`` is best at 0.

    Parameters
    ----------
    truth : Truth
        What people say; its frame rate is the one of the comparison.
    clusters : Labelling
        Which frames are the same thing.
    activities : Labelling, optional
        Which spans are one activity; by default ``clusters``.
    primitives : Labelling, optional
        Single repetitions; by default ``clusters``.
    positions : array_like, (frames, joints, 3), optional
        Metres, y up, at the truth's frame rate.
    features : array_like, (frames, dims), optional
        Stacked, at the truth's frame rate.

    Returns
    -------
    dict of str to float

    Raises
    ------
    ParameterError
        Labels or data of another length than the truth.

    Examples
    --------
    >>> truth = Truth(("walk", "run"), [40], [50], [60], frames=100, fps=30)
    >>> found = Labelling.from_cuts([48], ["0", "1"], frames=100, fps=30)
    >>> result = evaluate(truth, found)
    >>> result["border_f1"], round(result["one_to_one"], 2)
    (1.0, 0.8)
    """
    compared = Comparison.of(
        truth,
        clusters,
        activities=activities,
        primitives=primitives,
        positions=positions,
        features=features,
    )
    return {name: get_value(result) for name, result in compute_results(compared).items()}


def evaluate_segmentation(
    truth: Truth,
    found: Segmentation,
    *,
    positions: ArrayLike | None = None,
    features: ArrayLike | None = None,
) -> dict[str, float]:
    """Return all scores of a segmentation; see `evaluate`.

    Its clusters are those of its activities where they have any (or labels), else those
    of its primitives. A segment in no cluster goes by its label, and without one is a cluster
    of its own.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.evaluation.label_truth import make_truth
    >>> labels = kineme.read_segments(bundled_truth())
    >>> truth = make_truth(labels, n_frames=labels.n_frames, fps=labels.fps)
    >>> evaluate_segmentation(truth, labels)["one_to_one"]
    1.0
    """
    compared = compare_with_truth(truth, found, positions=positions, features=features)
    return {name: get_value(result) for name, result in compute_results(compared).items()}


def compare_with_truth(
    truth: Truth,
    found: Segmentation,
    *,
    positions: ArrayLike | None = None,
    features: ArrayLike | None = None,
) -> Comparison:
    """A segmentation beside a truth; which of its clusters count, `evaluate_segmentation` says."""
    rows = found.activities
    activities = make_labelling(rows, fps=found.fps)
    primitives = make_labelling(found.primitives, fps=found.fps) if len(found.primitives) else None
    # Activities without clusters or labels say nothing: then primitives are compared.
    grouped = bool(np.any((rows.cluster >= 0) | (rows.label != "")))
    return Comparison.of(
        truth,
        activities if grouped or primitives is None else primitives,
        activities=activities,
        primitives=primitives,
        positions=positions,
        features=features,
    )


def get_value(result: Value) -> float:
    """Return the number that a score's function gave, be it one or a ratio; nan for None."""
    number = result.value if isinstance(result, Ratio) else result
    return math.nan if number is None else float(number)


def pool_scores(results: Iterable[Value]) -> float:
    """One number for many recordings: of ratios the sums' ratio, of numbers the mean.

    Examples
    --------
    >>> pool_scores([Ratio(1, 10), Ratio(9, 10)]), pool_scores([0.2, 0.4])
    (0.5, 0.30000000000000004)
    """
    kept = list(results)
    ratios = [result for result in kept if isinstance(result, Ratio)]
    if ratios:
        return Ratio(sum(r.part for r in ratios), sum(r.total for r in ratios)).value
    # A score that is not defined for a recording leaves it out.
    numbers = [value for value in map(get_value, kept) if math.isfinite(value)]
    return sum(numbers) / len(numbers) if numbers else math.nan


def _compute_result(score: Score, compared: Comparison) -> Value:
    try:
        return score.function(compared)
    except KinemeError:
        raise
    except Exception as error:  # noqa: BLE001 (whatever a stranger's score raises)
        reason = f"{type(error).__name__}: {error}"
        text = f"the score {score.name!r:.60} is left out, it fails: {reason:.200}"
        warnings.warn(text, KinemeWarning, stacklevel=2)
        return None


def choose_number(
    measure: Callable[[Comparison], Sequence[float] | None], number: int
) -> Callable[[Comparison], float | None]:
    """Return the function of a score that is one of several numbers which are computed together."""

    def function(compared: Comparison) -> float | None:
        numbers = compared.once(measure)
        return None if numbers is None else numbers[number]

    return function


OUTPUTS = (".json", ".csv")
DISAGREEMENT = 0.2
"""Border F1 above Edit by more than this is explained under the table."""
COST = {"seconds": "seconds", "seconds_per_hour": "seconds per hour"}
"""What a result cost: no score, but shown below them."""


def score_rows(
    columns: Mapping[str, Mapping[str, float]],
) -> list[tuple[str, list[tuple[str, list[str]]]]]:
    """Groups of rows ready to print: a group's title, and per row its name and cells.

    ``columns`` are scores by column title; those that are a number in none are left out.
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
        # False for nan.
        if values.get("border_f1", math.nan) - by_class > DISAGREEMENT:
            return (
                "Borders are better than classes: Edit, F1@k and shares of frames also need the "
                "right class, and a cluster stands for one label only. Look at labels that share a "
                "cluster, or one label that has several."
            )
    return ""


def format_score(value: float) -> str:
    """Return a score with three digits behind the point, empty for nan."""
    return f"{value:.3f}" if math.isfinite(value) else ""


def format_markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table whose first column is left-aligned, the others right."""
    lines = [header, ["---", *["---:"] * (len(header) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def write_records(records: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write records as JSON (with the version) or CSV, by suffix."""
    suffix = path.suffix.lower()
    if suffix not in OUTPUTS:
        raise WriteError(path, f"scores are written as {' or '.join(OUTPUTS)}")
    with (
        atomic_write(path) as draft,
        draft.open("w", encoding="utf-8", newline="\n" if suffix == ".json" else "") as file,
    ):
        if suffix == ".json":
            file.write(f"{format_json(records)}\n")
        else:
            rows = [to_plain(record) for record in records]
            names = list(dict.fromkeys(name for record in rows for name in record))
            table = csv.DictWriter(file, names, lineterminator="\n")
            table.writeheader()
            table.writerows(
                # Texts that look like formulas are protected for spreadsheets.
                {k: as_text(v) if isinstance(v, str) else v for k, v in record.items()}
                for record in rows
            )


def format_json(records: Sequence[Mapping[str, Any]]) -> str:
    """Records as one JSON object, with the version."""
    content = {"kineme": __version__, "scores": [to_plain(record) for record in records]}
    return json.dumps(content, indent=1, ensure_ascii=False)


class Result(Protocol):
    """What a run over a folder gives."""

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
    """Return the value; None in place of a number that cannot be had."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def to_plain(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return the record with None in place of numbers that cannot be had."""
    return {name: to_finite(value) for name, value in record.items()}
