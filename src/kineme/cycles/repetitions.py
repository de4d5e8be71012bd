"""Turn rows of the segment table into repetitions with precise borders.

The segmentation defines the repetitions. Borders are aligned by the pose of a body, or by all
channels of signals, and pauses are cut off. With a channel as the anchor, a repetition starts where
the channel has its extreme or crosses a level near the usual phase, and stops at that of the next
repetition; those without stay in the table and are marked. With events as the anchor, such as foot
contacts, the segments only name the cycles, which run from each event to the next one of its kind.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Hashable, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import as_floats, join_names
from kineme.cycles.borders import Features, Run, find_vertex, make_run, shift_to_common_phase
from kineme.cycles.channels import channels_of
from kineme.cycles.events import (
    LONGEST,
    OFF,
    STRIKE,
    find_marks,
    foot_events,
    normalize_event_name,
)
from kineme.cycles.table import CYCLE, INCOMPLETE, INNER, compute_mean_phase
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import compute_distance_features, pose_features
from kineme.recordings import Motion, Signals
from kineme.recordings.joint_names import SIDES
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

RATE = 250.0
"""Largest number of samples per second; faster recordings are averaged."""
SMOOTH_S = 0.02
"""Standard deviation in seconds of the Gaussian filter for features."""
PAUSE_S = 0.5
"""Shortest pause between two repetitions, seconds."""
STILL = 0.1
"""Fraction of a cluster's RMS speed below which it stands still."""
OUTSIDE = 0.25
"""Largest part of a cycle, in cycles, that may lie outside of the activity or be missing at its
ends; beyond that the repetition is incomplete."""
LONG = "much longer than the others"
"""Reason for excluding a cycle longer than `LONGEST` medians: it contains a stop or lacks an event.
"""
_CHANNEL_ANCHOR = re.compile(
    r"(?P<channel>.+?)"
    r"(?:[ _]+(?P<extreme>max|min)"
    r"|\s*(?P<sign>[<>])\s*(?P<level>[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?))"
)

Groups = Sequence[Mapping[int | str, Hashable]]
"""Group of each movement, for each recording. Movements of a group begin at a common phase."""
Curve = tuple[Floats, float]
"""Values of a channel, and frames per second."""


class ChannelAnchor(NamedTuple):
    """Start of cycles: the maximum of sign × channel, or where that rises above a level."""

    channel: str
    sign: float
    level: float | None  # times the sign; None for the maximum


@dataclass(frozen=True)
class Repetition:
    """One repetition: its segment, and the seconds between which it is measured.

    ``place`` is ``inner``, or at the ends of its run ``first``, ``last`` or ``only``. ``lacking``
    says why it is excluded from means: it is incomplete, or its event is missing; else it is empty.
    """

    recording: int  # number of the recording
    segment: Segment  # the primitive in the segment table
    place: str
    start: float
    stop: float
    start_deviation: float = np.nan  # standard deviations in seconds, nan if unknown
    stop_deviation: float = np.nan
    pause: float = 0.0  # seconds of rest between the previous repetition and this one
    turned: float = 0.0  # shift of its phase relative to the segment, in cycles
    lacking: str = ""
    right: tuple[float, float] | None = None  # the seconds of the right side, if it has its own


