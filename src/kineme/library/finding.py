"""All recordings of a library, looked through for what is like examples."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from kineme._checks import is_number
from kineme.errors import ParameterError
from kineme.library.clusters import numbers_of
from kineme.library.examples import features_of, one_vocabulary
from kineme.library.executors import Executor
from kineme.library.index.kept import open_index
from kineme.library.index.nearest import joined, parts_like
from kineme.library.index.parts import Parts, Sought, matches_in
from kineme.library.index.windows import Float32s, length_for
from kineme.library.opened import OpenTables
from kineme.library.searching import Example, Hit, Named, best
from kineme.library.storage.layout import BODIES, PIECES

TYPICAL = 5
"""Words that stand for a cluster in a search, the most typical ones."""


LARGEST, MOST_HITS = 1e6, 1 << 31


def hits_like(
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
    """Where the recordings of a library are like one of the examples, the nearest first.

    Parameters
    ----------
    tables : OpenTables
        Of the library.
    examples, counterexamples : sequence of Example
        What is more like a counter-example than like any example is left out.
    threshold : float
        Largest distance.
    top : int, optional
        Hits at most.
    max_per_recording : int, optional
        Of one recording at most.
    mirror : bool
        Search for the mirror images of the examples as well.
    executor : Executor, optional
        Where it is searched; threads of this process by default.

    Raises
    ------
    ParameterError
        A limit is below 1, or the examples do not compare with each other, or with no recording.
    ReadError
        One cannot be read, or has no body.
    """
    for name, value in (("top", top), ("max_per_recording", max_per_recording)):
        if value is not None and not (is_number(value) and value >= 1):
            raise ParameterError(f"{name} must be a whole number above 0, not {value!r:.60}")
    if not (is_number(threshold) and threshold > 0):
        raise ParameterError(f"the threshold must be a number above 0, not {threshold!r:.60}")
    threshold = min(float(threshold), LARGEST)  # all that is below is found with either
    top = None if top is None else int(min(top, MOST_HITS))
    if max_per_recording is not None:
        max_per_recording = int(min(max_per_recording, MOST_HITS))
    wanted = features_of(tables, examples, mirror=mirror)
    vocabulary = one_vocabulary(wanted)
    refused = [part for kind, part in features_of(tables, counterexamples) if kind == vocabulary]
    own = [part for _, part in wanted]
    sought = Sought(own, refused, threshold, None if max_per_recording else top)
    parts = _whole(tables, vocabulary)
    if top is not None and vocabulary == BODIES:
        parts = _likely(tables, own, top) or parts
    found = matches_in(tables.folder / PIECES, tables.recordings["piece"], parts, sought, executor)
    rows = list(found)
    chosen = best(list(found.values()), top=top, most=max_per_recording)
    return [_hit(tables, rows[i], *span) for i, span in chosen]


def _whole(tables: OpenTables, vocabulary: str) -> Parts:
    """All recordings of a vocabulary."""
    rows = np.array(_rows_of(tables, vocabulary), np.int64)
    samples = np.array(tables.recordings["samples"], np.int64)[rows]
    return Parts(rows, np.zeros_like(rows), samples)


def _likely(tables: OpenTables, examples: Sequence[Float32s], top: int) -> Parts | None:
    """What is most like any of the examples, where there is an index that tells."""
    found = []
    for example in examples:
        windows = open_index(
            tables.folder, tables.head["tables"], tables.recordings, length_for(example)
        )
        if windows is None:
            return None
        found.append(parts_like(windows, example, top))
    return joined(Parts(*(np.concatenate(column) for column in zip(*found, strict=True))))


def typical_examples(tables: OpenTables, cluster: int | str) -> list[Example]:
    """The most typical words of a cluster, by number or name, as examples."""
    words = tables.columns("words")
    rows = np.flatnonzero(np.isin(words["cluster"], numbers_of(tables, cluster)))
    rows = rows[np.argsort(words["spread"][rows], kind="stable")][:TYPICAL]
    columns = (words[name][rows].tolist() for name in ("recording", "start_s", "stop_s"))
    return [Example(Named(name), *span) for name, *span in zip(*columns, strict=True)]


def _rows_of(tables: OpenTables, vocabulary: str) -> list[int]:
    """The recordings of a vocabulary, by row; ParameterError where there are none."""
    kinds = tables.recordings["vocabulary"]
    rows = [row for row, kind in enumerate(kinds) if kind == vocabulary]
    if not rows:
        there = "; ".join(sorted(set(kinds) - {""}))
        raise ParameterError(
            f"the example is of {vocabulary}, the library has {there or 'nothing'}"
        )
    return rows


def _hit(tables: OpenTables, row: int, start: int, stop: int, distance: float) -> Hit:
    """A span of a recording, samples, with the cluster of the segment that covers most of it.

    Of segments that cover as much, that of the finer level counts.
    """
    recording = tables.recordings["recording"][row]
    fps, lasts = (tables.recordings[name][row] for name in ("features_fps", "duration_s"))
    start_s, stop_s = start / fps, min(stop / fps, lasts)
    segments = tables.columns("segments")
    rows = slice(*tables.rows.get(recording, (0, 0)))
    if rows.stop == rows.start:
        return Hit(recording, start_s, stop_s, round(distance, 4), -1, "")
    shared = np.minimum(segments["stop_s"][rows], stop_s)
    shared = np.round(shared - np.maximum(segments["start_s"][rows], start_s), 6)
    covers = int(np.lexsort((segments["level"][rows] == "primitive", shared))[-1])
    cluster = int(segments["cluster"][rows][covers])
    label = tables.edits.name(cluster) if cluster >= 0 else ""
    return Hit(recording, start_s, stop_s, round(distance, 4), cluster, label)
