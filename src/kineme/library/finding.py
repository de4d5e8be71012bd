"""Search all recordings of a library for spans similar to examples, but not to counter-examples.

In a large library an index finds the windows nearest to an example first
(`kineme.library.windows`, `kineme.library.storage.tables`). Only the parts of recordings around
these are searched sample by sample, in this process or by an executor.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Float32s, Ints
from kineme._util.checks import is_number, is_one_of, warn
from kineme._util.files import AnyPath
from kineme._util.parallel import map_threads
from kineme.clips.root_motion import TAGS, Tag, Travel, measure_travel
from kineme.errors import KinemeError, ParameterError, ReadError
from kineme.features.canonical import mirror_features
from kineme.library._kernels import find_smallest_distances
from kineme.library.descriptions import Description, describe
from kineme.library.executors import Executor
from kineme.library.open_library import OpenTables, find_cluster_numbers
from kineme.library.planning import read_recording
from kineme.library.storage.layout import ANALYSES, BODIES, make_path
from kineme.library.storage.tables import Windows, open_index, read_features, read_spans
from kineme.library.windows import FINER, choose_length, compute_step, describe_at_speeds
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import to_samples
from kineme.transfer.matching import Matches, choose_disjoint, search

REFUSED = 0.5
"""Fraction of a match that a nearer match of a counter-example must cover to reject it."""
SHARE = 0.01
"""Fraction of the windows around which samples are searched."""
MORE = 20
"""Least number of windows per wanted hit."""
BLOCK = 1 << 16
"""Number of windows compared at a time."""
BATCH_SAMPLES = 1 << 15
"""Samples that are searched at a time."""
BETWEEN_PARTS = 1e3
"""Value of all features between two parts, which no match can cross."""
TYPICAL = 5
"""Number of typical segments that represent a cluster in a search."""
BEYOND = 0.1
"""Seconds by which an example may exceed its recording without a warning."""
LARGEST, MOST_HITS = 1e6, 1 << 31


@dataclass(frozen=True)
class Example:
    """A span of a recording to search for.

    Parameters
    ----------
    recording : path-like, Motion or Signals
        A file, the name of a recording of the library, or a loaded recording.
    start_s, stop_s : float, optional
        Seconds; the whole recording by default.

    Examples
    --------
    >>> Example("walk.bvh", 2.1, 3.4).stop_s
    3.4
    """

    recording: str | PathLike[str] | Motion | Signals
    start_s: float = 0.0
    stop_s: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.recording, str | PathLike | Motion | Signals):
            raise ParameterError(
                f"an example is a file, a name or a recording, not {self.recording!r:.60}"
            )
        stop = np.inf if self.stop_s is None else self.stop_s
        numbers = is_number(self.start_s) and (self.stop_s is None or is_number(stop))
        if not numbers or not 0 <= self.start_s < stop:
            raise ParameterError(
                f"an example must stop after it starts, not last from {self.start_s!r:.20} "
                f"to {self.stop_s!r:.20}"
            )


class Named(str):
    """Name of a recording of the library, even if a file has the same name."""

    __slots__ = ()


class Hit(NamedTuple):
    """A span of a recording that is similar to an example.

    Attributes
    ----------
    recording : str
    start_s, stop_s : float
    distance : float
        0 for equal movements.
    cluster : int
        Cluster of the segment that covers most of it, -1 for none.
    label : str
        Name of that cluster.

    Examples
    --------
    >>> hit = Hit("walk.bvh", 2.0, 3.2, 0.4, 7, "step")
    >>> round(hit.stop_s - hit.start_s, 1), hit.label
    (1.2, 'step')
    """

    recording: str
    start_s: float
    stop_s: float
    distance: float
    cluster: int
    label: str


@dataclass(frozen=True, eq=False)
class Query:
    """Query: features (samples, dims) of examples; at most ``top`` matches per task."""

    examples: Sequence[Float32s]
    counterexamples: Sequence[Float32s]
    threshold: float
    top: int | None


def find_hits(
    tables: OpenTables,
    examples: Sequence[Example],
    counterexamples: Sequence[Example],
    *,
    threshold: float,
    top: int | None,
    max_per_recording: int | None,
    mirror: bool,
    executor: Executor | None = None,
) -> list[Hit]:
    """Return the spans similar to any example, the nearest first."""
    top = _as_limit(top, "top")
    max_per_recording = _as_limit(max_per_recording, "max_per_recording")
    if not (is_number(threshold) and threshold > 0):
        raise ParameterError(f"the threshold must be a number above 0, not {threshold!r:.60}")
    threshold = min(float(threshold), LARGEST)  # no distance is larger
    described = describe_examples(tables, examples)
    vocabulary = check_one_vocabulary(described)
    features = [part for _, part in described]
    if mirror and vocabulary == BODIES:
        features += [mirror_features(part) for part in features]
    counter_features = [
        part for kind, part in describe_examples(tables, counterexamples) if kind == vocabulary
    ]
    query = Query(features, counter_features, threshold, None if max_per_recording else top)
    parts = _list_parts(tables, vocabulary)
    if top is not None and vocabulary == BODIES:
        parts = _find_likely_parts(tables, features, top) or parts
    matches = find_matches_in_parts(
        tables.folder / ANALYSES, tables.recordings["piece"], parts, query, executor
    )
    spans = [
        (distance, row, start, stop)
        for row, each in matches.items()
        for start, stop, distance in zip(
            *(column[:max_per_recording].tolist() for column in each), strict=True
        )
    ]
    return [_make_hit(tables, *span) for span in sorted(spans)[:top]]


def _as_limit(value: int | None, name: str) -> int | None:
    """Return a largest number of hits, None for all; raise ParameterError if it is invalid."""
    if value is None:
        return None
    if not (is_number(value) and value >= 1):
        raise ParameterError(f"{name} must be a whole number above 0, not {value!r:.60}")
    return int(min(value, MOST_HITS))


def select_tagged(tables: OpenTables, hits: Sequence[Hit], tag: Tag, top: int | None) -> list[Hit]:
    """Return the nearest ``top`` hits that have a tag; raise ParameterError if it is unknown."""
    if not is_one_of(tag, TAGS):
        raise ParameterError(f"tag is {tag!r:.60}: choose from {', '.join(TAGS)}")
    found: list[Hit] = []
    travels: dict[str, Travel | None] = {}
    for hit in hits:
        if top is not None and len(found) >= top:
            break
        if hit.recording not in travels:
            motion = tables.read(hit.recording)
            travels[hit.recording] = measure_travel(motion) if isinstance(motion, Motion) else None
        travel = travels[hit.recording]
        if travel is not None:
            span = to_samples((hit.start_s, hit.stop_s), travel.fps, len(travel.velocities))
            found += [hit] if tag in travel.tags(*span) else []
    return found


def as_examples(
    like: AnyPath | Motion | Signals | Example | Hit | Sequence[Example | Hit] | None,
    start_s: float,
    stop_s: float | None,
) -> list[Example]:
    """Return the arguments of a search as examples; hits refer to recordings of the library."""
    if like is None:
        return []
    if isinstance(like, str | PathLike | Motion | Signals):
        return [Example(like, start_s, stop_s)]
    items = list(like) if isinstance(like, Iterable) and not isinstance(like, Hit) else [like]
    examples = []
    for example in items:
        if isinstance(example, Hit):
            examples.append(Example(Named(example.recording), example.start_s, example.stop_s))
        elif isinstance(example, Example):
            examples.append(example)
        else:
            raise ParameterError(
                f"an example is a file, a name, a recording, a Hit or an Example, not "
                f"{example!r:.60}"
            )
    return examples


def choose_typical_examples(tables: OpenTables, cluster: int | str) -> list[Example]:
    """Return the most typical segments of a cluster (by number or name) as examples."""
    local = tables.columns("local_clusters")
    rows = np.flatnonzero(np.isin(local["cluster"], find_cluster_numbers(tables, cluster)))
    rows = rows[np.argsort(local["spread"][rows], kind="stable")][:TYPICAL]
    columns = (local[name][rows].tolist() for name in ("recording", "start_s", "stop_s"))
    return [Example(Named(name), *span) for name, *span in zip(*columns, strict=True)]


def describe_examples(
    tables: OpenTables, examples: Sequence[Example]
) -> list[tuple[str, Float32s]]:
    """Return the vocabulary and features of each example."""
    descriptions = []
    for example in examples:
        described = _describe_recording(tables, example.recording)
        duration_s = len(described.features) / described.fps
        stop_s = duration_s if example.stop_s is None else min(example.stop_s, duration_s)
        if example.stop_s is not None and example.stop_s > duration_s + BEYOND:
            warn(
                f"the example stops at {example.stop_s:g} s, its recording lasts "
                f"{duration_s:.2f} s: used up to its end"
            )
        if example.start_s >= stop_s:
            raise ParameterError(
                f"the example starts at {example.start_s:g} s, its recording lasts "
                f"{duration_s:.2f} s"
            )
        descriptions.append((described.vocabulary, described.select(example.start_s, stop_s)))
    return descriptions


def check_one_vocabulary(described: Sequence[tuple[str, Float32s]]) -> str:
    """Return the vocabulary of all examples; raise ParameterError if they have several."""
    kinds = sorted({kind for kind, _ in described})
    if len(kinds) > 1:
        raise ParameterError(f"the examples cannot be compared with each other: {'; '.join(kinds)}")
    return kinds[0]


def _describe_recording(tables: OpenTables, recording: AnyPath | Motion | Signals) -> Description:
    """Return the features of a recording, taken from the library if it is in it."""
    recordings, (read_options, segment_options) = tables.recordings, tables.options
    # A text is a path if there is such a file, else the name of a recording.
    if isinstance(recording, str) and (
        isinstance(recording, Named) or not make_path(recording).exists()
    ):
        if recording not in recordings["recording"]:
            raise ReadError(recording, "there is no file or recording with that name")
        row = recordings["recording"].index(recording)
        features = read_features(tables.folder / ANALYSES, recordings["piece"][row])
        described = Description(
            recordings["vocabulary"][row], features, recordings["features_fps"][row]
        )
        return _check_comparable(described, recording)
    example = recording
    if not isinstance(example, Motion | Signals):
        example = read_recording(make_path(example), read_options)
    described = describe(example, segment_options)
    return _check_comparable(described, example.provenance.path or "the example")


def _check_comparable(described: Description, name: str) -> Description:
    """Return the description; raise ReadError if it has no features."""
    if not described.vocabulary:
        reason = described.reason or "no body was recognised in it"
        raise ReadError(name, f"cannot be searched for: {reason}")
    return described


class Parts(NamedTuple):
    """Parts [start, stop) of recordings in samples, sorted by recording."""

    rows: Ints
    starts: Ints
    stops: Ints


@dataclass(frozen=True, eq=False)
class Task:
    """Parts to search together, and the analysis keys of their recordings by row."""

    folder: Path
    analyses: dict[int, str]
    parts: Parts
    query: Query


def _list_parts(tables: OpenTables, vocabulary: str) -> Parts:
    """Return all recordings of a vocabulary (bodies, or certain channels) as parts.

    Raise ParameterError if there are none, as others cannot be compared with the example.
    """
    vocabularies = tables.recordings["vocabulary"]
    rows = np.array([i for i, own in enumerate(vocabularies) if own == vocabulary], np.int64)
    if not len(rows):
        present = "; ".join(sorted(set(vocabularies) - {""}))
        raise ParameterError(
            f"the example has {vocabulary}, but the library has {present or 'nothing'}"
        )
    samples = np.array(tables.recordings["samples"], np.int64)[rows]
    return Parts(rows, starts=np.zeros_like(rows), stops=samples)


def _find_likely_parts(tables: OpenTables, examples: Sequence[Float32s], top: int) -> Parts | None:
    """Return the parts most similar to any example by the index; None if there is no index."""
    found = []
    for example in examples:
        windows = open_index(
            tables.folder, tables.head["tables"], tables.recordings, choose_length(example)
        )
        if windows is None:
            return None
        found.append(find_parts(windows, example, top))
    return merge_overlapping(
        Parts(*(np.concatenate(column) for column in zip(*found, strict=True)))
    )


def find_parts(windows: Windows, example: Float32s, top: int) -> Parts:
    """Return the parts of recordings around the windows that are nearest to an example."""
    nearest = _find_nearest(windows, describe_at_speeds(example), top)
    rows = np.searchsorted(windows.firsts, nearest, side="right") - 1
    middles = (nearest - windows.firsts[rows]) * compute_step(windows.length) + windows.length // 2
    reach = compute_step(windows.length) + len(example)  # a match may be twice as long
    n_samples = windows.samples[rows]
    return merge_overlapping(
        Parts(rows, np.clip(middles - reach, 0, n_samples), np.clip(middles + reach, 0, n_samples))
    )


def _find_nearest(windows: Windows, parts: NDArray[np.int32], top: int) -> Ints:
    """Return the indices of the windows nearest to any part of an example, sorted."""
    n = len(windows.embedded)
    least = np.empty(n, np.int32)

    def compare(first: int) -> None:
        block = slice(first, first + BLOCK)
        find_smallest_distances(
            np.asarray(windows.embedded[block]), parts, np.int32(FINER), least[block]
        )

    map_threads(compare, range(0, n, BLOCK))
    most = min(max(round(SHARE * n), MORE * top), n)
    # `argpartition` finds the smallest distances without sorting all.
    chosen: NDArray[np.int64] = np.sort(np.argpartition(least, most - 1)[:most])
    return chosen


def merge_overlapping(parts: Parts) -> Parts:
    """Merge parts that overlap or touch."""
    order = np.lexsort((parts.starts, parts.rows))
    rows, starts, stops = (column[order] for column in parts)
    far = int(stops.max(initial=0)) + 1
    # Offsets by row keep the parts of different recordings apart in one running maximum.
    reached = np.maximum.accumulate(stops + rows * far)
    new = np.ones(len(rows), np.bool_)
    new[1:] = starts[1:] + rows[1:] * far > reached[:-1]
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(rows)) - 1 if len(rows) else first
    return Parts(rows[first], starts[first], reached[last] - rows[first] * far)


def find_matches_in_parts(
    folder: Path, analyses: Sequence[str], parts: Parts, query: Query, executor: Executor | None
) -> dict[int, Matches]:
    """Return the matches in parts of recordings by row, the best first."""
    tasks = [
        Task(folder, {row: analyses[row] for row in set(batch.rows.tolist())}, batch, query)
        for batch in _make_batches(parts)
    ]
    if executor is None:
        with threadpool_limits(1):  # tasks use all cores already
            outcomes = map_threads(search_parts, tasks)
    else:
        outcomes = []
        for _, outcome in executor.completed(search_parts, tasks):
            if outcome is None:
                raise KinemeError("the search processes died: they may need more memory")
            outcomes.append(outcome)
    by_row: dict[int, list[Matches]] = {}
    for each in outcomes:
        for row, matches in each.items():
            by_row.setdefault(row, []).append(matches)
    return {row: _order_matches(several) for row, several in sorted(by_row.items())}


def _make_batches(parts: Parts) -> Iterator[Parts]:
    """Yield batches of parts with about `BATCH_SAMPLES` samples; a longer part is alone."""
    reached = np.cumsum(parts.stops - parts.starts)
    batches = (reached - (parts.stops - parts.starts)) // BATCH_SAMPLES
    # Borders between batches, including both ends.
    edges = np.flatnonzero(np.diff(batches, prepend=-1, append=-1))
    for first, stop in pairwise(edges.tolist()):
        yield Parts(*(column[first:stop] for column in parts))


def search_parts(task: Task) -> dict[int, Matches]:
    """Return the matches in the parts of a task by row, the best first."""
    parts, query = task.parts, task.query
    lengths = parts.stops - parts.starts
    # Concatenate all parts, separated by one sample that matches nothing.
    firsts = np.concatenate([[0], np.cumsum(lengths + 1)])
    features = np.full((firsts[-1], query.examples[0].shape[1]), BETWEEN_PARTS, np.float32)
    for row, key in sorted(task.analyses.items()):
        at = np.flatnonzero(parts.rows == row)
        spans = zip(parts.starts[at].tolist(), parts.stops[at].tolist(), strict=True)
        for first, part in zip(firsts[at], read_spans(task.folder, key, spans), strict=True):
            features[first : first + len(part)] = part
    matches = find_matches(
        features, query.examples, query.counterexamples, threshold=query.threshold, top=query.top
    )
    # Convert positions in the concatenation back to samples of recordings.
    owners = np.searchsorted(firsts, matches.starts, side="right") - 1
    offsets = parts.starts[owners] - firsts[owners]
    moved = Matches(matches.starts + offsets, matches.stops + offsets, matches.distances)
    rows = parts.rows[owners]
    return {row: Matches(*(column[rows == row] for column in moved)) for row in set(rows.tolist())}


def find_matches(
    features: Float32s,
    examples: Sequence[Float32s],
    counterexamples: Sequence[Float32s],
    *,
    threshold: float,
    top: int | None,
) -> Matches:
    """Return disjoint spans of a recording that are similar to any example.

    Spans that are nearer to a counter-example are rejected.
    """
    matches = _merge_matches(features, examples, threshold, None if counterexamples else top)
    if counterexamples and len(matches.starts):
        others = _merge_matches(features, counterexamples, threshold, None)
        # (matches, others): samples shared by each pair of spans.
        first = np.maximum(matches.starts[:, None], others.starts[None])
        shared = np.minimum(matches.stops[:, None], others.stops[None]) - first
        covers = shared >= REFUSED * (matches.stops - matches.starts)[:, None]
        nearer = others.distances[None] < matches.distances[:, None]
        rows = np.flatnonzero(~(covers & nearer).any(axis=1))
        matches = _select_rows(matches, rows)
    return _select_rows(matches, slice(top))


def _merge_matches(
    features: Float32s, examples: Sequence[Float32s], threshold: float, top: int | None
) -> Matches:
    """Return disjoint spans that are similar to any example, the best first."""
    several = [search(example, features, threshold=threshold, top=top) for example in examples]
    if len(several) == 1:
        return several[0]
    ordered = _order_matches(several)
    spans = ordered.starts.tolist(), ordered.stops.tolist()
    return _select_rows(ordered, choose_disjoint(*spans, len(features)))


def _order_matches(several: Sequence[Matches]) -> Matches:
    """Merge matches of one recording, the best first."""
    if len(several) == 1:
        return several[0]
    starts, stops, distances = (np.concatenate(column) for column in zip(*several, strict=True))
    order = np.lexsort((starts, distances))
    return Matches(starts[order], stops[order], distances[order])


def _select_rows(matches: Matches, rows: slice | Ints) -> Matches:
    return Matches(matches.starts[rows], matches.stops[rows], matches.distances[rows])


def _make_hit(tables: OpenTables, distance: float, row: int, start: int, stop: int) -> Hit:
    """Return a span of samples as a hit, with the cluster of the segment that covers most of it.

    If two segments cover equally much, the primitive counts.
    """
    recording = tables.recordings["recording"][row]
    fps, duration_s = (tables.recordings[name][row] for name in ("features_fps", "duration_s"))
    start_s, stop_s = start / fps, min(stop / fps, duration_s)
    segments = tables.columns("segments")
    rows = tables.rows[recording]
    # Overlap of each segment with the span, rounded so that ties are exact.
    shared = np.minimum(segments["stop_s"][rows], stop_s)
    shared = np.round(shared - np.maximum(segments["start_s"][rows], start_s), 6)
    # The last key of `lexsort` is the primary one: largest overlap, then primitives.
    covers = int(np.lexsort((segments["level"][rows] == "primitive", shared))[-1])
    cluster = int(segments["cluster"][rows][covers])
    label = tables.edits.name(cluster) if cluster >= 0 else ""
    return Hit(recording, start_s, stop_s, round(distance, 4), cluster, label)