def find_repetitions(
    recordings: Sequence[Motion | Signals], tables: Sequence[Segmentation], groups: Groups
) -> list[Repetition]:
    """Return the repetitions of all recordings, sorted by recording and time."""
    features = [_compute_features(recording) for recording in recordings]
    # Runs of one key are shifted to one phase.
    members: dict[Hashable, list[tuple[Run, list[Segment], int]]] = defaultdict(list)
    for number, (fine, table) in enumerate(zip(features, tables, strict=True)):
        for segments in _list_runs(table):
            frames = [segments[0].start_frame, *(each.stop_frame for each in segments)]
            run = make_run(fine, np.array(frames) / table.fps)
            movement = get_movement_key(segments[0])
            # Runs without cluster or label are aligned alone; runs with features that are not
            # comparable only with others of their recording.
            alone = id(run) if movement == "" else -1 if fine.comparable else number
            key = groups[number].get(movement, movement), fine.values.shape[1], alone
            members[key].append((run, segments, number))
    repetitions: list[Repetition] = []
    for runs in members.values():
        aligned = shift_to_common_phase([run for run, _, _ in runs])
        still = _measure_stillness(aligned)
        for run, (_, segments, number) in zip(aligned, runs, strict=True):
            each = _cut_to_activity(run, segments, number, tables[number])
            repetitions += _trim_pauses(each, run.features, still)
    return sorted(repetitions, key=lambda each: (each.recording, each.segment.start_frame))


def list_repetitions(tables: Sequence[Segmentation]) -> list[Repetition]:
    """Return the repetitions of all recordings with the borders of their tables."""
    return [
        Repetition(number, row, _name_place(i, len(run)), row.start_s, row.stop_s)
        for number, table in enumerate(tables)
        for run in _list_runs(table)
        for i, row in enumerate(run)
    ]


def as_repetitions(segments: Segmentation) -> Segmentation:
    """Return a table in which each activity is a repetition, if the table has no primitives.

    Activities with the same label without a gap between them become one. Otherwise the table is
    returned as it is.

    Parameters
    ----------
    segments : Segmentation
        Labels of repetitions, such as one row for each stride cut by hand.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import as_repetitions
    >>> columns = {"level": ["activity"] * 2, "kind": ["activity"] * 2, "label": ["stride"] * 2,
    ...            "start_frame": [0, 100], "stop_frame": [100, 190]}
    >>> as_repetitions(kineme.Segmentation.from_columns(columns, n_frames=190, fps=100))
    <Segmentation of 190 frames (1.9 s): 1 activity, 0 transitions, 2 primitives, 0 clusters>
    """
    if (segments.primitives.kind == "primitive").any():
        return segments
    rows = list(segments.activities)
    runs = [[*run] for _, run in groupby(rows, lambda row: (row.kind, row.cluster, row.label))]
    spans = [("activity", run[0], run[-1]) for run in runs]
    spans += [("primitive", row, row) for row in rows]
    columns: dict[str, list[Any]] = {
        "level": [level for level, _, _ in spans],
        "kind": [level if row.kind == "activity" else row.kind for level, row, _ in spans],
        "start_frame": [row.start_frame for _, row, _ in spans],
        "stop_frame": [row.stop_frame for _, _, row in spans],
        "cluster": [row.cluster for _, row, _ in spans],
        "label": [row.label for _, row, _ in spans],
    }
    return Segmentation.from_columns(
        columns, n_frames=segments.n_frames, fps=segments.fps, provenance=segments.provenance,
        annotation=segments.annotation,
    )  # fmt: skip


def convert_labels(segments: Segmentation) -> Segmentation:
    """Return labels without repetitions as repetitions, one per row; results as they are.

    Activities of a result without repetitions do not repeat.
    """
    return segments if "preset" in segments.provenance else as_repetitions(segments)


def get_movement_key(segment: Segment) -> int | str:
    """Return what identifies the movement of a segment: the cluster, else the label."""
    return segment.cluster if segment.cluster >= 0 else segment.label


