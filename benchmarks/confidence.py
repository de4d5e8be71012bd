"""Are probabilities right? On recordings of sources that they were not learnt from.

    python benchmarks/confidence.py [--fit] [--every 5] [--record]

A link, a border, a count and a cut between two repetitions are each right or
wrong, as people or the maker of the recording say. From a few statistics of each
(``kineme/methods/evidence.py``) a logistic model tells how probable it is that it
is right. Each source is left out in turn: its probabilities are those of a model
learnt from all others. With ``--fit`` the weights learnt from all sources are
written into ``kineme/methods/weights.py``.

- **bodies**: subject 86; sequences of HDM05 exercises with three to six
  repetitions, and with two or three; its exercises one by one; synthetic recordings
  under all conditions. Borders are right within 0.25 s.
- **sensors**: barbell exercises, a gait laboratory, HuGaDB, HAPT, UTKinect.
  Borders are right within 0.5 s.
"""

from __future__ import annotations

import warnings
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import kineme
from _figures import add_option, record
from _options import command_line, few, needed
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
from kineme.methods.base import Columns
from kineme.methods.confidence import log_odds, probability, with_borders
from kineme.recordings import Motion, Signals
from kineme.segmentation.segmenter import segment_and_found

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

WEIGHTS = Path(kineme.__file__).parent / "methods" / "weights.py"
KINDS = ("link", "border", "sensor_link", "sensor_border", "count", "cut")
PROMISED = {"count": 0.85, "border": 0.80}  # area under the curve
MOST_BRIER, SURE = 0.07, 0.9

TOLERANCE, SENSOR_TOLERANCE = 0.25, 0.5  # of borders, s
CUT_TOLERANCE = 0.25  # of the longer repetition next to it
STILL = ("standing", "sitting", "laying")  # where there is nothing to count
RIDGE = 20.0
UNTOLD = ("sensor_border",)  # of which statistics tell less than nothing where a set is left out
KNOWN = {"cut": 4}  # statistics that must be known, two of others; borders may have no other side

SETS = {"barbell": 41, "ipolgait": 30, "utkinect": 20, "hugadb": 40, "hapt": 12}


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


@dataclass(frozen=True)
class Segments:
    """What was found, in seconds.

    Attributes
    ----------
    edges, cuts : array
        Borders of activities and transitions, and of primitives.
    labels : (segments,) array
        Clusters, -1 for transitions.
    repeats : (primitives,) array of bool
        Whether each is a repetition.
    parents : (primitives,) array
        The segment that it lies in.
    """

    edges: Floats
    labels: NDArray[np.int64]
    cuts: Floats
    repeats: Bools
    parents: NDArray[np.int64]

    @property
    def counts(self) -> NDArray[np.int64]:
        """Repetitions of each segment."""
        return np.bincount(self.parents[self.repeats], minlength=len(self.labels))

    def overlaps(self, truth: Truth) -> Floats:
        """Seconds that each segment (rows) and each true action share."""
        spans = np.array([(start, stop) for start, stop, _ in truth.actions])
        inner = np.minimum.outer(self.edges[1:], spans[:, 1])
        inner -= np.maximum.outer(self.edges[:-1], spans[:, 0])
        return np.maximum(inner, 0)


class Table:
    """Statistics of what was found and whether it is right, by kind."""

    def __init__(self) -> None:
        self.rows: dict[str, list[tuple[str, Floats, bool]]] = defaultdict(list)

    def add(self, kind: str, source: str, statistics: Floats, right: bool) -> None:
        if np.isfinite(statistics[: KNOWN.get(kind, 2)]).all():
            self.rows[kind].append((source, statistics, bool(right)))

    def of(self, kind: str) -> tuple[NDArray[np.str_], Floats, Bools]:
        sources, statistics, right = zip(*self.rows[kind], strict=True)
        return np.array(sources), np.array(statistics), np.array(right)


# --- recordings whose truth is known ----------------------------------------------------------


