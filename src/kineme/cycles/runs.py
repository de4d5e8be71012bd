"""From the segment table to repetitions in seconds: at one phase, and without pauses.

Borders are compared by the pose of a body, or by all channels of signals (`fine_features`).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil

import numpy as np

from kineme._util.arrays import Floats
from kineme.cycles.borders import Run, run_of, shift_to_common_phase
from kineme.errors import EndEffectorError, MotionError
from kineme.features import distance_features, pose_features
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

RATE = 250.0
"""Samples per second, at most: what is faster is averaged."""
SMOOTH_S = 0.02
"""Features are smoothed by a normal curve that deviates by this."""
STEADY_S = 0.08
"""Again, before their speed is taken, so that noise is no movement."""


@dataclass(frozen=True)
class FineFeatures:
    """Features of a recording at its rate, or at most `RATE`.

    Attributes
    ----------
    values : (samples, dims) array
    rate : float
        Samples per second.
    comparable : bool
        Whether those of another recording of as many dimensions can be compared with them.
    """

    values: Floats
    rate: float
    comparable: bool

    @cached_property
    def speed(self) -> Floats:
        """How fast they change, per second, smoothed."""
        from scipy.ndimage import gaussian_filter1d

        if len(self.values) < 2:
            return np.zeros(len(self.values))
        # Smoothed once more, since a derivative amplifies noise.
        steady = gaussian_filter1d(self.values, STEADY_S * self.rate, axis=0, mode="nearest")
        return np.asarray(np.linalg.norm(np.gradient(steady, axis=0), axis=1) * self.rate)


def fine_features(recording: Motion | Signals) -> FineFeatures:
    """Return the pose of a body, distances between its points where it has none, or all channels.

    Parameters
    ----------
    recording : Motion or Signals

    Returns
    -------
    FineFeatures
    """
    from scipy.ndimage import gaussian_filter1d

    # An odd number of frames, so that each mean is centred on a frame.
    many = ceil(recording.fps / RATE) // 2 * 2 + 1 if recording.fps > RATE else 1
    rate = recording.fps / many
    found, comparable = _features(recording)
    values = _average_frames(found, many)
    # Channels have different units: each counts by its own deviation, a constant one is only 0.
    if isinstance(recording, Signals):
        deviation = values.std(axis=0)
        values = (values - values.mean(axis=0)) / np.where(deviation > 0, deviation, 1)
    values = gaussian_filter1d(values, SMOOTH_S * rate, axis=0, mode="nearest")
    return FineFeatures(values, rate, comparable)


def _features(recording: Motion | Signals) -> tuple[Floats, bool]:
    """Features of each frame, and whether those of another recording can be compared with them."""
    if isinstance(recording, Signals):
        return recording.values, True
    try:
        return pose_features(recording), True
    except (EndEffectorError, MotionError):
        single = recording.skeleton.n_joints < 2
        positions = recording.positions
        # A single point has no distances: its path is compared.
        return positions[:, 0] if single else distance_features(positions)[0], False


def _average_frames(values: Floats, many: int) -> Floats:
    """Return the mean of the frames about every so many; the last may be of fewer."""
    if many == 1:
        return values
    from scipy.ndimage import uniform_filter1d

    # The mean about each frame, of which every n-th is kept.
    return np.asarray(uniform_filter1d(values, many, axis=0, mode="nearest")[::many])


PAUSE_S = 0.5
"""Seconds of standing still between two repetitions that are a pause, at least."""
STILL = 0.1
"""Of the speed of a cluster, the root of its mean square: what is slower stands still."""
OUTSIDE = 0.25
"""Of a cycle: a repetition that is farther outside of its activity is not complete, nor is one at
its ends that lacks more."""


@dataclass(frozen=True)
class Repetition:
    """One repetition: what the segmentation says of it, and from when to when it is measured.

    Attributes
    ----------
    recording : int
        Which of the recordings.
    segment : Segment
        The primitive.
    number : int
        In its activity, from 0.
    place : str
        ``inner``, or where it touches an end of its run ``first``, ``last`` or ``only``.
    start, stop : float
        Seconds.
    start_deviation, stop_deviation : float
        How uncertain they are, seconds; nan where nothing tells.
    pause : float
        Seconds of standing still between it and the repetition before.
    complete : bool
        Whether its activity reaches from its start to its stop.
    turned : float
        Of a cycle: how much later it begins than its segment, to begin where others do.
    missing : str
        What it lacks to be measured, such as the event that it begins with.
    """

    recording: int
    segment: Segment
    number: int
    place: str
    start: float
    stop: float
    start_deviation: float
    stop_deviation: float
    pause: float = 0.0
    complete: bool = True
    turned: float = 0.0
    missing: str = ""


def repetitions(
    recordings: Sequence[Motion | Signals],
    tables: Sequence[Segmentation],
    groups: Sequence[Mapping[int | str, Hashable]],
) -> list[Repetition]:
    """Return the repetitions of all recordings, in the order of recordings and of time.

    Parameters
    ----------
    recordings : sequence of Motion or Signals
    tables : sequence of Segmentation
        One of each.
    groups : sequence of mapping
        Of each: the group of a `movement`. Repetitions of one group begin at one phase.
    """
    fine = [fine_features(recording) for recording in recordings]
    # Runs of one key are shifted to one phase.
    members: dict[Hashable, list[tuple[Run, list[Segment]]]] = defaultdict(list)
    for number, table in enumerate(tables):
        dims, comparable = fine[number].values.shape[1], fine[number].comparable
        for segments in _back_to_back(table):
            frames = [segments[0].start_frame, *(each.stop_frame for each in segments)]
            run = run_of(number, np.array(frames) / table.fps)
            what = movement(segments[0])
            # A run without cluster or label is alone; features that do not compare stay in their
            # recording.
            alone = id(run) if what == "" else -1 if comparable else number
            group = groups[number].get(what, what)
            members[group, dims, alone].append((run, segments))
    found: list[Repetition] = []
    features, rates = [each.values for each in fine], [each.rate for each in fine]
    for runs in members.values():
        aligned = shift_to_common_phase([run for run, _ in runs], features, rates)
        still = _stillness(aligned, fine)
        for run, (_, segments) in zip(aligned, runs, strict=True):
            each = _each(run, segments, tables[run.recording])
            found += _trim_pauses(each, fine[run.recording], still)
    found.sort(key=lambda each: (each.recording, each.segment.start_frame))
    return _number_repetitions(found)


def movement(segment: Segment) -> int | str:
    """What repetitions of one movement have in common: the cluster, else the label, if any."""
    return segment.cluster if segment.cluster >= 0 else segment.label


def _back_to_back(table: Segmentation) -> list[list[Segment]]:
    """Return the repetitions of one movement in one activity, one after the other without a gap."""
    runs: list[list[Segment]] = []
    for row in table.primitives:
        if row.kind != "primitive":
            continue
        last = runs[-1][-1] if runs else None
        if (
            last is not None
            and movement(row) != ""
            and (movement(last), last.activity) == (movement(row), row.activity)
            and last.stop_frame == row.start_frame
        ):
            runs[-1].append(row)
        else:
            runs.append([row])
    return runs


def _each(run: Run, segments: Sequence[Segment], table: Segmentation) -> list[Repetition]:
    """Return the repetitions of a run, cut off where its activity ends."""
    n, found = len(segments), []
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
        first, last = i == 0, i == n - 1
        # Only the first and the last can be cut short by an end.
        if first or last:
            complete &= stop - start >= (1 - OUTSIDE) * run.period
        place = "only" if first and last else "first" if first else "last" if last else "inner"
        found.append(
            Repetition(
                recording=run.recording,
                segment=segment,
                number=i,
                place=place,
                start=start,
                stop=max(start, stop),
                start_deviation=float(run.uncertainty[i]),
                stop_deviation=float(run.uncertainty[i + 1]),
                complete=complete,
                turned=run.turned,
            )
        )
    return found


def _stillness(runs: Sequence[Run], fine: Sequence[FineFeatures]) -> float:
    """Return the speed below which repetitions of these runs stand still."""
    total, count = 0.0, 0
    # The root mean square over all frames of all runs; no run is weighed by itself.
    for run in runs:
        rate = fine[run.recording].rate
        frames = slice(max(0, int(run.borders[0] * rate)), int(run.borders[-1] * rate) + 1)
        speed = fine[run.recording].speed[frames]
        total, count = total + float(np.square(speed).sum()), count + len(speed)
    return STILL * float(np.sqrt(total / max(count, 1)))


def _trim_pauses(run: list[Repetition], fine: FineFeatures, still: float) -> list[Repetition]:
    """Return the repetitions of a run, from where movement begins to where it ends.

    Standing still counts as a pause where it lasts `PAUSE_S`, on both sides of a border together.
    """
    trimmed = list(run)
    for i, each in enumerate(run):
        # A pause reaches from the last movement of one repetition to the first of the next.
        following = run[i + 1] if i + 1 < len(run) else None
        begins, ends = _movement(each, fine, still)
        # Standing still before the first repetition is not a part of it.
        if i == 0 and begins - each.start >= PAUSE_S:
            trimmed[0] = replace(trimmed[0], start=begins)
        until = each.stop if following is None else _movement(following, fine, still)[0]
        # `trimmed[i]` may begin later than `each`: the pause before it was cut off already.
        if ends > trimmed[i].start and until - ends >= PAUSE_S:
            trimmed[i] = replace(trimmed[i], stop=ends)
            if following is not None and until < following.stop:
                trimmed[i + 1] = replace(following, start=until, pause=until - ends)
    return trimmed


def _movement(each: Repetition, fine: FineFeatures, still: float) -> tuple[float, float]:
    """When the first and the last movement of a repetition are; its ends where there is none."""
    # The frames of `speed` that lie within the repetition.
    first = max(0, int(np.ceil(each.start * fine.rate)))
    moves = np.flatnonzero(fine.speed[first : int(each.stop * fine.rate) + 1] > still)
    if len(moves) == 0:
        return each.start, each.stop
    # Frames of the first and the last movement, in seconds.
    begins, ends = (first + moves[[0, -1]]) / fine.rate
    return max(each.start, float(begins)), min(each.stop, float(ends))


def _number_repetitions(found: Sequence[Repetition]) -> list[Repetition]:
    """Return the repetitions counted from 0 in each activity."""
    counts: dict[tuple[int, int], int] = defaultdict(int)
    numbered = []
    for each in found:
        key = each.recording, each.segment.activity
        numbered.append(replace(each, number=counts[key]))
        counts[key] += 1
    return numbered