def _compute_features(recording: Motion | Signals) -> Features:
    """Return pose features of a body, or distances of its points, or all channels of signals.

    They are at the recording's own rate, up to `RATE`.
    """
    from scipy.ndimage import gaussian_filter1d, uniform_filter1d

    # An odd number of frames, so that each mean is centred on a frame.
    n_averaged = ceil(recording.fps / RATE) // 2 * 2 + 1 if recording.fps > RATE else 1
    rate, comparable = recording.fps / n_averaged, True
    if isinstance(recording, Signals):
        values = recording.values
    else:
        try:
            values = pose_features(recording)
        except (EndEffectorError, MotionError):
            comparable, positions = False, recording.positions
            # A single point has no distances: its path is compared.
            is_point = recording.skeleton.n_joints < 2
            values = positions[:, 0] if is_point else compute_distance_features(positions)[0]
    # Average around each frame, then keep every n-th frame.
    if n_averaged > 1:
        values = uniform_filter1d(values, n_averaged, axis=0, mode="nearest")[::n_averaged]
    # Channels have different units: each counts by its own deviation, a constant one is only 0.
    if isinstance(recording, Signals):
        deviation = values.std(axis=0)
        values = (values - values.mean(axis=0)) / np.where(deviation > 0, deviation, 1)
    values = gaussian_filter1d(values, SMOOTH_S * rate, axis=0, mode="nearest")
    return Features(values, rate, comparable)


def _list_runs(table: Segmentation) -> list[list[Segment]]:
    """Return runs: successive repetitions of one movement in one activity without a gap."""
    runs: list[list[Segment]] = []
    for row in table.primitives:
        if row.kind != "primitive":
            continue
        last = runs[-1][-1] if runs else None
        if (
            last is not None
            and get_movement_key(row) != ""
            and (get_movement_key(last), last.activity) == (get_movement_key(row), row.activity)
            and last.stop_frame == row.start_frame
        ):
            runs[-1].append(row)
        else:
            runs.append([row])
    return runs


def _name_place(i: int, n: int) -> str:
    """Return the place of the i-th of n repetitions in its run."""
    return "only" if n == 1 else "first" if i == 0 else "last" if i == n - 1 else "inner"


def _cut_to_activity(
    run: Run, segments: Sequence[Segment], recording: int, table: Segmentation
) -> list[Repetition]:
    """Return the repetitions of a run, cut at the ends of its activity."""
    found = []
    activity = table.activities[segments[0].activity]
    least, most, end = activity.start_s, activity.stop_s, table.n_frames / table.fps
    # Borders were moved, and may lie a little outside of their activity.
    reach = OUTSIDE * run.period
    for i, segment in enumerate(segments):
        start, stop = run.borders[i : i + 2].tolist()
        complete = least - reach <= start and stop <= most + reach
        if not complete:
            start, stop = max(start, least), min(stop, most)
        start, stop = min(max(start, 0.0), end), min(max(stop, 0.0), end)
        # Only the first and the last can be cut short by an end.
        if i in (0, run.n - 1):
            complete &= stop - start >= (1 - OUTSIDE) * run.period
        found.append(
            Repetition(
                recording=recording,
                segment=segment,
                place=_name_place(i, run.n),
                start=start,
                stop=max(start, stop),
                start_deviation=float(run.uncertainty[i]),
                stop_deviation=float(run.uncertainty[i + 1]),
                turned=run.turned,
                lacking="" if complete else INCOMPLETE,
            )
        )
    return found


def _measure_stillness(runs: Sequence[Run]) -> float:
    """Return the speed below which these runs stand still."""
    total, count = 0.0, 0
    # The root mean square over all frames of all runs.
    for run in runs:
        first, last = (run.borders[[0, -1]] * run.features.rate).astype(int).tolist()
        speed = run.features.speed[max(0, first) : last + 1]
        total, count = total + float(np.square(speed).sum()), count + len(speed)
    return STILL * float(np.sqrt(total / max(count, 1)))


def _trim_pauses(run: list[Repetition], fine: Features, still: float) -> list[Repetition]:
    """Return the repetitions of a run without pauses.

    A pause is at least `PAUSE_S` of rest around a border, both sides together.
    """
    trimmed, moves = list(run), [_find_movement(each, fine, still) for each in run]
    # Standing still before the first repetition is not a part of it.
    if moves[0][0] - run[0].start >= PAUSE_S:
        trimmed[0] = replace(trimmed[0], start=moves[0][0])
    for i, each in enumerate(run):
        # A pause reaches from the last movement of one repetition to the first of the next.
        ends, is_last = moves[i][1], i + 1 == len(run)
        until = each.stop if is_last else moves[i + 1][0]
        # `trimmed[i]` may begin later than `each`: the pause before it was cut off already.
        if ends > trimmed[i].start and until - ends >= PAUSE_S:
            trimmed[i] = replace(trimmed[i], stop=ends)
            if not is_last and until < run[i + 1].stop:
                trimmed[i + 1] = replace(run[i + 1], start=until, pause=until - ends)
    return trimmed


