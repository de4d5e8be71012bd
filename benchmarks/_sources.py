"""Recordings of every kind that people cut, tagged or counted: one source after the other.

A source yields `Sample`s: a recording, and how a segmentation of it is judged. Figures of a
source are those of `kineme.evaluation.score.pool_scores`: ratios are summed, numbers averaged.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

import kineme
from _joined import Piece, clusters_of, joined, person_of, pieces
from _options import DATA
from _recordings import Case, by_recording, hdm05, subject_86, synthetic
from _sparse_recordings import SparseCase, found_units, matches, sparse_events
from kineme.evaluation import evaluate_segmentation
from kineme.evaluation.comparison import UNLABELLED, Comparison, compare
from kineme.evaluation.folder import find_recordings
from kineme.evaluation.score import Ratio, pool_scores, scores
from kineme.labels.collections import LabelSource, find_labels
from kineme.recordings import Motion, Signals, Skeleton
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import SegmentTable
from sets import read_sensors

NEAR_S = 0.5
"""Borders this near to a true one are right."""
TAGGED_S = 0.3
"""A gesture is found if its tag lies in an occurrence, or this near to it."""
PERSON = re.compile(r"_s(\d+)")
"""In names of takes."""
STANDING_S = 0.5
"""Between two exercises of a session."""
ENDS = ("start_s", "stop_s")
"""Columns of a set."""
ANNOTATED = ("one_to_one", "border_f1", "covering", "count_exact")
"""Scores where annotators cut."""
CONTINUOUS = ("one_to_one", "border_f1", "covering")
"""Scores of real recordings of several activities."""
LABELLED = ("mof", "edit", "f1@50", "border_f1")
"""Scores of `kineme evaluate` where people labelled what is done."""

Judged = Mapping[str, float | Ratio]
"""Scores of a recording by the name of the figure."""


class Sample(NamedTuple):
    """A recording, and how a segmentation of it is judged."""

    name: str
    recording: Motion | Signals
    judge: Callable[[Segmentation], Judged]


def cases(made: Iterable[Case], every: int) -> Iterator[Sample]:
    """Recordings that annotators cut, or whose maker knows the truth."""

    def judge(found: Segmentation, case: Case) -> Judged:
        values = evaluate_segmentation(case.truth, found)
        return {name: values[name] for name in ANNOTATED if name in values}

    for case in islice(made, None, None, every):
        yield Sample(case.name, case.motion, partial(judge, case=case))


def sparse(seeds: int, every: int) -> Iterator[Sample]:
    """Exercises now and then, among other movement."""

    def judge(found: Segmentation, case: SparseCase) -> Judged:
        right, inside = matches(case, found_units(found))
        return {"recall": Ratio(right, len(case.events)), "precision": Ratio(right, inside)}

    for case in islice(sparse_events(seeds), None, None, every):
        yield Sample(case.name, case.motion, partial(judge, case=case))


def of_bodies(name: str, table: str) -> list[tuple[str, Path, list[dict[str, str]]]]:
    """The recordings of a set of bodies, and their rows of a table."""
    folder = DATA / "bodies" / name
    rows = by_recording(folder / table)
    return [(key, folder / "recordings" / f"{key}.npz", rows[key]) for key in sorted(rows)]


def takes(name: str, every: int) -> Iterator[Sample]:
    """One exercise, ten times over, each repetition cut by people.

    The first start of either is left out: people have it where the recording begins.
    """

    def judge(found: Segmentation, rows: list[dict[str, str]]) -> Judged:
        count = most_repeated(found)
        true = sorted(float(row["start_s"]) for row in rows)[1:]
        own = sorted({row.start_s for row in found_units(found)})[1:]
        hits = near(true, own)
        return {
            "exact": float(count == len(rows)),
            "within_one": float(abs(count - len(rows)) <= 1),
            "repetitions_f1": Ratio(2 * hits, len(true) + len(own)),
        }

    for key, path, rows in of_bodies(name, "labels.csv")[::every]:
        yield Sample(key, kineme.read(path), partial(judge, rows=rows))


class Exercise(NamedTuple):
    """A part of a session: its frames, its name, and the seconds at which repetitions start."""

    start: int
    stop: int
    label: str
    starts: list[float]

    @property
    def count(self) -> int:
        return len(self.starts)


def sessions(name: str, every: int) -> Iterator[Sample]:
    """All exercises of a person in random order, standing between them."""
    for who, motion, parts in session_recordings(name, every):
        yield Sample(who, motion, partial(judged_session, parts=parts))


def session_recordings(name: str, every: int) -> Iterator[tuple[str, Motion, list[Exercise]]]:
    """Each person, the session, and its exercises."""
    people = defaultdict(list)
    for key, path, rows in of_bodies(name, "labels.csv"):
        people[PERSON.findall(key)[-1]].append((path, rows))
    rng = np.random.default_rng(0)
    for who, made in list(people.items()):
        order = rng.permutation(len(made)).tolist()
        motion, parts = one_after_the_other([made[i] for i in order])
        if list(people).index(who) % every == 0:
            yield who, motion, parts


def one_after_the_other(
    made: list[tuple[Path, list[dict[str, str]]]],
) -> tuple[Motion, list[Exercise]]:
    """A session of these takes, each from the same place on the floor."""
    motions = keep_shared_joints([kineme.read(path) for path, _ in made])
    fps, places, parts, n = motions[0].fps, [], [], 0
    for motion, (_, rows) in zip(motions, made, strict=True):
        own = motion.positions - motion.positions[0].mean(axis=0) * [1, 0, 1]
        if places:
            share = np.linspace(0, 1, round(STANDING_S * fps))[:, None, None]
            places.append(places[-1][-1] * (1 - share) + own[0] * share)
            n += len(share)
        places.append(own)
        starts = [n / fps + float(row["start_s"]) for row in rows]
        parts.append(Exercise(n, n + len(own), rows[0]["label"], starts))
        n += len(own)
    return Motion(motions[0].skeleton, np.concatenate(places), fps), parts


def keep_shared_joints(motions: list[Motion]) -> list[Motion]:
    """Leave out joints that some takes lack, such as markers that were not seen."""
    first = motions[0].skeleton
    kept = [n for n in first.names if all(n in motion.skeleton.names for motion in motions)]
    parents = [first.parents[first.joint(name)] for name in kept]
    skeleton = Skeleton(
        kept,
        [kept.index(first.names[parent]) if parent >= 0 else -1 for parent in parents],
        first.offsets[[first.joint(name) for name in kept]],
    )
    return [
        Motion(skeleton, one.positions[:, [one.joint(name) for name in kept]], one.fps)
        for one in motions
    ]


def judged_session(found: Segmentation, parts: list[Exercise]) -> Judged:
    """Frames in the right class, borders between exercises, and counts of each."""
    clusters = clusters_of(found)
    classes = {part.label: i for i, part in enumerate(parts)}
    truth = np.full(found.n_frames, -1)
    for part in parts:
        truth[part.start : part.stop] = classes[part.label]
    seen = truth >= 0
    _, own = np.unique(clusters[seen], return_inverse=True)
    table = np.zeros((own.max() + 1, len(classes)))
    np.add.at(table, (own, truth[seen]), 1)
    true = [part.stop / found.fps + STANDING_S / 2 for part in parts[:-1]]
    starts = {row.start_s for row in found.activities if row.kind == "activity"} - {0.0}
    right = [counted(found, part.start, part.stop) == part.count for part in parts]
    return {
        "one_to_one": float(table[linear_sum_assignment(-table)].sum() / seen.sum()),
        "border_f1": 2 * near(true, sorted(starts)) / (len(true) + len(starts)),
        "counts": Ratio(sum(right), len(right)),
    }


def counted(found: Segmentation, start: float, stop: float) -> int:
    """Return the largest number of repetitions of one cluster between two frames."""
    rows = found_units(found)
    middles = (rows.start_frame + rows.stop_frame) / 2
    margin = TAGGED_S * found.fps
    inside = rows[(start - margin <= middles) & (middles <= stop + margin)]
    return max(Counter(inside.cluster.tolist()).values(), default=0)


def gestures(every: int) -> Iterator[Sample]:
    """One of twelve gestures now and then, each with a tag."""

    def judge(found: Segmentation, rows: list[dict[str, str]]) -> Judged:
        tags = sorted(float(row["time_s"]) for row in rows)
        units = found_units(found)
        best = max(
            (f1_of_tags(tags, units[units.cluster == c]) for c in np.unique(units.cluster)),
            default=0.0,
        )
        return {"f1": best, "exact": float(most_repeated(found) == len(tags))}

    for key, path, rows in of_bodies("msrc12", "events.csv")[::every]:
        yield Sample(key, kineme.read(path), partial(judge, rows=rows))


def f1_of_tags(tags: list[float], units: SegmentTable) -> float:
    """How well occurrences and tags go together, each of the one with one of the other."""
    free = [(row.start_s - TAGGED_S, row.stop_s + TAGGED_S) for row in units]
    hits = 0
    for tag in tags:
        at = next((span for span in free if span[0] <= tag < span[1]), None)
        if at is not None:
            free.remove(at)
            hits += 1
    return 2 * hits / (len(units) + len(tags))


def videos(every: int) -> Iterator[Sample]:
    """Exercises that a camera saw, counted by people."""

    def judge(found: Segmentation, rows: list[dict[str, str]]) -> Judged:
        true, own = int(rows[0]["count"]), most_repeated(found)
        wrong = abs(own - true)
        return {"within_one": float(wrong <= 1), "error": wrong / max(1, true)}

    for key, path, rows in of_bodies("countix", "counts.csv")[::every]:
        yield Sample(key, kineme.read(path), partial(judge, rows=rows))


def continuous(folder: str, every: int) -> Iterator[Sample]:
    """Recordings of several activities without a cut between them; labelled by people."""

    def judge(found: Segmentation, source: LabelSource) -> Judged:
        truth = source.of(n_frames=found.n_frames, fps=found.fps)
        compared = compare(truth, found)
        return {name: scores()[name].function(compared) for name in CONTINUOUS}

    labels = find_labels(find_recordings(DATA / folder), DATA / folder / "labels.csv")
    for path, source in list(labels.items())[::every]:
        yield Sample(path.stem, kineme.read(path), partial(judge, source=source))


def sensors(name: str, every: int) -> Iterator[Sample]:
    """What sensors, or the joints of a camera as channels, measured; labelled by people."""

    def judge(found: Segmentation, source: LabelSource) -> Judged:
        truth = source.of(n_frames=found.n_frames, fps=found.fps)
        return judged_labels(compare(truth, found))

    labels = find_labels(
        find_recordings(DATA / "sets" / name / "recordings"), DATA / "sets" / name / "labels.csv"
    )
    for path, source in list(labels.items())[::every]:
        yield Sample(path.stem, read_sensors(path), partial(judge, source=source))


def by_person(name: str, every: int) -> Iterator[Sample]:
    """The recordings of each person as one: does the length of a file count?"""
    people = defaultdict(list)
    for piece in pieces(DATA / "sets" / name):
        people[person_of(piece.name)].append(piece)

    def judge(found: Segmentation, parts: list[Piece]) -> Judged:
        ends = np.cumsum([len(part.truth) for part in parts])[:-1]
        each = zip(parts, np.split(clusters_of(found), ends), strict=True)
        judged = [
            judged_labels(Comparison(part.truth[known], clusters[known], found.fps))
            for part, clusters in each
            if (known := part.truth != UNLABELLED).any()
        ]
        return {name: pool_scores(one[name] for one in judged) for name in LABELLED}

    for who, parts in list(people.items())[::every]:
        yield Sample(who, joined([part.recording for part in parts]), partial(judge, parts=parts))


def judged_labels(compared: Comparison) -> Judged:
    return {name: scores()[name].function(compared) for name in LABELLED}


def barbell(every: int) -> Iterator[Sample]:
    """A sensor on the wrist during sets of barbell exercises; the planned number of them."""
    folder = DATA / "sets" / "barbell"
    rows = [
        row for (row,) in by_recording(folder / "counts.csv").values() if row["exercise"] != "rest"
    ]

    def judge(found: Segmentation, planned: int) -> Judged:
        own = most_repeated(found)
        return {"exact": float(own == planned), "within_one": float(abs(own - planned) <= 1)}

    for row in rows[::every]:
        recording = read_sensors(folder / "recordings" / f"{row['recording']}.parquet")
        yield Sample(row["recording"], recording, partial(judge, planned=int(row["nominal_count"])))


def counted_sets(name: str, every: int) -> Iterator[Sample]:
    """What sensors measured during sets of repetitions, counted by people, and between them."""
    folder = DATA / "sets" / name

    def judge(found: Segmentation, rows: list[dict[str, str]]) -> Judged:
        wrong = [
            abs(counted(found, *(found.fps * float(row[end]) for end in ENDS)) - int(row["count"]))
            for row in rows
        ]
        return {
            "exact": Ratio(sum(each == 0 for each in wrong), len(wrong)),
            "within_one": Ratio(sum(each <= 1 for each in wrong), len(wrong)),
        }

    files = {path.stem: path for path in find_recordings(folder / "recordings")}
    for key, rows in list(by_recording(folder / "counts.csv").items())[::every]:
        yield Sample(key, kineme.read(files[key]), partial(judge, rows=rows))


def most_repeated(found: Segmentation) -> int:
    """Repetitions of the cluster that has most of them; 0 where none has two."""
    counts = Counter(found_units(found).cluster.tolist())
    most = max(counts.values(), default=0)
    return most if most > 1 else 0


def near(true: list[float], found: list[float]) -> int:
    """How many true borders have a found one of their own near them."""
    free, hits = list(found), 0
    for border in true:
        nearest = min(free, key=lambda other: abs(other - border), default=None)
        if nearest is not None and abs(nearest - border) <= NEAR_S:
            free.remove(nearest)
            hits += 1
    return hits


SOURCES: Mapping[str, Callable[[int], Iterator[Sample]]] = {
    "subject_86": lambda every: cases(subject_86(), every),
    "mocap6": partial(continuous, "mocap6"),
    "takes": partial(continuous, "rigs/takes"),
    "tug": partial(continuous, "bodies/tug"),
    "hdm05": lambda every: cases(hdm05(50), every),
    "synthetic": lambda every: cases(synthetic("all", 20), every),
    "uiprmd": partial(takes, "uiprmd"),
    "uiprmd_sessions": partial(sessions, "uiprmd"),
    "uiprmd_incorrect": partial(takes, "uiprmd_incorrect"),
    "uiprmd_incorrect_sessions": partial(sessions, "uiprmd_incorrect"),
    "msrc12": gestures,
    "countix": videos,
    "sparse_events": partial(sparse, 50),
    "hugadb": partial(sensors, "hugadb"),
    "hapt": partial(sensors, "hapt"),
    "ipolgait": partial(sensors, "ipolgait"),
    "utkinect": partial(sensors, "utkinect"),
    "hugadb_by_person": partial(by_person, "hugadb"),
    "barbell": barbell,
    "swimming": partial(sensors, "swimming"),
    "ptex": partial(counted_sets, "ptex"),
    "gym_watch": partial(counted_sets, "gym_watch"),
    "moca": partial(counted_sets, "moca"),
}
"""By name: what yields every n-th of its recordings."""
