"""From the analyses of a library to its tables: one vocabulary over all recordings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Ints
from kineme.library.executors import Executor, Progress
from kineme.library.planning import Entry
from kineme.library.settings import VOCABULARY
from kineme.library.storage.analyses import Analysis, read_analysis
from kineme.library.storage.layout import ANALYSES, BODIES, EMBEDDED, arrow, as_array, as_column
from kineme.library.storage.tables import read_table, table_of
from kineme.library.vocabulary.joining import Joined, clusters_in
from kineme.library.vocabulary.numbering import Spans, lasting_numbers
from kineme.library.vocabulary.words import Place, crowd_of, places_in
from kineme.segments.table import COLUMNS

Columns = dict[str, Any]


@dataclass(frozen=True, eq=False)
class _Words:
    """The words of all recordings, and what became of them."""

    places: list[Place]
    joined: Joined


def compiled(
    folder: Path,
    entries: Sequence[Entry],
    before: Mapping[str, Spans],
    following: int,
    executor: Executor,
    progress: Progress,
) -> tuple[dict[str, Any], int]:
    """Return the tables of a library by name, and the first number that no cluster was given.

    ``entries`` are in the order of their names, ``before`` are the activities that recordings had,
    see `activities_in`: clusters that are found again keep their numbers.
    """
    analyses = [read_analysis(folder / ANALYSES, key) for _, _, key in entries]
    words = _joined_words(folder, entries, analyses, executor, progress)
    shared = _shared(analyses, words)
    new = {
        name: _spans(analysis.table.columns(), clusters)
        for (name, _, _), analysis, clusters in zip(entries, analyses, shared, strict=True)
    }
    numbers = lasting_numbers(before, new, following=following)
    renumbered = np.array([*numbers.values(), -1], np.int64)  # labels are 0, 1, …
    tables = {
        "recordings": _recordings(entries, analyses),
        "segments": _segments(entries, analyses, [renumbered[each] for each in shared]),
        "words": _word_table(entries, words, renumbered),
        "embeddings": _embeddings(entries, analyses),
    }
    return {name: table_of(name, columns) for name, columns in tables.items()}, max(
        [following, *(number + 1 for number in numbers.values())]
    )


def activities_in(folder: Path, tables: str | None) -> dict[str, Spans]:
    """Return the activities of each recording with their clusters, in tables of a library."""
    if tables is None:
        return {}
    table = read_table(folder, tables, "segments")
    names = ("recording", "level", "kind", "start_s", "stop_s", "cluster")
    columns = {name: as_array(table.column(name)) for name in names}
    first = np.unique(columns["recording"], return_index=True)[1]
    edges = [*np.sort(first).tolist(), len(table)]
    found = {}
    for start, stop in pairwise(edges):
        rows = {name: column[start:stop] for name, column in columns.items()}
        found[str(rows["recording"][0])] = _spans(rows, rows["cluster"])
    return found


def _joined_words(
    folder: Path,
    entries: Sequence[Entry],
    analyses: Sequence[Analysis],
    executor: Executor,
    progress: Progress,
) -> _Words:
    """Return the words of each vocabulary, joined; clusters are counted on from one to the next."""
    places: list[Place] = []
    parts: list[Joined] = []
    count = 0
    for vocabulary in sorted({analysis.facts["vocabulary"] for analysis in analyses} - {""}):
        words = [
            place
            for number, analysis in enumerate(analyses)
            if analysis.facts["vocabulary"] == vocabulary
            for place in places_in(analysis, number)
        ]
        if not words:
            continue
        keys = [key for _, _, key in entries]
        if vocabulary == BODIES or len({place.recording for place in words}) == 1:
            crowd = crowd_of(words, analyses, folder / ANALYSES, keys)
            found = clusters_in(crowd, VOCABULARY, executor, progress)
        else:
            from kineme.library.vocabulary.signals import clusters_of_signals

            found = clusters_of_signals(words, analyses, folder / ANALYSES, keys, executor)
        following = np.where(found.following < 0, -1, found.following + count)
        places += words
        parts.append(found._replace(labels=found.labels + count, following=following))
        count += int(found.labels.max()) + 1
    if not places:
        none = np.empty(0, np.int64)
        return _Words([], Joined(none, none, np.empty(0), np.empty(0)))
    return _Words(places, Joined(*map(np.concatenate, zip(*parts, strict=True))))


def _shared(analyses: Sequence[Analysis], words: _Words) -> list[Ints]:
    """Return the cluster of each segment of each analysis in the common vocabulary, -1 in none."""
    label = {
        (place.recording, place.cluster): cluster
        for place, cluster in zip(words.places, words.joined.labels.tolist(), strict=True)
    }
    return [
        np.array(
            [label.get((i, number), -1) for number in analysis.table.cluster.tolist()], np.int64
        )
        for i, analysis in enumerate(analyses)
    ]


def _spans(columns: Columns, clusters: Ints) -> Spans:
    """Return the activities of a recording with their clusters, and what only primitives are of."""
    active, coarse = columns["kind"] != "transition", columns["level"] == "activity"
    rows = active & (coarse | ~np.isin(clusters, clusters[active & coarse]))
    return columns["start_s"][rows], columns["stop_s"][rows], clusters[rows]


def _recordings(entries: Sequence[Entry], analyses: Sequence[Analysis]) -> Columns:
    facts = [analysis.facts for analysis in analyses]
    names = ("vocabulary", "format", "n_frames", "fps", "features_fps", "samples")
    return {
        "recording": [name for name, _, _ in entries],
        "path": [str(path) for _, path, _ in entries],
        **{name: [each[name] for each in facts] for name in names},
        "duration_s": [each["n_frames"] / each["fps"] for each in facts],
        "piece": [key for _, _, key in entries],
        "notes": ["\n".join(each["notes"]) for each in facts],
    }


def _segments(
    entries: Sequence[Entry], analyses: Sequence[Analysis], clusters: Sequence[Ints]
) -> Columns:
    tables = [analysis.table for analysis in analyses]
    columns: Columns = {name: _all(getattr(table, name) for table in tables) for name in COLUMNS}
    actions = [
        numbers[np.flatnonzero(table.level == "activity")][table.activity]
        for numbers, table in zip(clusters, tables, strict=True)
    ]
    return {
        **_rows(entries, analyses),
        **columns,
        "cluster": _all(clusters),
        "action": _all(actions),
        "own_cluster": columns["cluster"],
    }


def _word_table(entries: Sequence[Entry], words: _Words, numbers: Ints) -> Columns:
    return {
        "recording": [entries[place.recording][0] for place in words.places],
        "own_cluster": [place.cluster for place in words.places],
        "cluster": numbers[words.joined.labels],
        "following": numbers[words.joined.following],
        "confidence": words.joined.confidence,
        "spread": words.joined.spread,
        "start_s": [place.start_s for place in words.places],
        "stop_s": [place.stop_s for place in words.places],
        "seconds": [place.seconds for place in words.places],
    }


def _embeddings(entries: Sequence[Entry], analyses: Sequence[Analysis]) -> Columns:
    pa, _ = arrow()
    values = _all(analysis.embeddings for analysis in analyses).reshape(-1, EMBEDDED)
    embedded = np.flatnonzero(values.any(axis=1))
    rows = {
        name: np.asarray(column)[embedded] if len(column) else column
        for name, column in _rows(entries, analyses).items()
    }
    flat = as_column(values[embedded].ravel(), np.float32)
    return {**rows, "embedding": pa.FixedSizeListArray.from_arrays(flat, EMBEDDED)}


def _rows(entries: Sequence[Entry], analyses: Sequence[Analysis]) -> Columns:
    counts = [len(analysis.table) for analysis in analyses]
    return {
        "recording": [n for (n, _, _), k in zip(entries, counts, strict=True) for _ in range(k)],
        "segment": _all(np.arange(count) for count in counts),
    }


def _all(parts: Iterable[NDArray[Any]]) -> NDArray[Any]:
    """Return the parts one after the other, of which there may be none."""
    given = list(parts)
    return np.concatenate(given) if given else np.empty(0)