def _find_movement(repetition: Repetition, fine: Features, still: float) -> tuple[float, float]:
    """Return the times at which movement in a repetition begins and ends; its borders if none."""
    # The frames of `speed` that lie within the repetition.
    first = max(0, int(np.ceil(repetition.start * fine.rate)))
    moves = np.flatnonzero(fine.speed[first : int(repetition.stop * fine.rate) + 1] > still)
    if len(moves) == 0:
        return repetition.start, repetition.stop
    begins, ends = (first + moves[[0, -1]]) / fine.rate
    return max(repetition.start, float(begins)), min(repetition.stop, float(ends))


def anchor_repetitions(
    repetitions: Sequence[Repetition],
    recordings: Sequence[Motion | Signals],
    groups: Groups,
    anchor: ChannelAnchor,
    beside: Sequence[Sequence[Signals]],
) -> list[Repetition]:
    """Return the repetitions from extremes or crossings of a channel.

    A repetition without an event stays in the list: its start or stop is nan, and ``lacking`` says
    why.
    """
    members: dict[Hashable, list[int]] = {}
    for i, each in enumerate(repetitions):
        movement = get_movement_key(each.segment)
        members.setdefault(groups[each.recording].get(movement, movement), []).append(i)
    curves = [
        _sample_curve(recording, anchor, others)
        for recording, others in zip(recordings, beside, strict=True)
    ]
    starts = np.full(len(repetitions), np.nan)
    if anchor.level is None:
        find_starts = partial(_find_maxima, curves=curves)
    else:
        times = [_find_crossings(*curve, anchor.level) for curve in curves]
        find_starts = partial(_find_nearest_events, times=times)
    for rows in members.values():
        starts[rows] = find_starts([repetitions[i] for i in rows])
    anchored = []
    for i, each in enumerate(repetitions):
        # Repetitions are sorted by time, so the next one of the run is the next in the list.
        start, stop = starts[i], starts[i + 1] if each.place in ("first", "inner") else np.nan
        lacking = "no event" if np.isnan(start) else "no event follows it" if np.isnan(stop) else ""
        # Events in the wrong order; False where one of them is nan.
        if stop <= start:
            start, stop, lacking = np.nan, np.nan, "no event"
        anchored.append(
            Repetition(
                each.recording, each.segment, each.place, float(start), float(stop),
                turned=each.turned, lacking=lacking,
            )
        )  # fmt: skip
    return anchored


def parse_channel_anchor(anchor: str | Sequence[float] | None) -> ChannelAnchor | None:
    """Return the channel that an anchor names; None if it names events or is their seconds."""
    found = _CHANNEL_ANCHOR.fullmatch(anchor.strip()) if isinstance(anchor, str) else None
    if found is None:
        return None
    sign = -1.0 if found["extreme"] == "min" or found["sign"] == "<" else 1.0
    level = None if found["level"] is None else sign * float(found["level"])
    return ChannelAnchor(found["channel"], sign, level)


def _sample_curve(
    recording: Motion | Signals, anchor: ChannelAnchor, beside: Sequence[Signals]
) -> Curve:
    """Return the values of the channel of an anchor, times its sign."""
    channels = channels_of(recording, [anchor.channel], beside=beside)
    if len(channels) > 1:
        raise ParameterError(
            f"an anchor must be one channel, but {anchor.channel!r} names {len(channels)}"
        )
    return anchor.sign * channels[0].values(), channels[0].fps


