"""Rows at any times to frames at one rate: the clock-true front end of every recording of rows.

`place_rows` finds the frame of each row and `Timing.resample` the values of each frame. Rows at
even times are the frames, untouched. Others are put in order of time and onto a grid that begins
with the first of them:

- the rate is that of the usual step. Where sensors of several rates share a table, each row with
  values of one of them, it is that of the fastest;
- rows within a tenth of a period of the grid are moved onto it, and keep their values. Between
  other rows, and in holes of up to 0.2 s, values lie on a straight line;
- longer holes are gaps, which last as long as the clock says. Only a pause that would take more
  frames than all of the rest is cut short, with a warning; the `Clock` still tells its times;
- rows of one time are averaged, unless packets of rows share a time: these are spread;
- a change of summer time and midnight are undone, and a clock that shows a time twice was set.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats, Ints, Masks
from kineme._util.checks import format_count, join_names
from kineme.errors import ParameterError
from kineme.recordings.arrays import find_spans
from kineme.recordings.clock import Clock, is_unix_time
from kineme.recordings.provenance import Note

LONGEST_S = 0.2
"""Seconds: holes up to this long are filled."""

UNEVEN = 0.1
"""Share of a period by which times may differ from even ones."""

_ORDINARY = 0.5  # share of the median step by which an ordinary step differs from it at most
_MOST = 2 / 3  # share of steps that are ordinary, else the rate is that of the whole duration
_ADDS_UP = 0.1  # share by which steps of whole periods may miss the duration
_WHOLE = 0.01  # share by which the rate of uneven times may differ from whole frames a second
_FEW = 0.01  # share of steps back in time up to which a clock was set, and rows are not shuffled
_PACKETS = 1 / 3  # share of rows with the time of another from which on they come in packets
_SAME = 1e-6  # share of a step below which times are the same
_SLOWEST_S = 2.0  # period of a slow channel at most
_ROOM = 8  # frames for each row at most, and as many values as follow
_VALUES = 1_000_000
_HOUR, _DAY = 3600.0, 86400.0


@dataclass(frozen=True, eq=False)
class Timing:
    """Frame rate of rows, and where they lie.

    Attributes
    ----------
    fps : float
        Frames per second.
    order : (rows,) array of int, optional
        The rows that have a time, in order of time. None where rows are frames.
    at : (rows,) array, optional
        The frame of each of these, from 0 and rising, between frames perhaps.
    n_frames : int
        Of the grid; 0 where rows are frames.
    gaps : tuple of (int, int)
        Frames [start, stop) in which the clock was set or paused for too long.
    notes : tuple of Note
        What was seen of the times.
    clock : Clock, optional
        None where it shows the seconds of the recording.
    """

    fps: float
    order: Ints | None = None
    at: Floats | None = None
    n_frames: int = 0
    gaps: tuple[tuple[int, int], ...] = ()
    notes: tuple[Note | str, ...] = ()
    clock: Clock | None = None

    @property
    def row_seconds(self) -> Floats | None:
        """Return the second of each row in order of time; None where rows are frames."""
        return None if self.at is None else self.at / self.fps

    def noted(self, notes: Iterable[Note | str]) -> Timing:
        """Return the same with these notes in place of its own."""
        return replace(self, notes=tuple(notes))

    def frames_of_rows(self, n_rows: int) -> Ints:
        """Return the nearest frame of each row, in the order given; of one without a time, 0."""
        if self.order is None or self.at is None:
            return np.arange(n_rows)
        frames = np.zeros(n_rows, np.int64)
        frames[self.order] = np.minimum(np.rint(self.at), self.n_frames - 1)
        return frames

    def resample(self, values: ArrayLike) -> Resampled:
        """Return the values of each frame, on straight lines through those of the rows.

        Parameters
        ----------
        values : (rows, channels) array_like
            In the order of the times; NaN or infinite where there is nothing.
        """
        given = np.asarray(values, np.float64)
        if self.order is None or self.at is None:
            frames, at, n_frames = given, np.arange(len(given), dtype=np.float64), len(given)
        else:
            # an index that changes nothing would copy a day of rows
            sorted_rows = len(self.order) == len(given) and (np.diff(self.order) > 0).all()
            at, frames = _average_duplicates(self.at, given if sorted_rows else given[self.order])
            n_frames = self.n_frames
        on_grid = bool((at == np.rint(at)).all())
        present = np.isfinite(frames)
        if on_grid and len(at) == n_frames and present.all():
            return Resampled(frames, None, 0)
        found = np.empty((n_frames, frames.shape[1]))
        missing = np.zeros(found.shape, np.bool_)
        grid = np.arange(n_frames, dtype=np.float64)
        filled = 0
        for channels, seen in _group_by_missing_rows(present):
            known = at if seen.all() else at[seen]
            if not len(known):
                found[:, channels], missing[:, channels] = np.nan, True
                continue
            for channel in channels:
                found[:, channel] = np.interp(grid, known, frames[seen, channel])
            hole = np.zeros(n_frames, np.bool_)
            for start, stop in _find_holes(known, n_frames, self.fps).tolist():
                hole[start:stop] = True
            missing[:, channels] = hole[:, None]
            filled += len(channels) * (n_frames - len(known) - int(hole.sum()))
        return Resampled(found, missing if missing.any() else None, filled if on_grid else 0)


@dataclass(frozen=True, eq=False)
class Resampled:
    """Values of each frame.

    Attributes
    ----------
    values : (frames, channels) array
        NaN in channels that have no value at all.
    missing : (frames, channels) array of bool, optional
        Whether a value bridges a hole of more than `LONGEST_S`; None where none does.
    filled : int
        How many values of frames on the grid were missing for less.
    """

    values: Floats
    missing: Masks | None
    filled: int


def place_rows(times: ArrayLike, values: ArrayLike | None = None, *, fps: float = 0.0) -> Timing:
    """Return the rate of rows that were taken at these times, and the frame of each.

    Parameters
    ----------
    times : (rows,) array_like
        Seconds, in any order; NaN where a row has none.
    values : (rows, channels) array_like, optional
        What was taken: it tells sensors of several rates apart, and packets from duplicates.
    fps : float, optional
        Frames per second of the grid, in place of what the times tell.

    Raises
    ------
    ParameterError
        Times that are too few, no numbers, or all the same.

    Examples
    --------
    >>> timing = place_rows([0.0, 0.1, 0.2, 0.4, 0.5])  # one row was lost
    >>> timing.fps, timing.resample([[0.0], [1.0], [2.0], [4.0], [5.0]]).values.ravel().tolist()
    (10.0, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
    """
    shown = np.asarray(times, np.float64)
    taken = None if values is None else np.asarray(values, np.float64)
    known = np.isfinite(shown)
    if known.sum() < 2 or known.mean() < 0.5:
        raise ParameterError("the times are too few or not numbers: give fps= (--fps)")
    if known.all() and not fps and _is_even(shown, steps := np.diff(shown)):
        duration = float(shown[-1] - shown[0])
        doubt = 2 * np.spacing(np.abs(shown).max()) / duration
        fps = _round_rate(len(steps) / duration, max(1e-6, float(doubt)))
        return Timing(fps, clock=Clock.of(shown, fps))
    rows = np.flatnonzero(known)
    shown, taken = shown[rows], None if taken is None else taken[rows]
    at, was_set, notes = _correct_clock(shown, taken)
    if len(rows) < len(known):
        untimed = format_count(len(known) - len(rows), "row")
        notes.append(Note(f"{untimed} without a time left out"))
    if (np.diff(at) < 0).any():
        sequence = np.argsort(at, kind="stable")
        rows, at, shown = rows[sequence], at[sequence], shown[sequence]
        was_set = None if was_set is None else was_set[sequence]
        taken = None if taken is None else taken[sequence]
    ahead = shown - at  # constant but where the clock was set
    if not at[-1] > at[0]:
        raise ParameterError(
            f"times do not increase: row 2 has {at[0]:g} s, as all others have; give fps= (--fps)"
        )
    steps = np.diff(at)
    apart = np.append(True, steps > _SAME * np.median(steps[steps > 0]))
    if not apart.all():  # numbers that differ by rounding are one time
        at = at[apart][np.cumsum(apart) - 1]
    at, note = _spread_packets(at, taken)
    notes += note
    moments, merged = (np.unique(at), None) if taken is None else _average_duplicates(at, taken)
    rate = fps or _find_fastest_rate(moments, merged)
    frames = _snap_to_grid((at - at[0]) * rate, rate)
    if not fps and (frames != np.rint(frames)).any():
        # any rate is true on a grid that rows are brought to, and a whole one is the sensor's
        whole = max(1.0, np.rint(rate))
        if abs(whole - rate) <= _WHOLE * rate:
            rate, frames = whole, _snap_to_grid((at - at[0]) * whole, whole)
    elif not fps:
        rate = _round_rate(rate, max(1e-6, UNEVEN / max(1.0, float(frames[-1]))))
    exact = bool((frames == np.rint(frames)).all())
    notes += _describe_timing(np.diff(moments), len(at) - len(moments), rate, exact=exact)
    channels = 1 if taken is None else max(1, taken.shape[1])
    timing = Timing(rate, rows, frames, notes=tuple(notes))
    return _add_clock_and_gaps(timing, at, ahead, was_set, _ROOM * len(at) + _VALUES // channels)


def _add_clock_and_gaps(
    timing: Timing, at: Floats, ahead: Floats, was_set: Masks | None, most: int
) -> Timing:
    """Return the same with its clock and gaps, and pauses cut that ``most`` frames do not hold.

    ``at`` are the seconds of the rows in order of time, ``ahead`` is how far the clock was ahead of
    them; ``was_set`` right after the clock went back.
    """
    assert timing.at is not None  # noqa: S101 (for mypy)
    rate, notes = timing.fps, list(timing.notes)
    frames, cut = _shorten_pauses(timing.at, most)
    if cut.any():
        k = int(cut.argmax())
        text = (
            f"{format_count(int(cut.sum()), 'pause')}, the first of {at[k + 1] - at[k]:.4g} s "
            f"after second {frames[k] / rate:.4g}: the recording is split there, and its seconds "
            "do not count them"
        )
        notes.append(Note(text, "warning"))
    # where the clock does not go on as the seconds do
    turns = np.flatnonzero(cut | (np.abs(np.diff(ahead)) > LONGEST_S)) + 1
    starts, clock = np.append(0, turns), None
    begins, shown = frames[starts] / rate, (at + ahead)[starts]
    if len(starts) > 1 or abs(shown[0]) > 0.5 / rate:
        clock = Clock(begins.tolist(), shown.tolist())
    split = cut if was_set is None else cut | was_set[1:]
    ends = ((frames[k], frames[k + 1]) for k in np.flatnonzero(split).tolist())
    gaps = ((int(np.floor(a)) + 1, int(np.ceil(b))) for a, b in ends)
    return replace(
        timing,
        at=frames,
        n_frames=int(np.floor(frames[-1] + UNEVEN)) + 1,
        gaps=tuple((start, stop) for start, stop in gaps if start < stop),
        notes=tuple(notes),
        clock=clock,
    )


def fill_gaps_in_channels(
    timing: Timing, values: ArrayLike, names: Sequence[str]
) -> tuple[Floats, list[tuple[int, int]], list[Note | str]]:
    """Return finite values of each frame, the gaps, and what was done.

    A frame in which any channel is missing for long lies in a gap. ParameterError where a channel
    holds no number, or nothing is left between the gaps.
    """
    found = timing.resample(values)
    doubts = find_faulty_channels(found, timing.fps, names)
    notes: list[Note | str] = []
    if found.filled:
        values_filled = format_count(found.filled, "missing value")
        notes.append(f"{values_filled} filled in a straight line")
    if found.missing is None:
        return found.values, list(timing.gaps), [*notes, *doubts]
    jumps = np.zeros(len(found.values), np.bool_)
    for start, stop in timing.gaps:
        jumps[start:stop] = True
    if found.missing.all(axis=0).any():
        name = names[int(found.missing.all(axis=0).argmax())]
        raise ParameterError(f"column {name!r} holds no number at all: name the others (--columns)")
    long = found.missing.any(axis=1)
    if (long | jumps).all():
        raise ParameterError("in every frame some channel is missing for long: choose columns")
    # where the clock was set, the gap is said already
    holes = find_spans(long & ~jumps)
    if len(holes):
        frames = format_count(int((long & ~jumps).sum()), "frame")
        notes.append(f"{format_count(len(holes), 'gap')} of more than {LONGEST_S:g} s, {frames}")
    gaps = [(start, stop) for start, stop in find_spans(long | jumps).tolist()]
    return found.values, gaps, [*notes, *doubts]


FROZEN_S = 3.0
"""Seconds for which a channel that else changes all the time must be the same to be frozen."""
_CHANGES = 0.5  # share of steps that change, outside of such spans
_CLIPPED = 3  # values in a row at the limit of a sensor
_CLIPS = 0.001  # share of such values from which on it is said
_COARSE = 5  # steps of the sensor by which values reach its limit at once
_LEVELS = 50  # different values that a sensor has at least


def find_faulty_channels(found: Resampled, fps: float, names: Sequence[str]) -> list[Note | str]:
    """Return warnings of channels that freeze for seconds, or are cut off at a largest value."""
    frozen, clipped = [], []
    least = max(2, round(FROZEN_S * fps))
    for channel, name in enumerate(names):
        track = found.values[:, channel]
        if found.missing is not None:
            track = track[~found.missing[:, channel]]
        if len(track) < 2:
            continue
        same = np.diff(track) == 0
        runs = find_spans(same)
        lengths = runs[:, 1] - runs[:, 0]
        long = lengths >= least
        others = len(same) - int(lengths[long].sum())
        if long.any() and others >= least and lengths[~long].sum() <= (1 - _CHANGES) * others:
            first = runs[long][0]
            lasts = int(lengths[long].max()) / fps
            frozen.append(f"{name} ({lasts:.3g} s at {first[0] / fps:.4g} s)")
        if _is_clipped(track, runs[~long]):
            clipped.append(name)
    remarks = {
        "channels that do not change for a while": frozen,
        "channels that are cut off at their largest values": clipped,
    }
    return [Note(f"{remark}: {join_names(named, most=4)}", "warning")
            for remark, named in remarks.items() if named]  # fmt: skip


def _is_clipped(track: Floats, runs: NDArray[np.intp]) -> bool:
    """Return whether several values in a row are often the largest or the smallest of all."""
    # values that a slower sensor holds for some rows are counted once
    held = round(len(track) / max(1, len(track) - int((runs[:, 1] - runs[:, 0]).sum())))
    long = runs[runs[:, 1] - runs[:, 0] >= _CLIPPED * held - 1]
    if len(long) < 2:
        return False
    firsts = long[:, 0]
    ends, lengths = track[firsts], long[:, 1] - long[:, 0] + 1
    # A smooth peak in coarse steps is flat, too, but values come near it step by step.
    entries = np.abs(ends - track[np.maximum(firsts - 1, 0)])
    moves = np.abs(np.diff(track))
    coarse = _COARSE * float(moves[moves > 0].min(initial=np.inf))
    low, middle, high = np.percentile(track, (25, 50, 75))
    for limit in (track.min(), track.max()):
        cut = ends == limit
        often = int(lengths[cut].sum()) >= _CLIPS * len(track) and cut.sum() > 1
        far = abs(limit - middle) > high - low > 0  # a force of nothing is the smallest, too
        if often and far and np.median(entries[cut]) >= coarse:
            return len(np.unique(track)) >= _LEVELS
    return False


def _group_by_missing_rows(present: Masks) -> Iterator[tuple[list[int], Masks]]:
    """Yield channels that have values in the same rows, and which rows these are."""
    found: dict[bytes, list[int]] = {}
    for channel in range(present.shape[1]):
        found.setdefault(np.packbits(present[:, channel]).tobytes(), []).append(channel)
    for channels in found.values():
        yield channels, present[:, channels[0]]


def _average_duplicates(at: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return each time once, and the means of the values that rows of one time have."""
    starts = np.flatnonzero(np.diff(at, prepend=-np.inf) > 0)
    if len(starts) == len(at):
        return at, values
    present = np.isfinite(values)
    counts = np.add.reduceat(present, starts, axis=0, dtype=np.float64)
    sums = np.add.reduceat(np.where(present, values, 0.0), starts, axis=0)
    with np.errstate(invalid="ignore"):
        return at[starts], sums / counts


def _find_holes(known: Floats, n_frames: int, fps: float) -> NDArray[np.int64]:
    """(holes, 2): frames [start, stop) between known ones that are too far apart to be bridged."""
    apart = np.diff(known)
    most = LONGEST_S * fps + 1e-9
    # A channel may be slower than the others, and regular all the same.
    usual = float(np.median(apart)) if len(apart) >= 10 else 1.0
    even = np.abs(apart - usual) <= _ORDINARY * usual
    if 1.5 < usual <= _SLOWEST_S * fps and even.mean() > _MOST:
        most = max(most, 2.5 * usual)
    # frames within half a frame of a known one are as good as known
    ends = np.concatenate([[-1.0], known, [float(n_frames)]])
    starts = np.floor(ends[:-1] + 0.5).astype(np.int64) + 1
    stops = np.minimum(np.ceil(ends[1:] - 0.5).astype(np.int64), n_frames)
    long = np.diff(ends) - 1 > most
    spans = np.column_stack([np.maximum(starts, 0), stops])[long]
    return spans[spans[:, 0] < spans[:, 1]]


def _is_even(times: Floats, steps: Floats) -> bool:
    """Return whether the times are even ones, give or take a tenth of a period."""
    period = float(np.median(steps))
    if steps.min() <= 0:
        return False
    drift = times - period * np.arange(len(times))
    return bool(
        np.abs(drift - drift.mean()).max() <= UNEVEN * period or np.ptp(steps) <= UNEVEN * period
    )


def _correct_clock(
    shown: Floats, values: Floats | None
) -> tuple[Floats, Masks | None, list[Note | str]]:
    """Return times of a clock that nobody sets, which are right after it was set, and notes."""
    steps = np.diff(shown)
    back = steps < 0
    rising = steps[steps > 0]
    usual = float(np.median(rising)) if len(rising) else 0.0
    if back.sum() > max(1, _FEW * len(steps)):  # rows in no order, and no clock that was set
        return shown, None, [Note("rows are in no order of time: sorted by their times", "warning")]

    def near(by: float) -> Masks:
        found: Masks = np.abs(steps - by - usual) <= max(2 * usual, LONGEST_S)
        return found

    notes: list[Note | str] = []
    hours = near(-_HOUR) & back if usual < _HOUR / 10 else np.zeros_like(back)
    if usual < _HOUR / 10 and is_unix_time(shown[0]):
        hours = hours | near(_HOUR)
    days = near(-_DAY) & back
    if hours.any():
        notes.append(
            Note("local times change by an hour, as for summer time: the hour is undone", "warning")
        )
    shift = np.where(hours, -_HOUR * np.sign(steps), np.where(days, _DAY, 0.0))
    at = shown + np.append(0.0, np.cumsum(shift)) if shift.any() else shown
    steps = np.diff(at)
    reset = steps < -LONGEST_S
    if not reset.any():
        if (steps < 0).any():
            notes.append("1 step back in time" if (steps < 0).sum() == 1 else "steps back in time")
        return at, None, notes
    if not _was_clock_set(at, usual, values):
        return at, None, [*notes, Note("rows are not in order of time: sorted", "warning")]
    # one frame between, which is a gap: nobody knows how long it took
    at = at + np.append(0.0, np.cumsum(np.where(reset, 2 * usual - steps, 0.0)))
    times = format_count(int(reset.sum()), "time")
    notes.append(Note(f"the clock goes back {times}: the recording is split there", "warning"))
    return at, np.append(False, reset), notes


def _was_clock_set(at: Floats, usual: float, values: Floats | None) -> bool:
    """Return whether sorting rows would mix them up: a clock went back, and rows are in order."""
    order = np.argsort(at, kind="stable")
    steps, before = np.diff(at[order]), np.diff(at)
    close = steps < 0.5 * usual
    if values is not None:
        # rows that are there twice are no sign of it
        one, other = values[order[:-1]], values[order[1:]]
        close &= ~((steps == 0) & ((one == other) | (np.isnan(one) & np.isnan(other))).all(axis=1))
    crowded = int(close.sum()) - int((np.abs(before) < 0.5 * usual).sum())
    if crowded > 4 * int((before < -LONGEST_S).sum()):
        return True
    hole = max(LONGEST_S, 3 * usual)
    return not is_unix_time(at[0]) and (steps > hole).sum() > (before > hole).sum()


def _spread_packets(at: Floats, values: Floats | None) -> tuple[Floats, list[Note | str]]:
    """Return times of rows that come in packets of one time: even ones up to the next packet."""
    same = np.diff(at) == 0
    if same.mean() < _PACKETS:
        return at, []
    if values is not None:
        one, other = values[:-1][same], values[1:][same]
        differ = (np.isfinite(one) & np.isfinite(other) & (one != other)).any(axis=1)
        if differ.mean() < 0.1:  # the same rows twice, or sensors that share a time
            return at, []
    starts = np.append(np.flatnonzero(np.append(True, ~same)), len(at))
    sizes = np.diff(starts)
    begins = at[starts[:-1]]
    # seconds from row to row in each packet, and as usual
    period = np.append(np.diff(begins), np.nan) / sizes
    usual = float(np.nanmedian(period[1:])) if len(period) > 2 else float(period[0])
    period = np.fmin(period, 1.5 * usual)
    period[-1] = usual
    within = np.arange(len(at)) - np.repeat(starts[:-1], sizes)
    spread = np.repeat(begins, sizes) + within * np.repeat(period, sizes)
    if len(begins) > 1 and sizes[0] < np.median(sizes):  # it began within a packet
        first = int(sizes[0])
        spread[:first] = begins[1] - usual * np.arange(first, 0, -1)
    count = format_count(int(same.sum()), "row")
    note = f"{count} with the time of the row before: spread evenly up to the next time"
    return spread, [Note(note, "warning")]


def _find_fastest_rate(moments: Floats, values: Floats | None) -> float:
    """Return the rate of the rows, or of the fastest sensor that fills only some of them."""
    rates: list[float] = []
    if values is not None:
        rows = [seen for _, seen in _group_by_missing_rows(np.isfinite(values)) if seen.any()]
        if all(seen.mean() <= _MOST for seen in rows):
            rates = [_measure_rate(moments[seen]) for seen in rows if seen.sum() > 1]
    return max(rates, default=_measure_rate(moments))


def _measure_rate(moments: Floats) -> float:
    """Return rows per second.

    The mean of the steps that are nearly the median: clocks that count milliseconds
    give 120 Hz steps of 8 and 9, and lost rows leave steps of several periods. Where
    that does not add up, as where one row in three comes late, all count but the holes.
    """
    steps = np.diff(moments)
    median = float(np.median(steps))
    counted = steps[steps <= max(LONGEST_S, 3 * median)]
    ordinary = counted[np.abs(counted - median) <= _ORDINARY * median * (1 + 1e-9)]
    if len(ordinary) >= _MOST * len(counted):
        period = float(ordinary.mean())
        whole = float(np.maximum(np.rint(counted / period), 1).sum())
        if abs(period * whole - counted.sum()) <= _ADDS_UP * counted.sum():
            return whole / float(counted.sum())
    return len(counted) / float(counted.sum())


def _snap_to_grid(frames: Floats, fps: float) -> Floats:
    """Return whole frames where rows are regular between holes; else they stay between frames.

    After a pause rows are off the grid by some share of a frame, which does not matter.
    """
    part = np.append(0, np.cumsum(np.diff(frames) > LONGEST_S * fps + 1))
    firsts = np.flatnonzero(np.diff(part, prepend=-1))
    since = np.rint(frames - frames[firsts][part])
    ahead = np.bincount(part, frames - since) / np.bincount(part)
    if np.abs(frames - since - ahead[part]).max() > 2 * UNEVEN:
        return frames
    snapped = since + np.rint(ahead)[part]
    # parts that are close to each other must not meet in one frame
    if (np.diff(snapped)[np.diff(frames) > 0.5] <= 0).any():
        return frames
    return np.asarray(snapped - snapped[0], np.float64)


def _shorten_pauses(frames: Floats, most: int) -> tuple[Floats, Masks]:
    """Return frames with the longest pauses cut to one frame, so many that all fit; and which."""
    steps = np.diff(frames)
    cut = np.zeros(len(steps), np.bool_)
    excess = frames[-1] - most
    if excess > 0:
        longest = np.argsort(-steps, kind="stable")
        saved = np.cumsum(np.floor(steps[longest]) - 2)
        count = int(np.searchsorted(saved, excess)) + 1
        if count > len(steps) or steps[longest[count - 1]] <= 3:
            raise ParameterError("the times do not tell a rate: give fps= (--fps)")
        cut[longest[:count]] = True
        # whole frames are taken away, so that rows on the grid stay there
        frames = frames - np.append(0.0, np.cumsum(np.where(cut, np.floor(steps) - 2, 0.0)))
    return frames, cut


def _describe_timing(steps: Floats, doubled: int, fps: float, *, exact: bool) -> list[Note | str]:
    """Return a sentence on times that are uneven; ``exact`` if rows are at frames all the same."""
    counts = [
        (doubled, "row", "with the time of another"),
        (int((steps * fps > 1.5).sum()), "step", "longer than a frame and a half"),
    ]
    parts = [f"{format_count(n, one)} {what}" for n, one, what in counts if n]
    if exact and not parts:
        return []
    return [f"times are uneven ({', '.join(parts) or 'jitter'}): brought to {fps:g} Hz"]


def _round_rate(fps: float, share: float) -> float:
    """Return the rate in whole hertz or thousandths where it is within this share of these."""
    near = (round(fps, digits) for digits in (0, 3))
    return next((rate for rate in near if rate > 0 and abs(fps - rate) <= share * fps), fps)
