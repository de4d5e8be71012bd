"""kineme.cycles(): each repetition measured.

Segments say which repetitions there are and how many. Their borders are moved to one phase of
their cluster and to a place between two frames (`kineme.cycles.borders`), and end where a pause
begins (`kineme.cycles.runs`), or at an event (`kineme.cycles.anchors`). Then every channel is
measured from border to border.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import as_indices, check_flag, check_one_of, check_type
from kineme._util.files import as_display_name, make_person_suffix
from kineme._version import __version__
from kineme.cycles.align import ALIGNMENTS, LINEAR, align_curves
from kineme.cycles.anchors import anchor_repetitions
from kineme.cycles.channels import Channel, channels_of
from kineme.cycles.runs import Repetition, movement, repetitions
from kineme.cycles.table import BY_HAND, INCOMPLETE, STATISTICS, Columns, Cycles
from kineme.errors import ParameterError
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation

Recordings = Motion | Signals | Sequence[Motion | Signals]

POINTS = 101
MOST_POINTS = 10_001
TURNED = 0.05
"""Of a cycle: a phase that moved by less is not worth a note."""


def cycles(
    recordings: Recordings,
    segments: Segmentation | Sequence[Segmentation],
    *,
    channels: Iterable[str] | None = None,
    anchor: str | Sequence[float] | None = None,
    beside: Sequence[Signals] = (),
    common: bool = False,
    align: str = LINEAR,
    points: int = POINTS,
) -> Cycles:
    """Measure each repetition of one recording or of several.

    Parameters
    ----------
    recordings : Motion or Signals, or a sequence of them
    segments : Segmentation, or a sequence of them
        One of each recording.
    channels : iterable of str, optional
        What to measure, see `kineme.cycles.channels_of`: the angles of a body, or all channels of
        signals, by default.
    anchor : str or sequence of float, optional
        Where a cycle begins; at equal phase by default. ``knee_r max`` (or ``min``),
        ``knee_r > 40`` (``<``: where it falls below), an event of the file, a foot contact as
        ``left foot strike``; or the seconds of events. A cycle whose event is missing stays and
        says so.
    beside : sequence of Signals
        Recorded at the same time as the one recording, such as force plates.
    common : bool
        Whether equal cluster numbers are equal movements in all recordings, as in those of a
        library. Otherwise only equal labels are.
    align : {"linear", "landmarks", "warp"}
        How curves of a group are brought in step (`kineme.cycles.align`): evenly in time; so that
        the largest and the smallest value of the first channel come at one time in all; or warped
        to the mean of all. What is measured of a cycle stays.
    points : int
        Of a curve.

    Returns
    -------
    Cycles
        A row for each primitive of a repeated movement, with the columns

        - ``row``, ``recording``, ``activity`` and ``number`` (in it, both from 0);
        - ``cluster``, ``label`` and ``group``: what is summarised together, which is the label or
          where there is none the cluster;
        - ``place``: ``inner``, or at the ends of an activity ``first``, ``last`` or ``only``;
        - ``start_frame``, ``stop_frame`` (between frames of the file), ``start_s``, ``stop_s``,
          ``duration_s``, and ``pause_s``: how long nothing moved before it;
        - ``start_deviation_s``, ``stop_deviation_s``: how uncertain the borders are;
        - ``confidence``, ``border_confidence``, ``activity_confidence``: of the segment table;
        - ``excluded``: why it does not count in means, or nothing; ``by hand`` where the annotation
          of the table says so (`kineme.segments.editing.exclude`);
        - of each channel ``NAME.range``, ``.min``, ``.max``, ``.min_at`` and ``.max_at`` (per cent
          of the cycle), ``.mean``, and at both borders ``.start`` and ``.stop``; nan where
          something was not recorded.

    Raises
    ------
    ParameterError
        Recordings and segments do not belong together, or there is no such channel.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> squats = kineme.cycles(motion, kineme.read_segments(bundled_truth()), channels=["knee_l"])
    >>> squats.columns["knee_l.max"][squats.columns["group"] == "squat"].round().tolist()
    [113.0, 102.0, 103.0, 111.0]
    """
    given = _as_list(recordings)
    check_type(segments, (Segmentation, Sequence), "cycles", "kineme.segment(recording) gives one")
    tables = [segments] if isinstance(segments, Segmentation) else list(segments)
    check_type(beside, Sequence, "cycles", "beside= takes a list of signals")
    _check(given, tables, beside, points)
    check_flag(common, "common")
    check_one_of(align, ALIGNMENTS, "align")
    names = _names(given)
    # Equal cluster numbers mean nothing across recordings, unless they are common.
    groups = [_groups(table, "" if common or len(given) == 1 else f"{name}: ")
              for table, name in zip(tables, names, strict=True)]  # fmt: skip
    measured = [channels_of(recording, channels, beside=beside) for recording in given]
    _check_same(measured, names)
    found = repetitions(given, tables, groups)
    if anchor is not None:
        if not isinstance(anchor, str) and len(given) > 1:
            raise ParameterError("seconds of events belong to one recording: name them instead")
        found = anchor_repetitions(found, given, groups, anchor, beside)
    columns = _columns(found, tables, names, groups)
    # Repetitions, channels, points.
    curves = np.empty((len(found), len(measured[0]), points))
    _measure([(each.recording, each.start, each.stop) for each in found], measured, columns, curves)
    cycles = Cycles(
        columns,
        tuple(channel.name for channel in measured[0]),
        tuple(channel.unit for channel in measured[0]),
        _align_groups(curves, columns, align),
        _provenance(given, tables, measured[0], found, columns, align),
    )
    return drop_left_out(cycles, tables)


def drop_left_out(cycles: Cycles, tables: Sequence[Segmentation]) -> Cycles:
    """Return same without those that people left out, as the annotations of their tables say."""
    # In the order of the rows of `cycles`: by recording, then by time.
    left_out = [
        table.annotation.excludes(row.start_frame, row.stop_frame)
        for table in tables
        for row in table.primitives
        if row.kind == "primitive"
    ]
    reasons = np.where(np.array(left_out, bool), BY_HAND, cycles.columns["excluded"])
    return replace(cycles, columns={**cycles.columns, "excluded": reasons})


def measured_anew(cycles: Cycles, channels: Sequence[Channel]) -> Cycles:
    """Return the same cycles of one recording with other channels, from the borders that they have.

    Parameters
    ----------
    cycles : Cycles
    channels : sequence of Channel
        Of the same recording, see `kineme.cycles.channels_of`.

    Returns
    -------
    Cycles
        As if `kineme.cycles` had measured these channels, without all that finds the borders. Of
        curves in step (``align``) the first of these channels says where they are.
    """
    # Columns of the former channels make way for those of the new ones.
    former = {f"{channel}.{name}" for channel in cycles.channels for name in STATISTICS}
    columns = {name: column for name, column in cycles.columns.items() if name not in former}
    spans = zip(columns["start_s"].tolist(), columns["stop_s"].tolist(), strict=True)
    curves = np.empty((len(cycles), len(channels), cycles.curves.shape[2]))
    _measure([(0, start, stop) for start, stop in spans], [channels], columns, curves)
    return Cycles(
        columns,
        tuple(channel.name for channel in channels),
        tuple(channel.unit for channel in channels),
        _align_groups(curves, columns, cycles.provenance.get("align", LINEAR)),
        {**cycles.provenance, "channels": {channel.name: channel.source for channel in channels}},
    )


def _as_list(recordings: Recordings) -> list[Motion | Signals]:
    if isinstance(recordings, Motion | Signals):
        return [recordings]
    check_type(recordings, Sequence, "cycles", "kineme.read(path) gives a recording")
    for each in recordings:
        check_type(each, (Motion, Signals), "cycles", "kineme.read(path) gives one")
    return list(recordings)


def _check(
    recordings: Sequence[Motion | Signals],
    tables: Sequence[Segmentation],
    beside: Sequence[Signals],
    points: int,
) -> None:
    for table in tables:
        check_type(table, Segmentation, "cycles", "kineme.segment(recording) gives one")
    if not recordings or len(recordings) != len(tables):
        raise ParameterError(
            f"cycles takes a segmentation of each recording, not {len(tables)} of {len(recordings)}"
        )
    for recording, table in zip(recordings, tables, strict=True):
        if (table.n_frames, table.fps) != (recording.n_frames, recording.fps):
            raise ParameterError(
                f"the segments are of {table.n_frames} frames at {table.fps:g} Hz, "
                f"the recording has {recording.n_frames} at {recording.fps:g} Hz"
            )
    for signals in beside:
        check_type(signals, Signals, "cycles", "beside= takes a list of signals")
    if beside and len(recordings) > 1:
        raise ParameterError("beside= belongs to one recording: measure several one by one")
    if not 2 <= as_indices([points], "points")[0] <= MOST_POINTS:
        raise ParameterError(f"points is {points}: give 2 to {MOST_POINTS}")


def _check_same(measured: Sequence[Sequence[Channel]], names: Sequence[str]) -> None:
    """ParameterError unless all recordings have the same channels."""
    first = [channel.name for channel in measured[0]]
    for each, name in zip(measured, names, strict=True):
        if (channel_names := [channel.name for channel in each]) != first:
            other = sorted(set(first) ^ set(channel_names))
            raise ParameterError(
                f"{names[0]} and {name} do not have the same channels: {', '.join(other[:8])}; "
                "choose such as both have with channels="
            )


def _names(recordings: Sequence[Motion | Signals]) -> list[str]:
    """Return the files' names without suffix, numbered where there are none, or equal ones.

    Equal names of several people are told apart by the person.
    """
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


def _groups(table: Segmentation, prefix: str) -> dict[int | str, str]:
    """By `movement` what its repetitions are summarised with: the label, or the cluster."""
    found: dict[int | str, str] = {}
    labels: dict[int | str, Counter[str]] = {}
    activities = table.activities
    for row in table.primitives:
        if row.kind == "primitive":
            label = row.label or str(activities.label[row.activity])
            labels.setdefault(movement(row), Counter())[label] += 1
    for what, counts in labels.items():
        # The most frequent label of a movement names all of its repetitions.
        label = counts.most_common(1)[0][0]
        unnamed = "no cluster" if what == "" else f"cluster {what}"
        found[what] = label or f"{prefix}{unnamed}"
    return found


def _columns(
    found: Sequence[Repetition],
    tables: Sequence[Segmentation],
    names: Sequence[str],
    groups: Sequence[dict[int | str, str]],
) -> Columns:
    """Return the columns of the table that are the same whatever is measured."""
    fps = np.array([tables[each.recording].fps for each in found])
    start = np.array([each.start for each in found])
    stop = np.array([each.stop for each in found])
    rows = [each.segment for each in found]
    return {
        "row": np.arange(len(found)),
        "recording": np.array([names[each.recording] for each in found], np.str_),
        "activity": np.array([row.activity for row in rows], np.int64),
        "number": np.array([each.number for each in found], np.int64),
        "cluster": np.array([row.cluster for row in rows], np.int64),
        "label": np.array([row.label for row in rows], np.str_),
        "group": np.array([groups[e.recording][movement(e.segment)] for e in found], np.str_),
        "place": np.array([each.place for each in found], np.str_),
        "start_frame": start * fps,
        "stop_frame": stop * fps,
        "start_s": start,
        "stop_s": stop,
        "duration_s": stop - start,
        "pause_s": np.array([each.pause for each in found], np.float64),
        "start_deviation_s": np.array([each.start_deviation for each in found], np.float64),
        "stop_deviation_s": np.array([each.stop_deviation for each in found], np.float64),
        "confidence": np.array([row.confidence for row in rows], np.float64),
        "border_confidence": np.array([row.border_confidence for row in rows], np.float64),
        "activity_confidence": np.array(
            [tables[e.recording].activities.confidence[e.segment.activity] for e in found],
            np.float64,
        ),
        "excluded": np.array(
            [each.missing or ("" if each.complete else INCOMPLETE) for each in found], np.str_
        ),
    }


def _measure(
    spans: Sequence[tuple[int, float, float]],
    measured: Sequence[Sequence[Channel]],
    columns: Columns,
    curves: Floats,
) -> None:
    """Fill in the statistics and the curves of each channel, one channel at a time.

    ``spans`` has of each cycle its recording, start and stop in seconds.
    """
    # Values of a channel are computed for one channel at a time, so memory stays small.
    for place, channel in enumerate(measured[0]):
        statistics = np.full((len(spans), len(STATISTICS)), np.nan)
        for number, of_one in enumerate(measured):
            values, fps = of_one[place].values(), of_one[place].fps
            for row, (recording, start, stop) in enumerate(spans):
                if recording == number:
                    curves[row, place], statistics[row] = _measure_cycle(
                        values, fps, start, stop, curves.shape[2]
                    )
        for name, column in zip(STATISTICS, statistics.T, strict=True):
            columns[f"{channel.name}.{name}"] = column


def _align_groups(curves: Floats, columns: Columns, align: str) -> Floats:
    """Return the curves, those of each group in step; where nothing is measured, as they are."""
    if curves.shape[1]:
        for group in set(columns["group"].tolist()):
            rows = columns["group"] == group
            curves[rows] = align_curves(curves[rows], align)
    return curves


def _measure_cycle(
    values: Floats, fps: float, start: float, stop: float, points: int
) -> tuple[Floats, list[float]]:
    """A curve of so many points, and the statistics; nan where something was not recorded."""
    last = len(values) - 1
    # The last border may lie after the last frame, where nothing is recorded.
    first, end = min(start * fps, last), min(stop * fps, last)
    # False for nan, which marks a missing border.
    if not np.isfinite([first, end]).all() or end <= first:
        return np.full(points, np.nan), [np.nan] * len(STATISTICS)
    # Both borders and the whole frames between them: extremes are searched at these.
    at = np.concatenate([[first], np.arange(int(first) + 1, np.ceil(end)), [end]])
    # Frames that the interpolation needs: one before the start and one after the end.
    frames = np.arange(int(first), min(int(np.ceil(end)), last) + 1)
    span = values[frames]
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


def _provenance(
    recordings: Sequence[Motion | Signals],
    tables: Sequence[Segmentation],
    channels: Sequence[Channel],
    found: Sequence[Repetition],
    columns: Columns,
    align: str,
) -> dict[str, Any]:
    # One entry for each run: its repetitions were turned by the same share.
    moved: dict[tuple[str, int, str], float] = {}
    for each, name, group in zip(
        found, columns["recording"].tolist(), columns["group"].tolist(), strict=True
    ):
        if abs(each.turned) >= TURNED:
            moved[name, each.segment.activity, group] = each.turned
    turned: list[dict[str, Any]] = [
        {"recording": name, "activity": activity, "group": group, "by": round(by, 4)}
        for (name, activity, group), by in moved.items()
    ]
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
        "channels": {channel.name: channel.source for channel in channels},
        "align": align,
        "turned": turned,
        "notes": [
            "{group} in activity {activity} of {recording} begins ".format_map(each)
            + f"{abs(each['by']):.0%} of a cycle {'later' if each['by'] > 0 else 'earlier'} "
            "than its segments, where others of it begin"
            for each in turned
        ],
    }