def _find_maxima(repetitions: Sequence[Repetition], curves: Sequence[Curve]) -> Floats:
    """Return the time in seconds of a channel's maximum in each repetition.

    The maximum is searched within half a cycle of its usual phase, that of the mean curve of all
    repetitions without gaps. The time is nan if this window has a gap, or if all repetitions have
    gaps.
    """
    # Without 100 %, which is 0 % of the next cycle.
    share = np.linspace(0, 1, 101)[:-1]
    sampled = []
    for each in repetitions:
        values, fps = curves[each.recording]
        at = (each.start + share * (each.stop - each.start)) * fps
        sampled.append(np.interp(at, np.arange(len(values)), values))
    usual = np.array(sampled)
    # Only repetitions without gaps: one with a gap would make the mean nan.
    complete = np.isfinite(usual).all(axis=1)
    times = np.full(len(repetitions), np.nan)
    if not complete.any():
        return times
    phase = share[int(usual[complete].mean(axis=0).argmax())]
    for i, each in enumerate(repetitions):
        values, fps = curves[each.recording]
        first, last = _find_window(each, phase)
        # Whole frames within the window, limited to the recording.
        frames = np.arange(max(0, int(np.ceil(first * fps))), min(len(values), int(last * fps) + 1))
        if len(frames) and np.isfinite(values[frames]).all():
            frame = int(frames[values[frames].argmax()])
            # Refine by a parabola through three frames. `find_vertex` finds a minimum, so the sign
            # is changed. The first and last frame of the recording lack a neighbour.
            is_inside = 0 < frame < len(values) - 1
            shift = find_vertex(*-values[frame - 1 : frame + 2]) if is_inside else 0.0
            times[i] = (frame + shift) / fps
    return times


def _find_nearest_events(repetitions: Sequence[Repetition], times: Sequence[Floats]) -> Floats:
    """Return the event nearest to the usual phase for each repetition; nan if none is near."""
    phases = [np.empty(0)]
    for each in repetitions:
        events = times[each.recording]
        inside = events[(events >= each.start) & (events < each.stop)]
        phases.append(CYCLE * (inside - each.start) / (each.stop - each.start))
    # The phase is nan if there are no events; then no window contains an event.
    phase = compute_mean_phase(np.concatenate(phases)) / CYCLE
    chosen = np.full(len(repetitions), np.nan)
    for i, each in enumerate(repetitions):
        first, last = _find_window(each, phase)
        events = times[each.recording]
        inside = events[(events >= first) & (events < last)]
        if len(inside):
            # The middle of the window is the usual phase.
            chosen[i] = inside[np.abs(inside - (first + last) / 2).argmin()]
    return chosen


def _find_window(repetition: Repetition, phase: float) -> tuple[float, float]:
    """Return the seconds half a cycle before and after a phase of a repetition."""
    length = repetition.stop - repetition.start
    return repetition.start + (phase - 0.5) * length, repetition.start + (phase + 0.5) * length


def _find_crossings(values: Floats, fps: float, level: float) -> Floats:
    """Return the times in seconds at which values rise above a level."""
    over = values - level
    # Comparisons with nan are False: no crossing is found next to a gap.
    frames = np.flatnonzero((over[:-1] <= 0) & (over[1:] > 0))
    # Linear interpolation of the crossing between both frames.
    return np.asarray((frames + over[frames] / (over[frames] - over[frames + 1])) / fps)


def is_event(anchor: str | Sequence[float]) -> bool:
    """Return whether an anchor names events, or is their seconds, and not a channel."""
    return parse_channel_anchor(anchor) is None


