"""Measure each repetition: the function `kineme.cycles`.

The segments define the repetitions. Their borders are moved to a common phase of the cluster with
subframe precision (`kineme.cycles.borders`), and cut at pauses or moved to events
(`kineme.cycles.repetitions`). Then every channel is measured between borders.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import as_indices, check_flag, check_one_of, check_type
from kineme._util.files import as_display_name, make_person_suffix
from kineme._version import __version__
from kineme.cycles.align import ALIGNMENTS, LINEAR, align_curves
from kineme.cycles.channels import Channel, channels_of
from kineme.cycles.comparison import is_right
from kineme.cycles.repetitions import (
    Repetition,
    anchor_repetitions,
    convert_labels,
    cut_at_events,
    find_repetitions,
    get_movement_key,
    list_repetitions,
    parse_channel_anchor,
)
from kineme.cycles.table import BY_HAND, INNER, STATISTICS, Columns, Cycles
from kineme.errors import ParameterError
from kineme.recordings import Motion, Signals
from kineme.recordings.samples import as_signals
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

Recordings = Motion | Signals | ArrayLike | Sequence[Motion | Signals | ArrayLike]

POINTS = 101
MOST_POINTS = 10_001
TURNED = 0.05
"""Shift of a phase in cycles below which no note is added."""


def cycles(
    recordings: Recordings,
    segments: Segmentation | Sequence[Segmentation],
    *,
    channels: Iterable[str] | None = None,
    anchor: str | Sequence[float] | None = None,
    beside: Sequence[Signals] | Sequence[Sequence[Signals]] = (),
    common: bool = False,
    refine: bool | None = None,
    align: str = LINEAR,
    points: int = POINTS,
) -> Cycles:
    """Measure each repetition of one recording or of several.

    Parameters
    ----------
    recordings : Motion or Signals, or a sequence of them
        Arrays and data frames are converted with `kineme.as_signals`.
    segments : Segmentation, or a sequence of them
        One for each recording. Their primitives are measured. Of labels without primitives, such
        as a table of ``start_s,stop_s,label``, each row is measured as an inner repetition.
    channels : iterable of str, optional
        Channels to measure, see `kineme.cycles.channels_of`; by default the angles of a body, or
        all channels of signals.
    anchor : str or sequence of float, optional
        Start of a cycle; a common phase by default. ``knee_r max`` (or ``min``), or ``knee_r > 40``
        (``<`` for falling below): cycles without it are kept but marked. Or an event of the file,
        ``left foot strike`` or another foot contact, or times in seconds: cycles run from each
        event to the next one, and their group is the label, else the event. With ``foot strike``
        or ``foot off``, channels of the right side are measured from its own foot's event.
    beside : sequence of Signals, or a sequence of such sequences
        Signals recorded at the same time as the recording, such as force plates; for several
        recordings a list for each.
    common : bool
        Whether equal cluster numbers mean equal movements in all recordings, as in a library.
        Otherwise only equal labels do.
    refine : bool, optional
        Whether borders move to a common phase and pauses are cut off. Otherwise they stay those of
        the segments. By default borders of labels stay, and others move.
    align : {"linear", "landmarks", "warp"}
        How curves of a group are aligned (`kineme.cycles.align`): linearly in time; so that
        maximum and minimum of the first channel coincide; or warped to the mean. Statistics are
        not affected.
    points : int
        Number of points of a curve.

    Returns
    -------
    Cycles
        One row per primitive of a repeated movement, with the columns

        - ``row``, ``recording``, ``activity`` and ``number`` (within the activity, both from 0);
        - ``cluster``, ``label`` and ``group`` (the label, else the cluster), which is summarised;
        - ``place``: ``inner``, or at the ends of an activity ``first``, ``last`` or ``only``;
        - ``start_frame``, ``stop_frame`` (fractional), ``start_s``, ``stop_s``, ``duration_s``,
          and ``pause_s``, the duration of rest before it;
        - ``start_deviation_s``, ``stop_deviation_s``: standard deviations of the borders;
        - ``confidence``, ``border_confidence``, ``activity_confidence`` from the segment table;
        - ``excluded``: why it is excluded from means, or empty; ``by hand`` if excluded in the
          annotation of the table (`kineme.segments.editing.exclude`);
        - for each channel ``NAME.range``, ``.min``, ``.max``, ``.min_at`` and ``.max_at`` (per
          cent of the cycle), ``.mean``, and at the borders ``.start`` and ``.stop``; nan if part
          of the cycle was not recorded.

    Raises
    ------
    ParameterError
        Recordings and segments do not match, or a channel does not exist.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> squats = kineme.cycles(motion, kineme.read_segments(bundled_truth()), channels=["knee_l"])
    >>> squats.columns["knee_l.max"][squats.columns["group"] == "squat"].round().tolist()
    [113.0, 102.0, 103.0, 111.0]
    """
    items, given, signals = _check_inputs(recordings, segments, beside, points)
    tables = [convert_labels(table) for table in given]
    # Numbers of the recordings whose rows became repetitions.
    by_row = {i for i, table in enumerate(tables) if table is not given[i]}
    check_flag(common, "common")
    if refine is None:
        # Borders that people drew stay.
        refine = not by_row and not any("labels" in table.provenance for table in tables)
    check_flag(refine, "refine")
    check_one_of(align, ALIGNMENTS, "align")
    names = _name_files(items)
    # Cluster numbers are not comparable between recordings, unless they are common.
    labels = [_find_labels(table) for table in tables]
    groups = [
        _name_movements(each, "" if common or len(items) == 1 else f"{name}: ")
        for each, name in zip(labels, names, strict=True)
    ]
    measured = [
        channels_of(recording, channels, beside=others)
        for recording, others in zip(items, signals, strict=True)
    ]
    first_names = [channel.name for channel in measured[0]]
    for each, name in zip(measured, names, strict=True):
        if differing := sorted({*first_names} ^ {channel.name for channel in each}):
            raise ParameterError(
                f"{names[0]} and {name} do not have the same channels: "
                f"{', '.join(differing[:8])}; choose channels that both have with channels="
            )
    channel_anchor = parse_channel_anchor(anchor)
    if anchor is None or channel_anchor is not None:
        repetitions = (
            find_repetitions(items, tables, groups) if refine else list_repetitions(tables)
        )
        if channel_anchor is not None:
            repetitions = anchor_repetitions(repetitions, items, groups, channel_anchor, signals)
        else:
            # Cycles that people cut one by one are complete, also at the ends.
            repetitions = [
                replace(each, place=INNER) if each.recording in by_row else each
                for each in repetitions
            ]
    else:
        if not isinstance(anchor, str) and len(items) > 1:
            raise ParameterError(
                "seconds of events apply to one recording only: give the names of events instead"
            )
        repetitions = cut_at_events(items, tables, anchor)
    columns = _make_columns(repetitions, tables, names, groups)
    provenance = _make_provenance(items, tables, repetitions, columns)
    if not common:
        provenance["unnamed"] = {
            names[movement]: identity
            for each, names, identity in zip(labels, groups, _identify(items, tables), strict=True)
            for movement, label in each.items()
            if not label
        }
    spans = [(each.recording, each.start, each.stop) for each in repetitions]
    # Channels of the right side may have cycles of their own.
    right = [(each.recording, *(each.right or (each.start, each.stop))) for each in repetitions]
    return _measure_cycles(spans, measured, columns, align, points, provenance, right)


def mark_excluded(cycles: Cycles, tables: Sequence[Segmentation]) -> Cycles:
    """Return the cycles with those excluded in the annotations of the tables marked."""
    tables = [convert_labels(table) for table in tables]
    # In the order of the rows of `cycles`: by recording, then by time.
    rows = [(table, row) for table in tables for row in table.primitives if row.kind == "primitive"]
    reasons = _list_reasons(rows, cycles.columns["excluded"])
    return replace(cycles, columns={**cycles.columns, "excluded": reasons})


def measure_other_channels(cycles: Cycles, channels: Sequence[Channel]) -> Cycles:
    """Return the cycles of one recording with other channels.

    Equal to the result of `kineme.cycles` for these channels, but reuses the borders.
    """
    # Columns of the former channels make way for those of the new ones.
    former = {f"{channel}.{name}" for channel in cycles.channels for name in STATISTICS}
    columns = {name: column for name, column in cycles.columns.items() if name not in former}
    times = zip(columns["start_s"].tolist(), columns["stop_s"].tolist(), strict=True)
    spans = [(0, start, stop) for start, stop in times]
    align, points = cycles.provenance.get("align", LINEAR), cycles.curves.shape[2]
    return _measure_cycles(spans, [channels], columns, align, points, cycles.provenance)


def _check_inputs(
    recordings: Any,
    segments: Segmentation | Sequence[Segmentation],
    beside: Sequence[Signals] | Sequence[Sequence[Signals]],
    points: int,
) -> tuple[list[Motion | Signals], list[Segmentation], list[Sequence[Signals]]]:
    """Return recordings, tables and signals as lists; raise ParameterError if they do not match."""
    advice = "beside= takes a list of signals"
    tables = _check_list(segments, (Segmentation,), "kineme.segment(recording) gives one")
    several = recordings if isinstance(recordings, Sequence) else [recordings]
    items = _check_list(
        [_convert_data(each, *tables[i : i + 1]) for i, each in enumerate(several)],
        (Motion, Signals),
        "kineme.read(path) gives a recording",
    )
    check_type(beside, Sequence, "cycles", advice)
    is_nested = bool(beside) and not isinstance(beside[0], Signals)
    lists: list[Any] = [*beside] if is_nested else [beside] * (1 if beside else len(items))
    lists = [_check_list(each, (Signals,), advice) for each in lists]
    if not items or len(items) != len(tables):
        raise ParameterError(
            f"cycles takes one segmentation per recording, not {len(tables)} of {len(items)}"
        )
    for recording, table in zip(items, tables, strict=True):
        if (table.n_frames, table.fps) != (recording.n_frames, recording.fps):
            raise ParameterError(
                f"the segments have {table.n_frames} frames at {table.fps:g} Hz, but the "
                f"recording has {recording.n_frames} at {recording.fps:g} Hz"
            )
    if len(lists) != len(items):
        raise ParameterError(
            f"beside= takes one list of signals per recording: {len(items)}, not {len(lists)}"
        )
    if not 2 <= as_indices([points], "points")[0] <= MOST_POINTS:
        raise ParameterError(f"points is {points}: give 2 to {MOST_POINTS}")
    return items, tables, lists


def _convert_data(data: Any, table: Segmentation | None = None) -> Any:
    """Return arrays and data frames as signals, and all else as it is."""
    if not hasattr(data, "__array__") or np.ndim(data) == 0:
        return data
    # Rows that are the frames of the table need no times.
    fps = table.fps if table is not None and len(data) == table.n_frames else None
    return as_signals(data, fps=fps)


def _check_list(values: Any, kinds: tuple[type, ...], advice: str) -> list[Any]:
    """Return one value or several as a list; raise ParameterError if one is of another type."""
    items = list(values) if isinstance(values, Sequence) else [values]
    for each in items:
        check_type(each, kinds, "cycles", advice)
    return items


def _name_files(recordings: Sequence[Motion | Signals]) -> list[str]:
    """Return unique names of recordings: file names without suffix, with the person or a number."""
    stems = [Path(each.provenance.path or "").stem for each in recordings]
    names = []
    for stem, source in zip(stems, (each.provenance for each in recordings), strict=True):
        is_shared = stems.count(stem) > 1 and len(source.people) > 1
        person = make_person_suffix(source.person or "") if is_shared else ""
        names.append(as_display_name(stem) + person)
    if len(names) == 1:
        return [names[0] or "recording"]
    return [
        name if name and names.count(name) == 1 else f"{name or 'recording'} {place}"
        for place, name in enumerate(names, 1)
    ]


def _find_labels(table: Segmentation) -> dict[int | str, str]:
    """Return the label of each movement, or an empty text."""
    labels: defaultdict[int | str, Counter[str]] = defaultdict(Counter)
    for row in table.primitives:
        if row.kind == "primitive":
            labels[get_movement_key(row)][
                row.label or str(table.activities.label[row.activity])
            ] += 1
    # The most frequent label of a movement names all of its repetitions.
    return {movement: counts.most_common(1)[0][0] for movement, counts in labels.items()}


def _name_movements(labels: Mapping[int | str, str], prefix: str) -> dict[int | str, str]:
    """Return the group of each movement: its label, or its cluster."""
    return {
        movement: label or prefix + ("no cluster" if movement == "" else f"cluster {movement}")
        for movement, label in labels.items()
    }


def _identify(
    recordings: Sequence[Motion | Signals], tables: Sequence[Segmentation]
) -> Iterator[str]:
    """Yield a digest of each recording and its segments, within which cluster numbers hold."""
    for recording, table in zip(recordings, tables, strict=True):
        values = recording.positions if isinstance(recording, Motion) else recording.values
        content = recording.provenance.sha256 or sha256(values.tobytes()).hexdigest()
        rows = np.array([table.table.start_frame, table.table.stop_frame, table.table.cluster])
        yield sha256(f"{content} {rows.tolist()}".encode()).hexdigest()


def _make_columns(
    repetitions: Sequence[Repetition],
    tables: Sequence[Segmentation],
    names: Sequence[str],
    groups: Sequence[dict[int | str, str]],
) -> Columns:
    """Return the columns of the table that do not depend on channels."""

    def column(kind: type, value: Callable[[Repetition], Any]) -> NDArray[Any]:
        return np.array([value(each) for each in repetitions], kind)

    def name_group(each: Repetition) -> str:
        key = get_movement_key(each.segment)
        return groups[each.recording].get(key, str(key))

    # Number of repetitions of each activity so far.
    counts: Counter[tuple[int, int]] = Counter()
    numbers = []
    for each in repetitions:
        numbers.append(counts[each.recording, each.segment.activity])
        counts[each.recording, each.segment.activity] += 1
    rows = [(tables[each.recording], each.segment) for each in repetitions]
    fps = np.array([table.fps for table, _ in rows], float)
    start, stop = column(float, lambda each: each.start), column(float, lambda each: each.stop)
    return {
        "row": np.arange(len(repetitions)),
        "recording": column(str, lambda each: names[each.recording]),
        "activity": column(int, lambda each: each.segment.activity),
        "number": np.array(numbers, int),
        "cluster": column(int, lambda each: each.segment.cluster),
        "label": column(str, lambda each: each.segment.label),
        "group": column(str, name_group),
        "place": column(str, lambda each: each.place),
        "start_frame": start * fps,
        "stop_frame": stop * fps,
        "start_s": start,
        "stop_s": stop,
        "duration_s": stop - start,
        "pause_s": column(float, lambda each: each.pause),
        "start_deviation_s": column(float, lambda each: each.start_deviation),
        "stop_deviation_s": column(float, lambda each: each.stop_deviation),
        "confidence": column(float, lambda each: each.segment.confidence),
        "border_confidence": column(float, lambda each: each.segment.border_confidence),
        "activity_confidence": np.array(
            [table.activities.confidence[row.activity] for table, row in rows], float
        ),
        "excluded": _list_reasons(rows, [each.lacking for each in repetitions]),
    }


def _list_reasons(
    rows: Iterable[tuple[Segmentation, Segment]], reasons: ArrayLike
) -> NDArray[np.str_]:
    """Return why rows are excluded: by the annotation of their table, or for the given reasons."""
    left_out = [table.annotation.excludes(row.start_frame, row.stop_frame) for table, row in rows]
    return np.where(np.array(left_out, bool), BY_HAND, np.asarray(reasons, np.str_))


def _measure_cycles(
    spans: Sequence[tuple[int, float, float]],
    measured: Sequence[Sequence[Channel]],
    columns: Columns,
    align: str,
    points: int,
    provenance: Mapping[str, Any],
    right: Sequence[tuple[int, float, float]] = (),
) -> Cycles:
    """Return the cycles with statistics and curves of each channel.

    ``spans`` holds recording, start and stop (seconds) of each cycle, ``measured`` the channels of
    each recording, ``right`` the spans for channels of the right side. The statistics are added to
    ``columns``.
    """
    channels = measured[0]
    curves = np.empty((len(spans), len(channels), points))
    # A frame of the slowest recording.
    timed = columns["stop_frame"] > 0
    frame_s = np.max(columns["stop_s"][timed] / columns["stop_frame"][timed], initial=0.0)
    # Compute one channel at a time to save memory.
    for place, channel in enumerate(channels):
        statistics = np.full((len(spans), len(STATISTICS)), np.nan)
        own_spans = right if right and is_right(channel.name) else spans
        for number, channels_of_one in enumerate(measured):
            values, fps = channels_of_one[place].values(), channels_of_one[place].fps
            for row, (recording, start, stop) in enumerate(own_spans):
                if recording == number:
                    curves[row, place], statistics[row] = _measure_cycle(
                        values, fps, start, stop, points, frame_s
                    )
        for name, column in zip(STATISTICS, statistics.T, strict=True):
            columns[f"{channel.name}.{name}"] = column
    for group in set(columns["group"].tolist()) if channels else ():
        rows = columns["group"] == group
        curves[rows] = align_curves(curves[rows], align)
    sources = {channel.name: channel.source for channel in channels}
    return Cycles(
        columns,
        tuple(channel.name for channel in channels),
        tuple(channel.unit for channel in channels),
        curves,
        {**provenance, "channels": sources, "align": align},
    )


def _measure_cycle(
    values: Floats, fps: float, start: float, stop: float, points: int, frame_s: float
) -> tuple[Floats, list[float]]:
    """Return the curve and the statistics of a cycle.

    If part of the cycle was not recorded, the curve is nan in this part, and all statistics are
    nan. Both are nan if a border is missing.
    """
    last = len(values) - 1
    first, end = start * fps, stop * fps
    # The end of a recording is a frame after its last one, at which signals beside it may end.
    if last < end <= last + max(1, frame_s * fps) + 1e-6:  # against rounding
        end = float(last)
    # False for nan, which marks a missing border.
    if not np.isfinite([first, end]).all() or end <= first:
        return np.full(points, np.nan), [np.nan] * len(STATISTICS)
    # Both borders and the whole frames between them: extremes are searched at these.
    at = np.concatenate([[first], np.arange(int(first) + 1, np.ceil(end)), [end]])
    # Frames that the interpolation needs: one before the start and one after the end.
    frames = np.arange(int(first), int(np.ceil(end)) + 1)
    # Frames after the end were not recorded.
    span = np.where(frames <= last, values[np.minimum(frames, last)], np.nan)
    cycle = np.interp(at, frames, span)
    curve = np.interp(np.linspace(first, end, points), frames, span)
    if not np.isfinite(span).all():
        return np.where(np.isfinite(curve), curve, np.nan), [np.nan] * len(STATISTICS)
    least, most = int(cycle.argmin()), int(cycle.argmax())
    # Per cent of the cycle at each of these places.
    percent = 100 * (at - first) / (end - first)
    # Trapezoids, since the first and the last interval are shorter than a frame.
    mean = float(((cycle[1:] + cycle[:-1]) / 2 * np.diff(at)).sum() / (end - first))
    return curve, [
        float(cycle[most] - cycle[least]), float(cycle[least]), float(cycle[most]),
        float(percent[least]), float(percent[most]), mean, float(cycle[0]), float(cycle[-1]),
    ]  # fmt: skip


def _make_provenance(
    recordings: Sequence[Motion | Signals],
    tables: Sequence[Segmentation],
    repetitions: Sequence[Repetition],
    columns: Columns,
) -> dict[str, Any]:
    """Return the sources of the cycles, and the runs whose phase was turned."""
    # One entry for each run: its repetitions were turned by the same share.
    names, groups = columns["recording"].tolist(), columns["group"].tolist()
    moved = {
        (name, each.segment.activity, group): each.turned
        for each, name, group in zip(repetitions, names, groups, strict=True)
        if abs(each.turned) >= TURNED
    }
    return {
        "kineme": __version__,
        "recordings": [
            {
                "path": each.provenance.path,
                "sha256": each.provenance.sha256,
                "preset": table.provenance.get("preset"),
            }
            for each, table in zip(recordings, tables, strict=True)
        ],
        "turned": [
            {"recording": name, "activity": activity, "group": group, "by": round(by, 4)}
            for (name, activity, group), by in moved.items()
        ],
        "notes": [
            f"{group} in activity {activity} of {name} begins {abs(round(by, 4)):.0%} of a "
            f"cycle {'later' if by > 0 else 'earlier'} than its segments, to match the "
            "other repetitions"
            for (name, activity, group), by in moved.items()
        ]
        + ["channels of the right side begin at the contacts of the right foot"]
        * any(each.right is not None for each in repetitions),
    }