def bodies(every: int) -> Iterator[tuple[str, Motion, Truth]]:
    for case in subject_86():
        yield "subject 86", case.motion, truth_of(case)
    for case in (*hdm05(60 // every), *hdm05(45 // every, runs=10, repeats=(2, 3))):
        yield f"HDM05 {case.name[:2]}", case.motion, truth_of(case)
    for actor in ACTORS:
        for one in exercises(actor)[:: every * few(1, 20)]:
            whole = [(0.0, one.motion.n_frames / one.motion.fps, one.name)]
            yield f"HDM05 {actor}", one.motion, Truth(whole, [one.repetitions])
    for condition in CONDITIONS:
        for case in synthetic(condition, 10 // every):
            yield "synthetic", case.motion, truth_of(case)


def truth_of(case: Case) -> Truth:
    known, fps = case.truth, case.truth.fps
    edges = (known.at_means().borders / fps).tolist()
    return Truth(
        [(*span, name) for span, name in zip(pairwise(edges), known.labels, strict=True)],
        list(known.counts) or [None] * len(known.labels),
        list(zip(known.earliest / fps, known.latest / fps, strict=True)),
        None if case.made is None else case.made.primitives.start_s,
    )


def sensors(every: int) -> Iterator[tuple[str, Signals, Floats, Truth]]:
    """Sets, signals, the time of each frame, and the truth; recordings evenly chosen."""
    for name, most in SETS.items():
        folder = needed(f"sets/{name}")
        tables = {table: by_recording(folder / f"{table}.csv") for table in ("labels", "events")}
        counts = by_recording(folder / "counts.csv")
        paths = sorted((folder / "recordings").glob("*.parquet"))
        for at in np.unique(np.linspace(0, len(paths) - 1, few(most // every, 2)).astype(int)):
            signals, times = channels(paths[at])
            labels, events = (tables[table][paths[at].stem] for table in ("labels", "events"))
            if name == "barbell":
                count = int(counts[paths[at].stem][0]["nominal_count"])
                yield name, signals, times, Truth([(times[0], times[-1], "")], [count])
            else:
                yield name, signals, times, truth_of_labels(labels, events, times)


def truth_of_labels(labels: list[Any], events: list[Any], times: Floats) -> Truth:
    """What lies between two labels is an uncertain border."""
    actions = [(float(row["start_s"]), float(row["stop_s"]), row["label"]) for row in labels]
    counts = [0 if label.lower() in STILL else None for _, _, label in actions]
    borders = [(one[1], other[0]) for one, other in pairwise(actions) if one[2] != other[2]]
    borders = [(times[0], actions[0][0]), *borders, (actions[-1][1], times[-1])]
    feet = {"left": [0.0] * 0, "right": [0.0] * 0}
    for row in events:
        feet[row["foot"]].append((float(row["swing_start_s"]) + float(row["swing_stop_s"])) / 2)
    strides = (np.array(feet["left"]), np.array(feet["right"])) if events else None
    return Truth(actions, counts, borders, strides=strides)


def channels(path: Path) -> tuple[Signals, Floats]:
    """Channels without those of muscles, and the time of each frame."""
    from pyarrow import parquet

    table = parquet.read_table(path)
    kept = [name for name in table.column_names if not name.lower().startswith("emg")]
    values = np.column_stack([table[name].to_numpy().astype(np.float64) for name in kept])
    values = values[np.isfinite(values).all(axis=1)]
    times = values[:, 0]
    return Signals(values[:, 1:], (len(times) - 1) / (times[-1] - times[0])), times


# --- what is right ----------------------------------------------------------------------------


def judge(
    table: Table, source: str, recording: Motion | Signals, truth: Truth, times: Floats
) -> None:
    """Segment a recording, and say of each thing found whether it is right."""
    _, found = segment_and_found(recording)
    segments = in_seconds(found.columns(), recording.fps / found.preset.working_fps, times)
    shown = found.evidence
    of_sensors = "sensor_" if isinstance(recording, Signals) else ""
    for g, right in right_links(truth, segments):
        table.add(f"{of_sensors}link", source, shown.links[g], right)
    tolerance = SENSOR_TOLERANCE if of_sensors else TOLERANCE
    for g, right in right_borders(truth, segments, tolerance):
        table.add(f"{of_sensors}border", source, shown.borders[g], right)
    stops = np.vstack([shown.borders[1:], np.full((1, 2), np.nan)])
    of_kind = np.full((len(stops), 1), bool(of_sensors))
    counts = np.hstack([shown.counts, shown.borders, stops, of_kind])
    for g, right in right_counts(truth, segments):
        table.add("count", source, counts[g], right)
    for p, right in right_cuts(truth, segments):
        statistics = np.append(shown.cuts[p], counts[segments.parents[p]])
        table.add("cut", source, statistics, right)


def in_seconds(columns: Columns, per_frame: float, times: Floats) -> Segments:
    """The segments of a table whose frames are so many of the recording."""
    borders = []
    for level in ("activity", "primitive"):
        rows = columns["level"] == level
        frames = np.append(columns["start_frame"][rows], columns["stop_frame"][rows][-1])
        borders.append(np.interp(frames * per_frame, np.arange(len(times)), times))
    counted = columns["kind"] == "activity"
    of_activities = columns["level"] == "activity"
    labels = np.where(counted, columns["cluster"], -1)[of_activities]
    parents = np.searchsorted(borders[0], borders[1][:-1], side="right") - 1
    return Segments(borders[0], labels, borders[1], counted[~of_activities], parents)


def right_links(truth: Truth, found: Segments) -> Iterator[tuple[int, bool]]:
    """An activity is right where its cluster stands for the action it mostly is.

    Clusters stand for actions one to one, for as much time as possible.
    """
    from scipy.optimize import linear_sum_assignment

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


def right_borders(truth: Truth, found: Segments, tolerance: float) -> Iterator[tuple[int, bool]]:
    """A border is right close to a true one, or in what lies between two actions."""
    if truth.borders:
        early, late = np.array(truth.borders).T
        for g, at in enumerate(found.edges[1:-1].tolist(), start=1):
            yield g, bool(((early - tolerance <= at) & (at <= late + tolerance)).any())


def right_counts(truth: Truth, found: Segments) -> Iterator[tuple[int, bool]]:
    """A count is right where an activity has as many repetitions in an action as are true.

    Where nothing is repeated a count of 1 says nothing, and is left out.
    """
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
        if count is None or not shared[g, action] or (count == 0 and counts[g] == 1):
            continue
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


def learnt(statistics: Floats, right: Bools) -> tuple[float, ...]:
    """Weights of a logistic regression: a constant, and one for each statistic."""
    middle, spread = statistics.mean(axis=0), np.maximum(statistics.std(axis=0), 1e-9)
    rows = np.column_stack([np.ones(len(right)), (statistics - middle) / spread])
    ridge = np.diag([1e-6, *[RIDGE] * statistics.shape[1]])
    weights = np.zeros(rows.shape[1])
    for _ in range(100):  # Newton's method
        p = 1 / (1 + np.exp(-rows @ weights))
        slope = rows.T @ (right - p) - ridge @ weights
        step = np.linalg.solve(rows.T @ ((p * (1 - p))[:, None] * rows) + ridge, slope)
        weights += step
        if np.abs(step).max() < 1e-9:
            break
    scaled = weights[1:] / spread
    return (float(weights[0] - scaled @ middle), *map(float, scaled))


def fitted(table: Table, kind: str, kept: Any) -> tuple[float, ...]:
    """Weights of a kind, learnt from the sources that are kept."""
    sources, statistics, right = table.of(kind)
    rows = kept(sources)
    return learnt(seen(table, kind, statistics, kept)[rows], right[rows])


def seen(table: Table, kind: str, statistics: Floats, kept: Any) -> Floats:
    """The statistics of a kind: counts are told by the odds of borders, cuts by those of counts."""
    if kind == "cut":
        counts = seen(table, "count", statistics[:, 2:], kept)
        return np.column_stack([statistics[:, :2], log_odds(counts, fitted(table, "count", kept))])
    if kind in UNTOLD:
        return np.zeros_like(statistics)
    if kind != "count":
        return statistics
    sensors = statistics[:, 6] > 0
    odds = np.empty((2, len(statistics)))
    for rows, border in ((sensors, "sensor_border"), (~sensors, "border")):
        for side, columns in zip(odds, (slice(2, 4), slice(4, 6)), strict=True):
            told = seen(table, border, statistics[rows, columns], kept)
            side[rows] = log_odds(told, fitted(table, border, kept))
    return with_borders(statistics[:, :2], *odds)


def left_out(table: Table, kind: str) -> tuple[NDArray[np.str_], Floats, Bools]:
    """Sources, probabilities learnt without each, and what is right."""
    sources, statistics, right = table.of(kind)
    found = np.empty(len(right))
    for source in np.unique(sources):

        def others(names: NDArray[np.str_], source: str = source) -> Bools:
            return names != source

        rows = sources == source
        weights = fitted(table, kind, others)
        found[rows] = probability(seen(table, kind, statistics[rows], others), weights)
    return sources, found, right


# --- scores -----------------------------------------------------------------------------------


def scores(found: Floats, right: Bools) -> dict[str, float]:
    """Area under the curve, mean squared error, and how much is sure and of that right."""
    ranks = np.argsort(np.argsort(found)) + 1.0
    for value in np.unique(found):
        ranks[found == value] = ranks[found == value].mean()
    yes, no = right.sum(), (~right).sum()
    sure = found >= SURE
    return {
        "n": len(right),
        "right": right.mean(),
        "auc": (ranks[right].sum() - yes * (yes + 1) / 2) / (yes * no) if yes * no else np.nan,
        "brier": np.square(found - right).mean(),
        "base": right.mean() * (1 - right.mean()),
        "sure": sure.mean(),
        "sure_right": right[sure].mean() if sure.any() else np.nan,
    }


def report(table: Table) -> None:
    """Scores of each kind, over all sources and of each, learnt from the others."""
    names = ("right", "AUC", "Brier", "(none)", "sure", "of it ok")
    print(f"{'source left out':28}{'n':>7}" + "".join(f"{name:>9}" for name in names))
    for kind in KINDS:
        sources, found, right = left_out(table, kind)
        whole = scores(found, right)
        show(kind, whole)
        for source in np.unique(sources):
            show(f"  {source}", scores(found[sources == source], right[sources == source]))
        for name, value in whole.items():
            if name != "n" and np.isfinite(value):
                record(f"confidence.{kind}.{name}", float(value))
    for kind, least in PROMISED.items():
        whole = scores(*left_out(table, kind)[1:])
        print(
            f"{kind}: AUC {whole['auc']:.3f}, {least:.2f} promised; Brier {whole['brier']:.3f}, "
            f"{MOST_BRIER:.2f} promised; of what is sure {whole['sure_right']:.3f}, {SURE} promised"
        )
    once = probability(np.zeros((1, 3)), fitted(table, "count", lambda sources: sources != ""))
    record("confidence.once", float(once[0]))
    print(f"a single repetition: {once[0]:.2f}")


def show(title: str, row: dict[str, float]) -> None:
    cells = "".join(f"{value:9.3f}" for name, value in row.items() if name != "n")
    print(f"{title:28}{row['n']:7.0f}{cells}")


def write(table: Table) -> None:
    """The weights learnt from all sources, as a module."""
    lines = []
    for kind in KINDS:
        weights = fitted(table, kind, lambda sources: sources != "")
        lines.append(f"{kind.upper()} = ({', '.join(f'{weight:.4g}' for weight in weights)})")
    head = WEIGHTS.read_text(encoding="utf-8").split("\nLINK")[0]
    WEIGHTS.write_text("\n".join([head, *lines, ""]), encoding="utf-8")
    print("\n".join(lines))


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--fit", action="store_true", help="write the weights into the package")
    parser.add_argument("--every", type=int, default=1, help="one in so many recordings")
    add_option(parser)
    options = parser.parse_args()
    table = Table()
    for source, motion, truth in bodies(options.every):
        judge(table, source, motion, truth, np.arange(motion.n_frames) / motion.fps)
    for source, signals, times, truth in sensors(options.every):
        judge(table, source, signals, truth, times)
    report(table)
    if options.fit:
        write(table)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