def cut_at_events(
    recordings: Sequence[Motion | Signals],
    tables: Sequence[Segmentation],
    anchor: str | Sequence[float],
) -> list[Repetition]:
    """Return the cycles from each event to the next one, with the label of their segment.

    Without a label they are named after the event. Transitions between labels hold no cycles.
    """
    name = normalize_event_name(anchor) if isinstance(anchor, str) else "event"
    repetitions: list[Repetition] = []
    for number, (recording, table) in enumerate(zip(recordings, tables, strict=True)):
        spans, right = _find_event_spans(recording, anchor)
        lengths = np.diff(spans, axis=1)[:, 0]
        usual = float(np.median(lengths)) if len(lengths) else 0.0
        activities = table.activities
        rows = table.primitives if len(table.primitives) else activities
        has_labels = bool((table.table.label != "").any())
        for i, (start, stop) in enumerate(spans.tolist()):
            # The middle of a usual cycle, since one with a stop may end in another movement.
            middle = (start + min(usual, stop - start) / 2) * table.fps
            row = rows[int(np.searchsorted(rows.start_frame, middle, side="right")) - 1]
            activity = activities[row.activity]
            if has_labels and activity.kind == "transition":
                continue
            # The confidences are those of the cluster and of the border of the segment.
            segment = replace(
                row, cluster=-1, label=row.label or activity.label or name,
                confidence=np.nan, border_confidence=np.nan,
            )  # fmt: skip
            # The first and the last cycle are as complete as the others: all are inner cycles.
            each = Repetition(
                number, segment, INNER, start, stop,
                lacking=LONG if stop - start > LONGEST * usual else "",
                right=None if right is None else (float(right[i, 0]), float(right[i, 1])),
            )  # fmt: skip
            repetitions.append(each)
    return repetitions


def _find_event_spans(
    recording: Motion | Signals, anchor: str | Sequence[float]
) -> tuple[Floats, Floats | None]:
    """Return spans (spans, 2) between events in seconds, and the right foot's span for each.

    A contact without a side, such as ``foot strike``, is that of either foot: the spans are those
    of the left foot, and the right foot's span is nan where none belongs to the left one. For
    other events, and if such contacts are marked without a side, there are no spans of the right
    foot (None).
    """

    def pair_events(times: Floats) -> Floats:
        """Return the spans from each event inside the recording to the next."""
        times = times[(times >= 0) & (times <= recording.n_frames / recording.fps)]
        return np.column_stack([times[:-1], times[1:]])

    if not isinstance(anchor, str):
        return pair_events(np.sort(as_floats(anchor, "anchor").ravel())), None
    name = normalize_event_name(anchor)
    if name not in (STRIKE, OFF) or len(find_marks(recording, name)):
        return pair_events(_find_event_times(recording, anchor)), None
    left, right = (pair_events(_find_event_times(recording, f"{side} {name}")) for side in SIDES)
    lengths = np.diff(right, axis=1)[:, 0]
    if len(right):
        right = right[lengths <= LONGEST * np.median(lengths)]
    matches = []
    # A right cycle belongs to the left one in which it starts or, if there are more, stops.
    for edge in right.T:
        matched = np.full(left.shape, np.nan)
        for i, (start, stop) in enumerate(left):
            inside = np.flatnonzero((edge > start) & (edge < stop))
            if len(inside):
                matched[i] = right[inside[0]]
        matches.append(matched)
    return left, max(matches, key=lambda each: np.isfinite(each).sum())


def _find_event_times(recording: Motion | Signals, anchor: str) -> Floats:
    """Return the times in seconds of a recording's events with a name."""
    name = normalize_event_name(anchor)
    marked = find_marks(recording, name)
    if name.endswith((STRIKE, OFF)):
        # Marks, and contacts found from the movement where no mark is near: a laboratory often
        # marks the contacts on its force plates only.
        with suppress(ParameterError) if len(marked) else nullcontext():
            if len(found := foot_events(recording).at(name)):
                return found
    if len(marked):
        return marked
    names = sorted({text for _, text in recording.provenance.events})
    choices = [*names, *(f"{side} {contact}" for side in SIDES for contact in (STRIKE, OFF))]
    raise ParameterError(
        f"no event {anchor!r}; there are {join_names(choices, 12)}. For a channel, give its "
        "maximum or a threshold, as in 'knee_r max' or 'knee_r > 40'"
    )
