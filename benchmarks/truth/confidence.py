"""Check the confidence on sources that it was not learnt from, and learn its constants.

    python -m benchmarks confidence [--every N] [--near S] [--record]

The truth says whether a cluster, a border, a count and a cut between two repetitions is right. A
logistic function of statistics (``methods/kineme/confidence.py``) predicts the probability, for
bodies and for signals separately. Each source is predicted from all others, with equal weight for
each source. What does not beat one probability for all is not shown to users. The last lines are
the constants learnt from all sources, which ``methods/kineme/confidence.py`` contains.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from itertools import chain, pairwise
from multiprocessing import get_context
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from scipy.special import expit
from sklearn.metrics import roc_auc_score

import kineme
from _figures import add_option, record
from _options import choose_size, find_data, make_parser
from _recordings import (
    ACTORS,
    CONDITIONS,
    Case,
    join_hdm05,
    read_exercises,
    read_rows,
    read_subject_86,
    synthesize_cases,
)
from _sources import NEAR_S, join_sessions
from kineme.evaluation.folder import find_recordings
from kineme.methods.base import Columns
from kineme.methods.kineme.pipeline import KinemeFound
from kineme.methods.segmenter import segment_and_found
from kineme.recordings import Motion, Signals
from sets import read_sensors

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Numbers = tuple[float, ...]

PROMISED = {"border of bodies": 0.80, "border of signals": 0.80}
"""Minimum area under the ROC curve (AUC)."""
SURE = 0.9
CUT_TOLERANCE = 0.25
"""Tolerance of a cut, as a share of the longer adjacent repetition."""
RIDGE = 1.0


@dataclass(frozen=True)
class Truth:
    """Known truth of a recording, in seconds.

    Attributes
    ----------
    actions : list of (start, stop, label)
    counts : list of int or None
        Repetitions of each action; None if unknown.
    borders : list of (earliest, latest)
    cuts : array, optional
        Where repetitions begin.
    strides : pair of arrays, optional
        Middles of the swings of each foot.
    """

    actions: list[tuple[float, float, str]] = field(default_factory=list)
    counts: list[int | None] = field(default_factory=list)
    borders: list[tuple[float, float]] = field(default_factory=list)
    cuts: Floats | None = None
    strides: tuple[Floats, Floats] | None = None


class Row(NamedTuple):
    """Statistics of a found cluster, border, count or cut, and whether it is right."""

    kind: str
    source: str
    statistics: tuple[float, ...]
    right: bool


class Table(NamedTuple):
    """All rows of one kind; ``statistics`` (rows, statistics)."""

    sources: NDArray[np.str_]
    statistics: Floats
    right: Bools


Known = Iterator[tuple[Motion | Signals, Truth]]


def read_cases(made: Iterator[Case]) -> Known:
    for case in made:
        yield case.motion, convert_truth(case)


def convert_truth(case: Case) -> Truth:
    known, fps = case.truth, case.truth.fps
    edges = (known.at_means().borders / fps).tolist()
    return Truth(
        [(*span, name) for span, name in zip(pairwise(edges), known.labels, strict=True)],
        list(known.counts) or [None] * len(known.labels),
        list(zip(known.earliest / fps, known.latest / fps, strict=True)),
        None if case.made is None else case.made.primitives.start_s,
    )


def read_single_exercises(every: int) -> Known:
    """Yield recordings of a single exercise."""
    for actor in ACTORS:
        takes = list(chain.from_iterable(read_exercises(actor).values()))
        for one in takes[:: choose_size(every, 100)]:
            whole = [(0.0, one.motion.n_frames / one.motion.fps, one.name)]
            yield one.motion, Truth(whole, [one.repetitions])


def read_all_hdm05(every: int) -> Known:
    yield from read_cases(join_hdm05(60 // every))
    yield from read_cases(join_hdm05(45 // every, runs=10, repeats=(2, 3)))
    yield from read_single_exercises(every)


def make_all_synthetic(every: int) -> Known:
    for condition in CONDITIONS:
        yield from read_cases(synthesize_cases(condition, max(1, 10 // every)))


def join_all_sessions(every: int) -> Known:
    """Yield sessions of exercises, done correctly and incorrectly."""
    for name in ("uiprmd", "uiprmd_incorrect"):
        for _, motion, parts in join_sessions(name, choose_size(every, 10)):
            fps = motion.fps
            spans = [(part.start / fps, part.stop / fps, part.label) for part in parts]
            yield (
                motion,
                Truth(
                    spans,
                    [part.count for part in parts],
                    [(one[1], other[0]) for one, other in pairwise(spans)],
                    np.array([start for part in parts for start in part.starts]),
                ),
            )


def read_sensor_set(name: str, most: int, every: int) -> Known:
    """Yield evenly chosen recordings; gaps between labels are uncertain borders."""
    folder = find_data(f"sets/{name}")
    tables = {table: read_rows(folder / f"{table}.csv") for table in ("labels", "events")}
    counts = read_rows(folder / "counts.csv")
    paths = sorted((folder / "recordings").glob("*.parquet"))
    for at in np.unique(np.linspace(0, len(paths) - 1, choose_size(most // every, 2)).astype(int)):
        signals, stem = read_sensors(paths[at]), paths[at].stem
        stop = signals.n_frames / signals.fps
        if name == "barbell":
            yield signals, Truth([(0.0, stop, "")], [int(counts[stem][0]["nominal_count"])])
        else:
            yield signals, convert_labels(tables["labels"][stem], tables["events"][stem], stop)


def read_continuous(name: str, every: int) -> Known:
    """Yield uncut recordings of several activities."""
    folder = find_data(name)
    labels = read_rows(folder / "labels.csv")
    paths = [path for path in find_recordings(folder) if path.stem in labels]
    for path in paths[:: choose_size(every, 4)]:
        motion = kineme.read(path)
        yield motion, convert_labels(labels[path.stem], [], motion.n_frames / motion.fps)


def convert_labels(labels: list[Any], events: list[Any], stop: float) -> Truth:
    actions = [(float(row["start_s"]), float(row["stop_s"]), row["label"]) for row in labels]
    borders = [(one[1], other[0]) for one, other in pairwise(actions) if one[2] != other[2]]
    feet: dict[str, list[float]] = {"left": [], "right": []}
    for row in events:
        feet[row["foot"]].append((float(row["swing_start_s"]) + float(row["swing_stop_s"])) / 2)
    return Truth(
        actions,
        [None] * len(actions),
        [(0.0, actions[0][0]), *borders, (actions[-1][1], stop)],
        strides=(np.array(feet["left"]), np.array(feet["right"])) if events else None,
    )


KNOWN: Mapping[str, Callable[[int], Known]] = {
    "HDM05": read_all_hdm05,
    "hapt": partial(read_sensor_set, "hapt", 20),
    "hugadb": partial(read_sensor_set, "hugadb", 60),
    "UI-PRMD": join_all_sessions,
    "swimming": partial(read_sensor_set, "swimming", 20),
    "tug": partial(read_continuous, "bodies/tug"),
    "takes": partial(read_continuous, "rigs/takes"),
    "synthetic": make_all_synthetic,
    "utkinect": partial(read_sensor_set, "utkinect", 20),
    "ipolgait": partial(read_sensor_set, "ipolgait", 60),
    "mocap6": partial(read_continuous, "mocap6"),
    "subject 86": lambda _: read_cases(iter(read_subject_86())),
    "barbell": partial(read_sensor_set, "barbell", 40),
}
"""Sources of different people and devices, slowest first."""


class Segments(NamedTuple):
    """A segmentation in seconds.

    Attributes
    ----------
    edges, cuts : array
        Borders of activities and transitions, and of primitives.
    labels : (segments,) array
        Clusters, -1 for transitions.
    repeats : (primitives,) array of bool
        Whether each is a repetition or an event.
    parents : (primitives,) array
        Segment that contains each primitive.
    """

    edges: Floats
    cuts: Floats
    labels: NDArray[np.int64]
    repeats: Bools
    parents: NDArray[np.int64]

    @property
    def counts(self) -> NDArray[np.int64]:
        """Return the repetitions of each segment."""
        return np.bincount(self.parents[self.repeats], minlength=len(self.labels))

    def overlaps(self, truth: Truth) -> Floats:
        """Return the shared seconds of each segment (row) and each true action (column)."""
        spans = np.array([(start, stop) for start, stop, _ in truth.actions])
        inner = np.minimum.outer(self.edges[1:], spans[:, 1])
        inner -= np.maximum.outer(self.edges[:-1], spans[:, 0])
        return np.maximum(inner, 0)


def convert_columns(columns: Columns, fps: float) -> Segments:
    """Convert segment columns to seconds."""
    levels = [columns["level"] == level for level in ("activity", "primitive")]
    edges, cuts = (
        np.append(columns["start_frame"][rows], columns["stop_frame"][rows][-1]) / fps
        for rows in levels
    )
    clusters = np.where(columns["kind"] == "activity", columns["cluster"], -1)
    labels, repeats = (clusters[rows] for rows in levels)
    parents = np.searchsorted(edges, cuts[:-1], side="right") - 1
    return Segments(edges, cuts, labels, repeats >= 0, parents)


def judge(source: str, recording: Motion | Signals, truth: Truth, near_s: float) -> list[Row]:
    """Segment a recording and judge its clusters, borders, counts and cuts."""
    _, found = segment_and_found(recording)
    assert isinstance(found, KinemeFound)
    segments = convert_columns(found.columns(), found.preset.working_fps)
    shown = found.evidence
    # One repetition is not a count.
    of_counts = np.where(segments.counts < 2, np.nan, shown.repetition_similarity)
    judged = (
        ("cluster", (shown.preferred, shown.agreement), judge_clusters(truth, segments)),
        ("border", (shown.sharpness,), judge_borders(truth, segments, near_s)),
        ("count", (of_counts,), judge_counts(truth, segments)),
        ("cut", (shown.repetition_similarity[segments.parents],), judge_cuts(truth, segments)),
    )
    group = "signals" if isinstance(recording, Signals) else "bodies"
    return [
        Row(
            f"{kind} of {group}", source, tuple(float(each[at]) for each in statistics), bool(right)
        )
        for kind, statistics, of_kind in judged
        for at, right in of_kind
        if np.isfinite(statistics[0][at])
    ]


def judge_clusters(truth: Truth, found: Segments) -> Iterator[tuple[int, bool]]:
    """Yield each activity, and whether its cluster is matched to its main action.

    Clusters are matched to actions one to one so that they share the most time.
    """
    names = sorted({label for _, _, label in truth.actions})
    if len(names) < 2:
        return
    members = np.array([[label == name for name in names] for _, _, label in truth.actions])
    shared = found.overlaps(truth) @ members
    clusters = np.eye(int(found.labels.max()) + 2)[found.labels][:, :-1]
    stands_for = dict(zip(*linear_sum_assignment(-(clusters.T @ shared)), strict=True))
    for g, label in enumerate(found.labels.tolist()):
        if label >= 0 and shared[g].any():
            yield g, stands_for.get(label) == shared[g].argmax()


def judge_borders(truth: Truth, found: Segments, near_s: float) -> Iterator[tuple[int, bool]]:
    """Yield each border, and whether it is near a true one or between two actions."""
    if truth.borders:
        early, late = np.array(truth.borders).T
        for g, at in enumerate(found.edges[1:-1].tolist(), start=1):
            yield g, bool(((early - near_s <= at) & (at <= late + near_s)).any())


def judge_counts(truth: Truth, found: Segments) -> Iterator[tuple[int, bool]]:
    """Yield the main activity of each action, and whether its count there is right."""
    counts, activity = found.counts, found.labels >= 0
    if truth.strides is not None:
        for g in np.flatnonzero(activity):
            start, stop = found.edges[g : g + 2]
            feet = [int(((start <= foot) & (foot < stop)).sum()) for foot in truth.strides]
            if counts[g] > 1 or min(feet) > 1:
                yield g, min(feet) <= counts[g] <= max(feet)
        return
    middles = (found.cuts[:-1] + found.cuts[1:]) / 2
    shared = found.overlaps(truth) * activity[:, None]
    for action, (span, count) in enumerate(zip(truth.actions, truth.counts, strict=True)):
        g = int(shared[:, action].argmax())
        inside = (span[0] <= middles) & (middles < span[1]) & found.repeats & (found.parents == g)
        if count is not None and shared[g, action]:
            yield g, int(inside.sum()) == count


def judge_cuts(truth: Truth, found: Segments) -> Iterator[tuple[int, bool]]:
    """Yield each cut, and whether it is near the start of a true repetition."""
    if truth.cuts is None:
        return
    lengths = np.diff(found.cuts)
    for p in np.flatnonzero(np.diff(found.parents) == 0) + 1:
        near = CUT_TOLERANCE * max(lengths[p - 1], lengths[p])
        yield p, np.abs(truth.cuts - found.cuts[p]).min() <= near


def fit_logistic(statistics: Floats, right: Bools, sources: NDArray[np.str_]) -> Numbers:
    """Fit constant and weights by logistic regression, with equal weight for each source."""
    _, at, counts = np.unique(sources, return_inverse=True, return_counts=True)
    share = (len(right) / len(counts) / counts)[at]
    middles, spreads = statistics.mean(axis=0), np.maximum(statistics.std(axis=0), 1e-9)
    rows = np.column_stack([np.ones(len(right)), (statistics - middles) / spreads])
    count = statistics.shape[1]
    weights, ridge = np.zeros(1 + count), np.diag([1e-6, *[RIDGE] * count])
    for _ in range(100):  # Newton's method
        p = expit(rows @ weights)
        slope = rows.T @ (share * (right - p)) - ridge @ weights
        bend = rows.T @ ((share * p * (1 - p))[:, None] * rows) + ridge
        weights += (step := np.linalg.solve(bend, slope))
        if np.abs(step).max() < 1e-9:
            break
    factors = weights[1:] / spreads
    return float(weights[0] - factors @ middles), *factors.tolist()


def predict_left_out(table: Table) -> Floats:
    """Predict the probabilities of each source from all others."""
    found = np.full(len(table.right), 0.5)
    for source in np.unique(table.sources):
        own = table.sources == source
        if not own.all():
            others = table.statistics[~own], table.right[~own], table.sources[~own]
            constant, *weights = fit_logistic(*others)
            found[own] = expit(constant + table.statistics[own] @ weights)
    return found


def compute_scores(found: Floats, right: Bools) -> dict[str, float]:
    """Return AUC, mean squared error, the share that is sure, and how much of it is right."""
    sure = found >= SURE
    return {
        "right": float(right.mean()),
        "auc": float(roc_auc_score(right, found)) if 0 < right.mean() < 1 else np.nan,
        "brier": float(np.square(found - right).mean()),
        "base": float(right.mean() * (1 - right.mean())),
        "sure": float(sure.mean()),
        "sure_right": float(right[sure].mean()) if sure.any() else np.nan,
    }


def print_report(kind: str, table: Table, found: Floats) -> None:
    """Print and record scores over all sources and of each."""
    names = ("right", "AUC", "Brier", "(none)", "sure", "of it ok")
    print(f"\n{kind:28}{'n':>7}" + "".join(f"{name:>9}" for name in names))
    for source in ("", *np.unique(table.sources)):
        own = (table.sources == source) | (source == "")
        row = compute_scores(found[own], table.right[own])
        cells = "".join(f"{value:9.3f}" for value in row.values())
        print(f"  {source or 'all':26}{own.sum():7}{cells}")
        for name, value in row.items():
            if not source and np.isfinite(value):
                record(f"confidence.{kind}.{name}", value)
    if least := PROMISED.get(kind):
        auc = compute_scores(found, table.right)["auc"]
        print(f"{kind}: AUC {auc:.3f}, {least:.2f} promised")


def judge_source(source: str, every: int, near_s: float) -> list[Row]:
    warnings.simplefilter("ignore")
    return [
        row
        for recording, truth in KNOWN[source](every)
        for row in judge(source, recording, truth, near_s)
    ]


def make_tables(rows: Sequence[Row]) -> dict[str, Table]:
    """Collect the rows of each kind."""
    of_kinds: dict[str, list[Row]] = {}
    for row in rows:
        of_kinds.setdefault(row.kind, []).append(row)
    return {
        kind: Table(
            np.array([row.source for row in of]),
            np.array([row.statistics for row in of]),
            np.array([row.right for row in of]),
        )
        for kind, of in of_kinds.items()
    }


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--every", type=int, default=1, help="one in so many recordings")
    parser.add_argument("--near", type=float, default=NEAR_S, help="borders are right within, s")
    parser.add_argument("--processes", type=int, default=2)
    add_option(parser)
    options = parser.parse_args()
    find_data("")
    work = partial(judge_source, every=options.every, near_s=options.near)
    sources = choose_size(list(KNOWN), ["subject 86", "synthetic", "ipolgait", "UI-PRMD"])
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        rows = list(chain.from_iterable(pool.map(work, sources)))
    lines = []
    for kind, table in make_tables(rows).items():
        print_report(kind, table, predict_left_out(table))
        weights = fit_logistic(table.statistics, table.right, table.sources)
        lines.append(f"{kind}: ({', '.join(f'{weight:.4g}' for weight in weights)})")
    print("\n" + "\n".join(lines))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
