"""Are probabilities right? On recordings of sources that they were not learnt from.

    python -m benchmarks confidence [--every N] [--near S] [--record]

A link, a border, a count and a cut between two repetitions are each right or wrong, as people or
the maker of the recording say. One statistic of each (``methods/kineme/confidence.py``) and two
numbers tell how probable it is that it is right. Each source is left out in turn: its
probabilities are those learnt from all others, each source of the same weight. Of every statistic
alone is shown how it does so; of those that part right from wrong, the one of least squared error
in the mean over sources is what a kind is told by. The numbers learnt from all sources are printed
last; they are constants of the preset.
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
from scipy.stats import rankdata

import kineme
from _figures import add_option, record
from _options import DATA, command_line, few, needed
from _recordings import (
    ACTORS,
    CONDITIONS,
    Case,
    by_recording,
    exercises,
    hdm05,
    subject_86,
    synthetic,
)
from _sources import NEAR_S, session_recordings
from kineme.evaluation.folder import find_recordings
from kineme.methods.base import Columns
from kineme.methods.kineme.found import KinemeFound
from kineme.methods.segmenter import segment_and_found
from kineme.recordings import Motion, Signals
from sets import read_sensors

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Numbers = tuple[float, float]

PREFERRED = "seconds preferred"
"""Logarithm of the seconds of an activity times how much it prefers its own cluster; of a border
the lesser of both sides."""
SHARPNESS = "sharpness"
"""Logarithm of how much more the recording changes at a border than nearby."""
STATISTICS = {
    "link": (PREFERRED,),
    "border": (SHARPNESS, PREFERRED),
    "count": ("correlation", "evenness"),
    "cut": ("correlation",),
}
"""By kind: those of ``Evidence``, and one that could be."""
PROMISED = {"count": 0.85, "border": 0.80}
"""Area under the curve."""
MOST_BRIER, SURE = 0.07, 0.9
CUT_TOLERANCE = 0.25
"""Of the longer repetition next to it."""
RIDGE = 1.0
FEW = 8
"""A source with fewer right ones, or wrong ones, does not tell what parts them."""


@dataclass(frozen=True)
class Truth:
    """What is known of a recording, in seconds.

    Attributes
    ----------
    actions : list of (start, stop, label)
    counts : list of int or None
        Repetitions of each action; none where nobody knows.
    borders : list of (earliest, latest)
    cuts : array, optional
        Where repetitions begin.
    strides : pair of arrays, optional
        When each foot swings.
    """

    actions: list[tuple[float, float, str]] = field(default_factory=list)
    counts: list[int | None] = field(default_factory=list)
    borders: list[tuple[float, float]] = field(default_factory=list)
    cuts: Floats | None = None
    strides: tuple[Floats, Floats] | None = None


class Row(NamedTuple):
    """The statistics of a thing that was found, and whether it is right."""

    kind: str
    source: str
    statistics: tuple[float, ...]
    right: bool


class Table(NamedTuple):
    """All things of a kind."""

    sources: NDArray[np.str_]
    statistics: Floats
    right: Bools


# --- recordings whose truth is known ----------------------------------------------------------

Known = Iterator[tuple[Motion | Signals, Truth]]


def cases(made: Iterator[Case]) -> Known:
    for case in made:
        yield case.motion, truth_of(case)


def truth_of(case: Case) -> Truth:
    known, fps = case.truth, case.truth.fps
    edges = (known.at_means().borders / fps).tolist()
    return Truth(
        [(*span, name) for span, name in zip(pairwise(edges), known.labels, strict=True)],
        list(known.counts) or [None] * len(known.labels),
        list(zip(known.earliest / fps, known.latest / fps, strict=True)),
        None if case.made is None else case.made.primitives.start_s,
    )


def single_exercises(every: int) -> Known:
    """One exercise, once or a few times."""
    for one in chain.from_iterable(exercises(actor)[:: few(every, 100)] for actor in ACTORS):
        whole = [(0.0, one.motion.n_frames / one.motion.fps, one.name)]
        yield one.motion, Truth(whole, [one.repetitions])


def hdm05_all(every: int) -> Known:
    yield from cases(hdm05(60 // every))
    yield from cases(hdm05(45 // every, runs=10, repeats=(2, 3)))
    yield from single_exercises(every)


def synthetic_all(every: int) -> Known:
    for condition in CONDITIONS:
        yield from cases(synthetic(condition, max(1, 10 // every)))


def ui_prmd(every: int) -> Known:
    """Sessions of exercises as they should be done, and as they should not."""
    for name in ("uiprmd", "uiprmd_incorrect"):
        for _, motion, parts in session_recordings(name, few(every, 10)):
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


def sensors(name: str, most: int, every: int) -> Known:
    """Recordings of a set, evenly chosen; what lies between two labels is an uncertain border."""
    folder = needed(f"sets/{name}")
    tables = {table: by_recording(folder / f"{table}.csv") for table in ("labels", "events")}
    counts = by_recording(folder / "counts.csv")
    paths = sorted((folder / "recordings").glob("*.parquet"))
    for at in np.unique(np.linspace(0, len(paths) - 1, few(most // every, 2)).astype(int)):
        signals, stem = read_sensors(paths[at]), paths[at].stem
        stop = signals.n_frames / signals.fps
        if name == "barbell":
            yield signals, Truth([(0.0, stop, "")], [int(counts[stem][0]["nominal_count"])])
        else:
            yield signals, truth_of_labels(tables["labels"][stem], tables["events"][stem], stop)


def continuous(name: str, every: int) -> Known:
    """Recordings of several activities without a cut between them."""
    folder = needed(name)
    labels = by_recording(folder / "labels.csv")
    paths = [path for path in find_recordings(folder) if path.stem in labels]
    for path in paths[:: few(every, 4)]:
        motion = kineme.read(path)
        yield motion, truth_of_labels(labels[path.stem], [], motion.n_frames / motion.fps)


def truth_of_labels(labels: list[Any], events: list[Any], stop: float) -> Truth:
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
    "HDM05": hdm05_all,
    "hapt": partial(sensors, "hapt", 20),
    "hugadb": partial(sensors, "hugadb", 60),
    "UI-PRMD": ui_prmd,
    "swimming": partial(sensors, "swimming", 20),
    "tug": partial(continuous, "bodies/tug"),
    "takes": partial(continuous, "rigs/takes"),
    "synthetic": synthetic_all,
    "utkinect": partial(sensors, "utkinect", 20),
    "ipolgait": partial(sensors, "ipolgait", 60),
    "mocap6": partial(continuous, "mocap6"),
    "subject 86": lambda _: cases(iter(subject_86())),
    "barbell": partial(sensors, "barbell", 40),
}
"""By source, of the same people and devices, the longest first."""


# --- what is right ----------------------------------------------------------------------------


class Segments(NamedTuple):
    """What was found, in seconds.

    Attributes
    ----------
    edges, cuts : array
        Borders of activities and transitions, and of primitives.
    labels : (segments,) array
        Clusters, -1 for transitions.
    repeats : (primitives,) array of bool
        Whether each is a repetition or an event.
    parents : (primitives,) array
        The segment that it lies in.
    """

    edges: Floats
    cuts: Floats
    labels: NDArray[np.int64]
    repeats: Bools
    parents: NDArray[np.int64]

    @property
    def counts(self) -> NDArray[np.int64]:
        """Repetitions of each segment."""
        return np.bincount(self.parents[self.repeats], minlength=len(self.labels))

    @property
    def evenness(self) -> Floats:
        """Of each segment: how little the logarithms of its repetitions' lengths deviate."""
        lengths = np.log(np.diff(self.cuts))
        own = [lengths[(self.parents == g) & self.repeats] for g in range(len(self.labels))]
        return np.array([-float(of.std()) if len(of) else 0.0 for of in own])

    def overlaps(self, truth: Truth) -> Floats:
        """Seconds that each segment (rows) and each true action share."""
        spans = np.array([(start, stop) for start, stop, _ in truth.actions])
        inner = np.minimum.outer(self.edges[1:], spans[:, 1])
        inner -= np.maximum.outer(self.edges[:-1], spans[:, 0])
        return np.maximum(inner, 0)


