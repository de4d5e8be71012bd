"""Read labels of many recordings from one table, or from a folder with a file for each.

A table has the columns of `kineme.labels.csv_table` and ``recording`` (or ``file``), or those of
BORIS with ``Observation id``; recordings are named with or without suffix. In a folder, the labels
of ``walk.bvh`` are in a file called ``walk`` in any label format (``walk.eaf``,
``walk.labels.csv``). `read_labels` returns those of a single recording.

A frame has the label whose span ``[start, stop)`` contains its time. Labels of public datasets
sometimes overlap, run backwards or exceed the recording. If two overlap, the later one in the file
counts; reversed ones are left out. Notes in the provenance report this.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import ceil
from os import PathLike
from pathlib import Path, PureWindowsPath
from typing import NamedTuple

from kineme._util.checks import format_count
from kineme._util.files import translate_read_errors
from kineme.errors import ReadError
from kineme.labels import csv_table, event_tables
from kineme.labels.registry import find_read_format, holds_labels, read_content, read_segments
from kineme.labels.spans import (
    TOO_FAR,
    Labels,
    Span,
    as_segmentation,
    check_extent,
    check_frames,
    convert_clock_times,
    note_lost_labels,
)
from kineme.recordings.times import Clock
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level

SLACK = 1e-6
"""Rounding tolerance of times, in frames: seconds in files have few digits."""


class Extent(NamedTuple):
    """Length, frame rate and clock of a recording."""

    n_frames: int
    fps: float
    clock: Clock | None = None


@dataclass(frozen=True)
class LabelSource:
    """File with the labels of a recording, and the labels if the file holds several recordings."""

    path: Path
    labels: Labels | None = None
    format: str = csv_table.FORMAT.name

    def of(self, *, n_frames: int, fps: float, clock: Clock | None = None) -> Segmentation:
        """Return the labels as a segmentation; frames without a label are transitions."""
        content: Labels | Segmentation | None = self.labels
        name = self.format
        if content is None:
            label_format, content = read_content(self.path)
            name = label_format.name
        if isinstance(content, Labels):
            check_frames(content, self.path, n_frames)
            timed = convert_clock_times(content, clock, length_s=n_frames / fps)
            labels = convert_to_frames(timed, fps, n_frames=n_frames)
            content, _ = as_segmentation(labels, self.path, name, fps=fps, n_frames=n_frames)
        return check_extent(content, self.path, fps=fps, n_frames=n_frames)


def find_labels(
    recordings: Iterable[str | PathLike[str]], labels: str | PathLike[str]
) -> Mapping[Path, LabelSource]:
    """Return the source of labels for each recording that has some.

    ``labels`` is a table of several recordings, or a folder with a file for each. Raise ReadError
    if no recording has labels.
    """
    return find_labels_and_unmatched(recordings, labels)[0]


def find_labels_and_unmatched(
    recordings: Iterable[str | PathLike[str]], labels: str | PathLike[str]
) -> tuple[Mapping[Path, LabelSource], list[str]]:
    """Return the result of `find_labels`, and the names in a table that match no recording."""
    files, folder = [*map(Path, recordings)], Path(labels)
    sources = _find_in_folder(folder) if folder.is_dir() else _read_table(folder)
    present = {name for path in files for name in (path.name, path.stem)}
    are_unique = len({path.name for path in files}) == len(files)
    by_case: defaultdict[str, list[LabelSource]] = defaultdict(list)
    for name, source in sources.items():
        if name not in present:
            by_case[(PureWindowsPath(name).name if are_unique else name).casefold()].append(source)
    found: dict[Path, LabelSource] = {}
    for path in files:
        # Tables may name a recording with or without folder and suffix, or in another case.
        exact = sources.get(path.name) or sources.get(path.stem)
        keys = {path.name.casefold(), path.stem.casefold()}  # one if there is no suffix
        alike = [source for key in keys for source in by_case[key]]
        if exact or len(alike) == 1:
            found[path] = exact or alike[0]
    if not found:
        first = files[0].stem if files else "none"
        prefix = "" if len(files) == 1 else f"any of the {len(files)} recordings, such as "
        available = ", ".join(map(repr, sources)) or "none"
        raise ReadError(labels, f"has no labels of {prefix}{first!r}, but of {available:.60}")
    used = set(map(id, found.values()))
    unmatched = [name for name, source in sources.items() if id(source) not in used]
    return found, [] if folder.is_dir() else unmatched


def read_labels(
    recording: str | PathLike[str],
    labels: str | PathLike[str],
    *,
    n_frames: int,
    fps: float,
    clock: Clock | None = None,
) -> Segmentation:
    """Read the labels of one recording, also from a table of several recordings."""
    if not _lists_recordings(Path(labels)):
        return read_segments(labels, fps=fps, n_frames=n_frames, clock=clock)
    (source,) = find_labels([Path(recording)], labels).values()
    return source.of(n_frames=n_frames, fps=fps, clock=clock)


def convert_to_frames(labels: Labels, fps: float, *, n_frames: int) -> Labels:
    """Convert labels to spans of frames that neither overlap nor run backwards.

    Examples
    --------
    >>> found = convert_to_frames(Labels([Span(0, 9, "walk"), Span(4, 6, "wave")]), 10, n_frames=90)
    >>> [span[:3] for span in found.spans]
    [(0, 40, 'walk'), (60, 90, 'walk'), (40, 60, 'wave')]
    >>> found.notes
    ('overlapping others: 1 label',)
    """
    rate = fps if labels.unit == "seconds" else 1.0
    backward = sum(span.stop < span.start for span in labels.spans)
    rounded = [
        span._replace(
            start=max(0, _find_first_frame(span.start * rate, n_frames)),
            stop=_find_first_frame(span.stop * rate, n_frames),
        )
        for span in labels.spans
    ]
    forward = [span for span in rounded if span.start < span.stop]
    pairs = list(zip(labels.spans, rounded, strict=True))
    lost = [old for old, new in pairs if old.start <= old.stop and new.start >= new.stop]
    beyond = sum(old.stop * rate > n_frames + 1 for old, new in pairs if new.start < new.stop)
    before = sum(old.start * rate < -1 for old, new in pairs if new.start < new.stop)
    # Count spans, in file order, that overlap earlier ones.
    earlier: defaultdict[Level, _SpanUnion] = defaultdict(_SpanUnion)
    overlaps = sum(
        earlier[span.level].add(span.start, span.stop) != [(span.start, span.stop)]
        for span in forward
    )
    # Go backwards through the file, so that later spans take precedence.
    later: defaultdict[Level, _SpanUnion] = defaultdict(_SpanUnion)
    result: list[Span] = []
    for span in reversed(forward):
        free = later[span.level].add(span.start, span.stop)
        count = span.repetitions if len(free) == 1 else None  # unknown for parts of a span
        result += [
            span._replace(start=start, stop=stop, repetitions=count)
            # Reversed here, since the whole list is reversed below.
            for start, stop in reversed(free)
        ]
    result.reverse()
    counts = {
        "overlapping others": overlaps,
        "with a stop before the start, left out": backward,
        "starting before the recording, cut at its start": before,
        "stopping after the recording, cut at its end": beyond,
    }
    notes = [f"{what}: {format_count(count, 'label')}" for what, count in counts.items() if count]
    notes += note_lost_labels(lost, "s" if labels.unit == "seconds" else "frames")
    return Labels(
        result,
        "frames",
        fps=fps if labels.unit == "seconds" else labels.fps,
        length=n_frames,
        notes=(*labels.notes, *notes),
        remarks=labels.remarks,
    )


def _find_first_frame(time: float, n_frames: int) -> int:
    """Return the first frame at or after a time in frames; the end for times beyond it."""
    # Round up with tolerance: the first frame whose time is not before the label.
    return ceil(min(max(time, -TOO_FAR), n_frames) - SLACK)


class _SpanUnion:
    """Union of spans, stored as sorted disjoint spans."""

    def __init__(self) -> None:
        self._starts: list[float] = []
        self._stops: list[float] = []

    def add(self, start: float, stop: float) -> list[tuple[float, float]]:
        """Add a span; return its parts that were not covered before, in order."""
        # Covered spans that overlap or touch the new one; both lists are sorted.
        meeting = slice(bisect_left(self._stops, start), bisect_right(self._starts, stop))
        starts, stops = self._starts[meeting], self._stops[meeting]
        # Merge them with the new span.
        self._starts[meeting] = [min([start, *starts])]
        self._stops[meeting] = [max([stop, *stops])]
        # The free parts lie between, before and after the covered spans.
        free = zip([start, *stops], [*starts, stop], strict=True)
        return [(begin, end) for begin, end in free if begin < end]


def _lists_recordings(path: Path) -> bool:
    """Return whether a file is a table of several recordings, or names that of its labels."""
    label_format = find_read_format(path)
    if label_format is not event_tables.BORIS:
        return label_format is csv_table.FORMAT and csv_table.lists_recordings(path)
    with translate_read_errors(path):
        return len(event_tables.read_observations(path)) > 1


def _read_table(path: Path) -> dict[str, LabelSource]:
    is_boris = event_tables.is_boris(path)
    name = (event_tables.BORIS if is_boris else csv_table.FORMAT).name
    with translate_read_errors(path):
        read = event_tables.read_observations if is_boris else csv_table.read_intervals
        tables = read(path)
    if "" in tables:
        column = "Observation id" if is_boris else "recording"
        raise ReadError(
            path, f"has a label without a recording: name it in a column {column!r} of each row"
        )
    return {recording: LabelSource(path, labels, name) for recording, labels in tables.items()}


def _find_in_folder(folder: Path) -> dict[str, LabelSource]:
    """Return the label files in a folder by the possible names of their recordings."""
    found: dict[str, LabelSource] = {}
    for path in sorted(folder.iterdir()):
        if path.is_file() and holds_labels(path):
            found.setdefault(path.stem, LabelSource(path))
            # The part before the first dot, for names as `walk.labels.csv`.
            found.setdefault(path.name.split(".")[0], LabelSource(path))
    return found
