"""Provide sources of recordings that people cut, tagged, labelled or counted.

A source yields `Sample`s: a recording, and a function that scores a segmentation of it. Scores of
a source are combined by `kineme.evaluation.score.pool_scores`: ratios are summed, numbers averaged.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import kineme
from _measure import match_times
from _options import DATA, choose_size
from _recordings import Case, join_hdm05, read_rows, read_subject_86, synthesize_cases
from _sparse_recordings import SparseCase, make_sparse_events, match_events, select_repetitions
from kineme.evaluation import evaluate, one_to_one_accuracy
from kineme.evaluation.comparison import UNLABELLED, Comparison, compare
from kineme.evaluation.folder import find_recordings
from kineme.evaluation.score import Ratio, pool_scores, scores
from kineme.labels.collections import LabelSource, find_labels
from kineme.labels.spans import format_text
from kineme.recordings import Motion, Signals, Skeleton
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import SegmentTable
from sets import read_sensors

NEAR_S = 0.5
"""Tolerance of borders, in seconds."""
TAGGED_S = 0.3
"""Seconds by which a tag may lie outside an occurrence of its gesture."""
PERSON = re.compile(r"_s(\d+)")
"""Number of the person in names of takes."""
STANDING_S = 0.5
"""Seconds between two exercises of a session."""
ENDS = ("start_s", "stop_s")
"""Columns with the ends of a set."""
ANNOTATED = ("one_to_one", "border_f1", "covering", "count_exact")
"""Scores of recordings that annotators cut."""
CONTINUOUS = ("one_to_one", "border_f1", "covering")
"""Scores of recordings of several activities."""
LABELLED = ("mof", "edit", "f1@50", "border_f1")
"""Scores of labelled recordings."""

Judged = Mapping[str, float | Ratio]
"""Scores of a recording by name."""


class Sample(NamedTuple):
    """A recording, and a function that scores a segmentation of it."""

    name: str
    recording: Motion | Signals
    judge: Callable[[Segmentation], Judged]


def judge_cases(made: Iterable[Case], every: int) -> Iterator[Sample]:
    """Yield recordings that annotators cut, or that were made with a known truth."""

    def judge(found: Segmentation, case: Case) -> Judged:
        values = evaluate(case.truth, found)
        return {name: values[name] for name in ANNOTATED if name in values}

    for case in islice(made, None, None, every):
        yield Sample(case.name, case.motion, partial(judge, case=case))


def judge_sparse_events(seeds: int, every: int) -> Iterator[Sample]:
    """Yield recordings of exercises at irregular times among other movement."""

    def judge(found: Segmentation, case: SparseCase) -> Judged:
        right, inside = match_events(case, select_repetitions(found))
        return {"recall": Ratio(right, len(case.events)), "precision": Ratio(right, inside)}

    for case in islice(make_sparse_events(seeds), None, None, every):
        yield Sample(case.name, case.motion, partial(judge, case=case))


def list_body_recordings(name: str, table: str) -> list[tuple[str, Path, list[dict[str, str]]]]:
    """Return name, path and table rows of each recording of a set of bodies."""
    folder = DATA / "bodies" / name
    rows = read_rows(folder / table)
    return [(key, folder / "recordings" / f"{key}.npz", rows[key]) for key in sorted(rows)]


def judge_takes(name: str, every: int) -> Iterator[Sample]:
    """Yield takes of one exercise with ten repetitions, each cut by people.

    The first start is not scored: annotators set it to the start of the recording.
    """

    def judge(found: Segmentation, rows: list[dict[str, str]]) -> Judged:
        true = sorted(float(row["start_s"]) for row in rows)[1:]
        own = sorted({row.start_s for row in select_repetitions(found)})[1:]
        hits = len(match_times(true, own, NEAR_S))
        return {
            **score_counts([count_most_repeated(found) - len(rows)]),
            "repetitions_f1": Ratio(2 * hits, len(true) + len(own)),
        }

    for key, path, rows in list_body_recordings(name, "labels.csv")[::every]:
        yield Sample(key, kineme.read(path), partial(judge, rows=rows))


class Exercise(NamedTuple):
    """A part of a session: frames, label, and the seconds at which repetitions start."""

    start: int
    stop: int
    label: str
    starts: list[float]

    @property
    def count(self) -> int:
        return len(self.starts)


def judge_sessions(name: str, every: int) -> Iterator[Sample]:
    """Yield all exercises of each person, joined in random order."""
    for who, motion, parts in join_sessions(name, every):
        yield Sample(who, motion, partial(score_session, parts=parts))


def join_sessions(name: str, every: int) -> Iterator[tuple[str, Motion, list[Exercise]]]:
    """Yield each person, the joined session, and its exercises."""
    people = defaultdict(list)
    for key, path, rows in list_body_recordings(name, "labels.csv"):
        people[PERSON.findall(key)[-1]].append((path, rows))
    rng = np.random.default_rng(0)
    for who, made in list(people.items()):
        order = rng.permutation(len(made)).tolist()
        motion, parts = join_takes([made[i] for i in order])
        if list(people).index(who) % every == 0:
            yield who, motion, parts


def join_takes(
    made: list[tuple[Path, list[dict[str, str]]]],
) -> tuple[Motion, list[Exercise]]:
    """Join takes to a session; all start at the same point on the floor."""
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
    """Remove joints that some takes lack, such as unseen markers."""
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


def score_session(found: Segmentation, parts: list[Exercise]) -> Judged:
    """Score frames in the right class, borders between exercises, and counts."""
    clusters = found.per_frame(level="activity")
    classes = {part.label: i for i, part in enumerate(parts)}
    truth = np.full(found.n_frames, -1)
    for part in parts:
        truth[part.start : part.stop] = classes[part.label]
    seen = truth >= 0
    compared = Comparison(truth[seen], clusters[seen], found.fps)
    true = [part.stop / found.fps + STANDING_S / 2 for part in parts[:-1]]
    starts = {row.start_s for row in found.activities if row.kind == "activity"} - {0.0}
    right = [count_repetitions(found, part.start, part.stop) == part.count for part in parts]
    return {
        "one_to_one": one_to_one_accuracy(compared),
        "border_f1": 2 * len(match_times(true, sorted(starts), NEAR_S)) / (len(true) + len(starts)),
        "counts": Ratio(sum(right), len(right)),
    }


def count_repetitions(found: Segmentation, start: float, stop: float) -> int:
    """Return the largest number of repetitions of one cluster between two frames."""
    rows = select_repetitions(found)
    middles = (rows.start_frame + rows.stop_frame) / 2
    margin = TAGGED_S * found.fps
    inside = rows[(start - margin <= middles) & (middles <= stop + margin)]
    return max(Counter(inside.cluster.tolist()).values(), default=0)


def judge_gestures(every: int) -> Iterator[Sample]:
    """Yield recordings of one of twelve gestures at irregular times, each with a tag."""

    def judge(found: Segmentation, rows: list[dict[str, str]]) -> Judged:
        tags = sorted(float(row["time_s"]) for row in rows)
        units = select_repetitions(found)
        best = max(
            (score_tags(tags, units[units.cluster == c]) for c in np.unique(units.cluster)),
            default=0.0,
        )
        return {"f1": best, "exact": float(count_most_repeated(found) == len(tags))}

    for key, path, rows in list_body_recordings("msrc12", "events.csv")[::every]:
        yield Sample(key, kineme.read(path), partial(judge, rows=rows))


def score_tags(tags: list[float], units: SegmentTable) -> float:
    """Return the F1 score of occurrences, matched one to one with tags."""
    free = [(row.start_s - TAGGED_S, row.stop_s + TAGGED_S) for row in units]
    hits = 0
    for tag in tags:
        at = next((span for span in free if span[0] <= tag < span[1]), None)
        if at is not None:
            free.remove(at)
            hits += 1
    return 2 * hits / (len(units) + len(tags))


def judge_videos(every: int) -> Iterator[Sample]:
    """Yield exercises from video, counted by people."""

    def judge(found: Segmentation, rows: list[dict[str, str]]) -> Judged:
        true, own = int(rows[0]["count"]), count_most_repeated(found)
        wrong = abs(own - true)
        return {"within_one": float(wrong <= 1), "error": wrong / max(1, true)}

    for key, path, rows in list_body_recordings("countix", "counts.csv")[::every]:
        yield Sample(key, kineme.read(path), partial(judge, rows=rows))


def judge_labelled(
    place: str,
    names: Sequence[str],
    read: Callable[[Path], Motion | Signals],
    every: int,
) -> Iterator[Sample]:
    """Yield the recordings of a folder that people labelled."""

    def judge(found: Segmentation, source: LabelSource) -> Judged:
        truth = source.of(n_frames=found.n_frames, fps=found.fps)
        return compute_scores(names, compare(truth, found))

    labels = find_labels(find_recordings(DATA / place), DATA / place / "labels.csv")
    for path, source in list(labels.items())[::every]:
        yield Sample(path.stem, read(path), partial(judge, source=source))


def compute_scores(names: Sequence[str], compared: Comparison) -> Judged:
    return {name: scores()[name].function(compared) for name in names}


def judge_continuous(place: str) -> Callable[[int], Iterator[Sample]]:
    """Return a source of uncut recordings of several activities."""
    return partial(judge_labelled, place, CONTINUOUS, kineme.read)


def judge_sensors(name: str) -> Callable[[int], Iterator[Sample]]:
    """Return a source of recordings of sensors, or of joints as channels."""
    return partial(judge_labelled, f"sets/{name}", LABELLED, read_sensors)


class Piece(NamedTuple):
    """A recording and the class of each frame, `UNLABELLED` without a label."""

    name: str
    recording: Signals
    truth: NDArray[np.int64]


def read_pieces(folder: Path) -> Iterator[Piece]:
    """Read the recordings of a set (quick: two)."""
    sources = find_labels(find_recordings(folder / "recordings"), folder / "labels.csv")
    for path, source in list(sources.items())[: choose_size(None, 2)]:
        one = read_sensors(path)
        if isinstance(one, Signals):
            truth = source.of(n_frames=one.n_frames, fps=one.fps)
            yield Piece(path.stem, one, list_classes(truth))


def list_classes(truth: Segmentation) -> NDArray[np.int64]:
    numbers: dict[str, int] = {}
    classes = np.full(truth.n_frames, UNLABELLED, np.int64)
    for row in truth.activities:
        if row.kind != "transition":
            number = numbers.setdefault(format_text(row), len(numbers))
            classes[row.start_frame : row.stop_frame] = number
    return classes


def join_signals(pieces: Sequence[Piece]) -> Signals:
    """Concatenate recordings at the rate of the first."""
    first = pieces[0].recording
    values = np.concatenate([piece.recording.values for piece in pieces])
    return Signals(values, first.fps, first.names)


def judge_people(name: str, every: int) -> Iterator[Sample]:
    """Yield the joined recordings of each person, to test whether file length matters."""
    people = defaultdict(list)
    for piece in read_pieces(DATA / "sets" / name):
        people[piece.name.rpartition("_")[0]].append(piece)

    def judge(found: Segmentation, parts: list[Piece]) -> Judged:
        ends = np.cumsum([len(part.truth) for part in parts])[:-1]
        each = zip(parts, np.split(found.per_frame(level="activity"), ends), strict=True)
        judged = [
            compute_scores(LABELLED, Comparison(part.truth[known], clusters[known], found.fps))
            for part, clusters in each
            if (known := part.truth != UNLABELLED).any()
        ]
        return {name: pool_scores(one[name] for one in judged) for name in LABELLED}

    for who, parts in list(people.items())[::every]:
        yield Sample(who, join_signals(parts), partial(judge, parts=parts))


def judge_barbell(every: int) -> Iterator[Sample]:
    """Yield wrist sensor recordings of barbell sets with the planned count."""
    folder = DATA / "sets" / "barbell"
    rows = [
        row for (row,) in read_rows(folder / "counts.csv").values() if row["exercise"] != "rest"
    ]

    def judge(found: Segmentation, planned: int) -> Judged:
        return score_counts([count_most_repeated(found) - planned])

    for row in rows[::every]:
        recording = read_sensors(folder / "recordings" / f"{row['recording']}.parquet")
        yield Sample(row["recording"], recording, partial(judge, planned=int(row["nominal_count"])))


def judge_counted_sets(name: str, every: int) -> Iterator[Sample]:
    """Yield sensor recordings with several sets of repetitions, counted by people."""
    folder = DATA / "sets" / name

    def judge(found: Segmentation, rows: list[dict[str, str]]) -> Judged:
        spans = [[found.fps * float(row[end]) for end in ENDS] for row in rows]
        counts = [count_repetitions(found, *span) for span in spans]
        true = [int(row["count"]) for row in rows]
        return score_counts([own - count for own, count in zip(counts, true, strict=True)])

    files = {path.stem: path for path in find_recordings(folder / "recordings")}
    for key, rows in list(read_rows(folder / "counts.csv").items())[::every]:
        yield Sample(key, kineme.read(files[key]), partial(judge, rows=rows))


def count_most_repeated(found: Segmentation) -> int:
    """Return the repetitions of the largest cluster; 0 if it has only one."""
    counts = Counter(select_repetitions(found).cluster.tolist())
    most = max(counts.values(), default=0)
    return most if most > 1 else 0


def score_counts(errors: Sequence[int]) -> Judged:
    """Return how many counts are right, and how many within one, from found minus true counts."""
    return {
        "exact": Ratio(sum(each == 0 for each in errors), len(errors)),
        "within_one": Ratio(sum(abs(each) <= 1 for each in errors), len(errors)),
    }


SOURCES: Mapping[str, Callable[[int], Iterator[Sample]]] = {
    "subject_86": lambda every: judge_cases(read_subject_86(), every),
    "mocap6": judge_continuous("mocap6"),
    "takes": judge_continuous("rigs/takes"),
    "tug": judge_continuous("bodies/tug"),
    "hdm05": lambda every: judge_cases(join_hdm05(50), every),
    "synthetic": lambda every: judge_cases(synthesize_cases("all", 20), every),
    "uiprmd": partial(judge_takes, "uiprmd"),
    "uiprmd_sessions": partial(judge_sessions, "uiprmd"),
    "uiprmd_incorrect": partial(judge_takes, "uiprmd_incorrect"),
    "uiprmd_incorrect_sessions": partial(judge_sessions, "uiprmd_incorrect"),
    "msrc12": judge_gestures,
    "countix": judge_videos,
    "sparse_events": partial(judge_sparse_events, 50),
    "hugadb": judge_sensors("hugadb"),
    "hapt": judge_sensors("hapt"),
    "ipolgait": judge_sensors("ipolgait"),
    "utkinect": judge_sensors("utkinect"),
    "hugadb_by_person": partial(judge_people, "hugadb"),
    "barbell": judge_barbell,
    "swimming": judge_sensors("swimming"),
    "ptex": partial(judge_counted_sets, "ptex"),
    "gym_watch": partial(judge_counted_sets, "gym_watch"),
    "moca": partial(judge_counted_sets, "moca"),
}
"""Functions by name that yield every n-th recording of a source."""
