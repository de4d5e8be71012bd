"""Search all recordings of a library for spans similar to examples."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike

import numpy as np

from kineme._util.arrays import Float32s
from kineme._util.checks import is_number, is_one_of, warn
from kineme._util.files import AnyPath
from kineme.clips.tags import TAGS, Tag, Travel, measure_travel
from kineme.errors import ParameterError, ReadError
from kineme.features.canonical import mirror_features
from kineme.library.descriptions import Description, describe
from kineme.library.executors import Executor
from kineme.library.open_library import OpenTables, find_cluster_numbers
from kineme.library.planning import read_recording
from kineme.library.searching import (
    Example,
    Hit,
    Named,
    Parts,
    Query,
    choose_best,
    find_matches_in_parts,
    find_parts,
    merge_overlapping,
)
from kineme.library.storage.analyses import read_features
from kineme.library.storage.index import open_index
from kineme.library.storage.layout import ANALYSES, BODIES
from kineme.library.storage.places import make_path
from kineme.library.windows import choose_length
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import to_samples

TYPICAL = 5
"""Number of typical segments that represent a cluster in a search."""

BEYOND = 0.1
"""Seconds by which an example may exceed its recording without a warning."""
LARGEST, MOST_HITS = 1e6, 1 << 31


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
    for name, value in (("top", top), ("max_per_recording", max_per_recording)):
        if value is not None and not (is_number(value) and value >= 1):
            raise ParameterError(f"{name} must be a whole number above 0, not {value!r:.60}")
    if not (is_number(threshold) and threshold > 0):
        raise ParameterError(f"the threshold must be a number above 0, not {threshold!r:.60}")
    threshold = min(float(threshold), LARGEST)  # no distance is larger
    top = None if top is None else int(min(top, MOST_HITS))
    if max_per_recording is not None:
        max_per_recording = int(min(max_per_recording, MOST_HITS))
    described = describe_examples(tables, examples)
    if mirror and check_one_vocabulary(described) == BODIES:
        described += [(BODIES, mirror_features(part)) for _, part in described]
    vocabulary = check_one_vocabulary(described)
    counter_features = [
        part for kind, part in describe_examples(tables, counterexamples) if kind == vocabulary
    ]
    features = [part for _, part in described]
    query = Query(features, counter_features, threshold, None if max_per_recording else top)
    parts = _list_parts(tables, vocabulary)
    if top is not None and vocabulary == BODIES:
        parts = _find_likely_parts(tables, features, top) or parts
    matches = find_matches_in_parts(
        tables.folder / ANALYSES, tables.recordings["piece"], parts, query, executor
    )
    rows = list(matches)
    chosen = choose_best(list(matches.values()), top=top, most=max_per_recording)
    return [_make_hit(tables, rows[i], *span) for i, span in chosen]


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
            span = to_samples((hit.start_s, hit.stop_s), travel.fps, len(travel.looks))
            found += [hit] if tag in travel.tags(*span) else []
    return found


def _list_parts(tables: OpenTables, vocabulary: str) -> Parts:
    """Return all recordings of a vocabulary as parts."""
    rows = np.array(_find_rows(tables, vocabulary), np.int64)
    samples = np.array(tables.recordings["samples"], np.int64)[rows]
    return Parts(rows, np.zeros_like(rows), samples)


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


def choose_typical_examples(tables: OpenTables, cluster: int | str) -> list[Example]:
    """Return the most typical segments of a cluster (by number or name) as examples."""
    local = tables.columns("local_clusters")
    rows = np.flatnonzero(np.isin(local["cluster"], find_cluster_numbers(tables, cluster)))
    rows = rows[np.argsort(local["spread"][rows], kind="stable")][:TYPICAL]
    columns = (local[name][rows].tolist() for name in ("recording", "start_s", "stop_s"))
    return [Example(Named(name), *span) for name, *span in zip(*columns, strict=True)]


def _find_rows(tables: OpenTables, vocabulary: str) -> list[int]:
    """Return the rows of recordings with this vocabulary: bodies, or the same channels.

    Raise ParameterError if there are none, as others cannot be compared with the example.
    """
    vocabularies = tables.recordings["vocabulary"]
    rows = [row for row, own in enumerate(vocabularies) if own == vocabulary]
    if not rows:
        present = "; ".join(sorted(set(vocabularies) - {""}))
        raise ParameterError(
            f"the example has {vocabulary}, but the library has {present or 'nothing'}"
        )
    return rows


def _make_hit(tables: OpenTables, row: int, start: int, stop: int, distance: float) -> Hit:
    """Return a span of samples as a hit, with the cluster of the segment that covers most of it.

    If two segments cover equally much, the primitive counts.
    """
    recording = tables.recordings["recording"][row]
    fps, lasts = (tables.recordings[name][row] for name in ("features_fps", "duration_s"))
    start_s, stop_s = start / fps, min(stop / fps, lasts)
    segments = tables.columns("segments")
    rows = slice(*tables.rows.get(recording, (0, 0)))
    if rows.stop == rows.start:
        return Hit(recording, start_s, stop_s, round(distance, 4), -1, "")
    # Overlap of each segment with the span, rounded so that ties are exact.
    shared = np.minimum(segments["stop_s"][rows], stop_s)
    shared = np.round(shared - np.maximum(segments["start_s"][rows], start_s), 6)
    # The last key of `lexsort` is the primary one: largest overlap, then primitives.
    covers = int(np.lexsort((segments["level"][rows] == "primitive", shared))[-1])
    cluster = int(segments["cluster"][rows][covers])
    label = tables.edits.name(cluster) if cluster >= 0 else ""
    return Hit(recording, start_s, stop_s, round(distance, 4), cluster, label)


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


def describe_examples(
    tables: OpenTables, examples: Sequence[Example]
) -> list[tuple[str, Float32s]]:
    """Return the vocabulary and features of each example."""
    descriptions = []
    for example in examples:
        described = _describe_recording(tables, example.recording)
        lasts = len(described.features) / described.fps
        stop_s = lasts if example.stop_s is None else min(example.stop_s, lasts)
        if example.stop_s is not None and example.stop_s > lasts + BEYOND:
            warn(
                f"the example stops at {example.stop_s:g} s, its recording lasts "
                f"{lasts:.2f} s: used up to its end"
            )
        if example.start_s >= stop_s:
            raise ParameterError(
                f"the example starts at {example.start_s:g} s, its recording lasts {lasts:.2f} s"
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