def in_seconds(columns: Columns, fps: float) -> Segments:
    """The segments of a table of so many frames per second."""
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
    """Segment a recording, and say of each thing found whether it is right."""
    _, found = segment_and_found(recording)
    assert isinstance(found, KinemeFound)
    segments = in_seconds(found.columns(), found.preset.working_fps)
    shown = found.evidence
    preferred, repeated = shown.preferred[:, None], shown.repeated[:, None]
    lesser = np.fmin(shown.preferred, np.roll(shown.preferred, 1))
    of_borders = np.column_stack([shown.sharpness, lesser])
    of_counts = np.column_stack([repeated, segments.evenness])
    of_counts[segments.counts < 2] = np.nan  # of one there is nothing to count
    of_cuts = repeated[shown.parents]
    judged = (
        ("link", preferred, right_links(truth, segments)),
        ("border", of_borders, right_borders(truth, segments, near_s)),
        ("count", of_counts, right_counts(truth, segments)),
        ("cut", of_cuts, right_cuts(truth, segments)),
    )
    return [
        Row(kind, source, tuple(statistics[at].tolist()), bool(right))
        for kind, statistics, of_kind in judged
        for at, right in of_kind
        if np.isfinite(statistics[at]).all()
    ]


def right_links(truth: Truth, found: Segments) -> Iterator[tuple[int, bool]]:
    """An activity is right where its cluster stands for the action it mostly is.

    Clusters stand for actions one to one, for as much time as possible.
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


def right_borders(truth: Truth, found: Segments, near_s: float) -> Iterator[tuple[int, bool]]:
    """A border is right close to a true one, or in what lies between two actions."""
    if truth.borders:
        early, late = np.array(truth.borders).T
        for g, at in enumerate(found.edges[1:-1].tolist(), start=1):
            yield g, bool(((early - near_s <= at) & (at <= late + near_s)).any())


def right_counts(truth: Truth, found: Segments) -> Iterator[tuple[int, bool]]:
    """A count is right where an activity has as many repetitions in an action as are true."""
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


def right_cuts(truth: Truth, found: Segments) -> Iterator[tuple[int, bool]]:
    """A cut is right close to where a repetition begins."""
    if truth.cuts is None:
        return
    lengths = np.diff(found.cuts)
    for p in np.flatnonzero(np.diff(found.parents) == 0) + 1:
        near = CUT_TOLERANCE * max(lengths[p - 1], lengths[p])
        yield p, np.abs(truth.cuts - found.cuts[p]).min() <= near


# --- the model --------------------------------------------------------------------------------


def learnt(statistic: Floats, right: Bools, sources: NDArray[np.str_]) -> Numbers:
    """A constant and a weight by logistic regression, each source of the same weight."""
    _, at, counts = np.unique(sources, return_inverse=True, return_counts=True)
    share = (len(right) / len(counts) / counts)[at]
    middle, spread = statistic.mean(), max(float(statistic.std()), 1e-9)
    rows = np.column_stack([np.ones(len(right)), (statistic - middle) / spread])
    weights, ridge = np.zeros(2), np.diag([1e-6, RIDGE])
    for _ in range(100):  # Newton's method
        p = expit(rows @ weights)
        slope = rows.T @ (share * (right - p)) - ridge @ weights
        bend = rows.T @ ((share * p * (1 - p))[:, None] * rows) + ridge
        weights += (step := np.linalg.solve(bend, slope))
        if np.abs(step).max() < 1e-9:
            break
    weight = float(weights[1] / spread)
    return float(weights[0] - weight * middle), weight


def left_out(table: Table, statistic: Floats) -> Floats:
    """Probabilities, those of each source learnt from all others."""
    found = np.empty(len(statistic))
    for source in np.unique(table.sources):
        own = table.sources == source
        others = () if own.all() else (statistic[~own], table.right[~own], table.sources[~own])
        constant, weight = learnt(*others) if others else (0.0, 0.0)
        found[own] = expit(constant + weight * statistic[own])
    return found


def auc(found: Floats, right: Bools) -> float:
    """Area under the curve; nan where there is nothing to part."""
    yes, no = int(right.sum()), int((~right).sum())
    ranks = rankdata(found)[right].sum()
    return float((ranks - yes * (yes + 1) / 2) / (yes * no)) if yes and no else np.nan


def scores(found: Floats, right: Bools) -> dict[str, float]:
    """Area under the curve, mean squared error, and how much is sure and of that right."""
    sure = found >= SURE
    return {
        "right": float(right.mean()),
        "auc": auc(found, right),
        "brier": float(np.square(found - right).mean()),
        "base": float(right.mean() * (1 - right.mean())),
        "sure": float(sure.mean()),
        "sure_right": float(right[sure].mean()) if sure.any() else np.nan,
    }


def means(table: Table, found: Floats) -> tuple[float, float]:
    """Area under the curve and mean squared error, in the mean over sources."""
    areas, errors = [], []
    for source in np.unique(table.sources):
        own = table.sources == source
        errors.append(np.square(found[own] - table.right[own]).mean())
        if min(table.right[own].sum(), (~table.right[own]).sum()) >= FEW:
            areas.append(auc(found[own], table.right[own]))
    return float(np.mean(areas)) if areas else np.nan, float(np.mean(errors))


def chosen(kind: str, table: Table) -> int:
    """The statistic that does best where each source is left out; each of them is shown."""
    print(f"\n{kind:28}{'n':>7}{'AUC':>9}{'of each':>9}{'Brier':>9}  learnt from all")
    errors = []
    for name, statistic in zip(STATISTICS[kind], table.statistics.T, strict=True):
        found = left_out(table, statistic)
        area, error = means(table, found)
        constant, weight = learnt(statistic, table.right, table.sources)
        pooled = auc(found, table.right)
        cells = f"{len(found):7}{pooled:9.3f}{area:9.3f}{error:9.3f}"
        print(f"  {name:26}{cells}  {constant:.4g}, {weight:.4g}", flush=True)
        errors.append(error if area > 0.5 else np.inf)
    none = means(table, left_out(table, np.zeros(len(table.right))))
    print(f"  {'none':26}{'':25}{none[1]:9.3f}")
    return int(np.argmin(errors))


def report(kind: str, table: Table, found: Floats) -> None:
    """Scores over all sources, and of each, learnt from the others."""
    names = ("right", "AUC", "Brier", "(none)", "sure", "of it ok")
    print(f"\n{kind:28}{'n':>7}" + "".join(f"{name:>9}" for name in names))
    for source in ("", *np.unique(table.sources)):
        own = (table.sources == source) | (source == "")
        row = scores(found[own], table.right[own])
        cells = "".join(f"{value:9.3f}" for value in row.values())
        print(f"  {source or 'all':26}{own.sum():7}{cells}")
        for name, value in row.items():
            if not source and np.isfinite(value):
                record(f"confidence.{kind}.{name}", value)
    least, row = PROMISED.get(kind), scores(found, table.right)
    if least:
        print(
            f"{kind}: AUC {row['auc']:.3f}, {least:.2f} promised; Brier {row['brier']:.3f}, "
            f"{MOST_BRIER:.2f} promised; of what is sure {row['sure_right']:.3f}, {SURE} promised"
        )


# --- all of it --------------------------------------------------------------------------------


def rows_of(source: str, every: int, near_s: float) -> list[Row]:
    warnings.simplefilter("ignore")
    return [
        row
        for recording, truth in KNOWN[source](every)
        for row in judge(source, recording, truth, near_s)
    ]


def tables(rows: Sequence[Row]) -> dict[str, Table]:
    """By kind."""
    of_kinds = {kind: [row for row in rows if row.kind == kind] for kind in STATISTICS}
    return {
        kind: Table(
            np.array([row.source for row in of]),
            np.array([row.statistics for row in of]),
            np.array([row.right for row in of]),
        )
        for kind, of in of_kinds.items()
        if of
    }


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--every", type=int, default=1, help="one in so many recordings")
    parser.add_argument("--near", type=float, default=NEAR_S, help="borders are right within, s")
    parser.add_argument("--processes", type=int, default=2)
    add_option(parser)
    options = parser.parse_args()
    needed("", DATA)
    work = partial(rows_of, every=options.every, near_s=options.near)
    sources = few(list(KNOWN), ["subject 86", "synthetic", "ipolgait", "UI-PRMD"])
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        rows = list(chain.from_iterable(pool.map(work, sources)))
    lines = []
    for kind, table in tables(rows).items():
        best = chosen(kind, table)
        statistic = table.statistics[:, best]
        report(kind, table, left_out(table, statistic))
        constant, weight = learnt(statistic, table.right, table.sources)
        lines.append(f"{kind}_weights = ({constant:.4g}, {weight:.4g})  # {STATISTICS[kind][best]}")
    print("\n" + "\n".join(lines))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
