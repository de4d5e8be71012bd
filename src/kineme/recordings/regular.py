"""Resample rows taken at any times to frames at one rate.

`place_rows` finds the frame of each row and `Timing.resample` the values of each frame. Rows at
even times become frames unchanged. Other rows are sorted by time and placed on a grid that begins
at the first of them:

- The rate follows from the usual step. If a table has rows of sensors with different rates, the
  fastest one counts.
- Rows within a tenth of a period of the grid are moved onto it and keep their values. Other values,
  and holes of up to 0.2 s, are interpolated linearly.
- Longer holes become gaps with their true length. A pause that would need more frames than all the
  rest is shortened, with a warning; the `Clock` keeps its times.
- Rows with the same time are averaged, unless they come in packets: these are spread evenly.
- Jumps by daylight saving time and at midnight are undone. Other steps back mean that the clock
  was reset.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats, Ints, Masks
from kineme._util.checks import format_count, join_names
from kineme.errors import ParameterError
from kineme.recordings.arrays import find_spans, list_spans, mark_spans
from kineme.recordings.provenance import Note
from kineme.recordings.times import Clock, is_near_full_hour, is_unix_time

LONGEST_S = 0.2
"""Longest hole that is filled, in seconds."""

UNEVEN = 0.1
"""Fraction of a period by which times may differ from even ones."""

RATE_STEPS = 10
"""Steps from one value to the next from which a channel is known to be slower than the others."""

_ORDINARY = 0.5  # an ordinary step differs from the median step by at most this fraction
_MOST = 2 / 3  # fraction of ordinary steps below which the whole duration determines the rate
_ADDS_UP = 0.1  # fraction by which whole periods may miss the duration
_WHOLE = 0.01  # fraction by which an uneven rate may differ from a whole number of hertz
_FEW = 0.01  # up to this fraction of steps back in time the clock was reset, not rows shuffled
_PACKETS = 1 / 3  # from this fraction of rows with repeated times on, rows come in packets
_SAME = 1e-6  # times closer than this fraction of a step are equal
_SLOWEST_S = 2.0  # longest period of a slow channel, seconds
_MOST_FRAMES_PER_ROW = 8  # limits the size of the grid
_VALUES = 1_000_000  # additional values that the grid may always have
_HOUR, _DAY = 3600.0, 86400.0

FROZEN_S = 3.0
"""Seconds without a change after which an otherwise changing channel counts as frozen."""
_MISSING = 0.5  # fraction of missing frames above which a channel is left out
_LOST = 0.25  # fraction of frames lost to gaps of single channels above which a warning is given
_CHANGES = 0.5  # fraction of steps that change in a channel that is not frozen
_CLIPPED = 3  # successive values at the limit of a sensor that count as clipped
_CLIPS = 0.001  # fraction of clipped values from which on a warning is given
_COARSE = 5  # sensor steps by which values jump to the limit if clipped
_LEVELS = 50  # a sensor has at least so many different values


@dataclass(frozen=True, eq=False)
class Timing:
    """Frame rate of rows, and their frames."""

    fps: float
    order: Ints | None = None  # (rows,) that have a time, sorted by time; None if rows are frames
    at: Floats | None = None  # (rows,) frame of each, increasing from 0, possibly fractional
    n_frames: int = 0  # of the grid; 0 if rows are frames
    gaps: tuple[tuple[int, int], ...] = ()  # where the clock was reset or paused for too long
    notes: tuple[Note | str, ...] = ()
    clock: Clock | None = None  # None if the times are seconds from the start of the recording

    @property
    def row_seconds(self) -> Floats | None:
        """Return the second of each row in time order; None if rows are frames."""
        return None if self.at is None else self.at / self.fps

    def frames_of_rows(self, n_rows: int) -> Ints:
        """Return the nearest frame of each row in file order; 0 for a row without a time."""
        if self.order is None or self.at is None:
            return np.arange(n_rows)
        frames = np.zeros(n_rows, np.int64)
        frames[self.order] = np.minimum(np.rint(self.at), self.n_frames - 1)
        return frames

    def resample(self, values: ArrayLike) -> Resampled:
        """Return the values of each frame, interpolated linearly between rows.

        ``values`` (rows, channels) are in file order; NaN or infinite if missing.
        """
        rows = np.asarray(values, np.float64)
        if self.order is None or self.at is None:
            frames, at, n_frames = rows, np.arange(len(rows), dtype=np.float64), len(rows)
        else:
            # avoid a copy of all rows if they are sorted already
            sorted_rows = len(self.order) == len(rows) and (np.diff(self.order) > 0).all()
            at, frames = _average_duplicates(self.at, rows if sorted_rows else rows[self.order])
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
            hole = mark_spans(_find_holes(known, n_frames, self.fps).tolist(), n_frames)
            missing[:, channels] = hole[:, None]
            filled += len(channels) * (n_frames - len(known) - int(hole.sum()))
        return Resampled(found, missing if missing.any() else None, filled if on_grid else 0)


@dataclass(frozen=True, eq=False)
class Resampled:
    """Values of each frame."""

    values: Floats  # (frames, channels), NaN in channels that have no value at all
    missing: Masks | None  # (frames, channels), in holes longer than `LONGEST_S`, if there are any
    filled: int  # number of missing values on the grid that were filled


def place_rows(times: ArrayLike, values: ArrayLike | None = None, *, fps: float = 0.0) -> Timing:
    """Return the rate of rows taken at these times, and the frame of each.

    ``times`` (rows,) are seconds in any order, NaN for a row without a time. ``values`` (rows,
    channels) tell apart sensors of several rates, and packets from duplicates. ``fps`` is inferred
    from the times unless given. Raise ParameterError if times are too few, equal, or no numbers.

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
        # Relative error of the duration by the limited precision of large times.
        doubt = 2 * np.spacing(np.abs(shown).max()) / duration
        fps = _round_rate(len(steps) / duration, max(1e-6, float(doubt)))
        return Timing(fps, clock=Clock.from_times(shown, fps))
    rows = np.flatnonzero(known)
    shown, taken = shown[rows], None if taken is None else taken[rows]
    at, was_set, notes = _correct_clock(shown, taken)
    if len(rows) < len(known):
        untimed = format_count(len(known) - len(rows), "row")
        notes.append(Note(f"{untimed} without a time left out"))
    if (np.diff(at) < 0).any():
        # A stable sort keeps the file order of rows with equal times.
        sequence = np.argsort(at, kind="stable")
        rows, at, shown = rows[sequence], at[sequence], shown[sequence]
        was_set = was_set[sequence]
        taken = None if taken is None else taken[sequence]
    ahead = shown - at  # constant unless the clock was reset
    if not at[-1] > at[0]:
        raise ParameterError(
            f"times do not increase: row 2 has {at[0]:g} s, as do all others; give fps= (--fps)"
        )
    steps = np.diff(at)
    is_new = np.append(True, steps > _SAME * np.median(steps[steps > 0]))
    if not is_new.all():  # times that differ by rounding are equal
        at = at[is_new][np.cumsum(is_new) - 1]
    at, note = _spread_packets(at, taken)
    notes += note
    moments, merged = (np.unique(at), None) if taken is None else _average_duplicates(at, taken)
    rate = fps or _find_fastest_rate(moments, merged)
    frames = _snap_to_grid((at - at[0]) * rate, rate)
    if not fps and (frames != np.rint(frames)).any():
        # rows are resampled anyway, and a whole rate is most likely the sensor's
        whole_rate = max(1.0, np.rint(rate))
        if abs(whole_rate - rate) <= _WHOLE * rate:
            rate, frames = whole_rate, _snap_to_grid((at - at[0]) * whole_rate, whole_rate)
    elif not fps:
        rate = _round_rate(rate, max(1e-6, UNEVEN / max(1.0, float(frames[-1]))))
    exact = bool((frames == np.rint(frames)).all())
    notes += _describe_timing(np.diff(moments), len(at) - len(moments), rate, exact=exact)
    # The limit on frames bounds memory: fewer frames for more channels.
    channels = 1 if taken is None else max(1, taken.shape[1])
    most = _MOST_FRAMES_PER_ROW * len(at) + _VALUES // channels
    timing = Timing(rate, rows, notes=tuple(notes))
    return _add_frames_and_clock(timing, frames, at, ahead, was_set, most)


def _is_even(times: Floats, steps: Floats) -> bool:
    """Return whether the times are even to a tenth of a period."""
    period = float(np.median(steps))
    if steps.min() <= 0:
        return False
    # Deviation from evenly spaced times; the mean removes the offset.
    drift = times - period * np.arange(len(times))
    return bool(
        np.abs(drift - drift.mean()).max() <= UNEVEN * period or np.ptp(steps) <= UNEVEN * period
    )


def _correct_clock(shown: Floats, values: Floats | None) -> tuple[Floats, Masks, list[Note | str]]:
    """Return times without jumps of the clock, a mask of rows after a reset, and notes."""
    steps, no_resets = np.diff(shown), np.zeros(len(shown), np.bool_)
    back = steps < 0
    rising = steps[steps > 0]
    usual = float(np.median(rising)) if len(rising) else 0.0
    if back.sum() > max(1, _FEW * len(steps)):  # rows are shuffled; the clock was not reset
        remark = "rows are not in order of time: sorted by their times"
        return shown, no_resets, [Note(remark, "warning")]

    tolerance = max(2 * usual, LONGEST_S)

    def near(by: float) -> Masks:
        return np.asarray(np.abs(steps - by - usual) <= tolerance)

    notes: list[Note | str] = []
    # A step forward is a pause unless it leads to a full hour of a clock that counts from 1970.
    forward = is_near_full_hour(shown[1:], tolerance) & is_unix_time(shown[0])
    hours = ((near(-_HOUR) & back) | (near(_HOUR) & forward)) & (usual < _HOUR / 10)
    days = near(-_DAY) & back
    if hours.any():
        cause = "as for summer time" if shown.max() >= _HOUR else "since they have no hours"
        notes.append(Note(f"local times jump by an hour, {cause}: corrected", "warning"))
    # Correction at each step; the cumulative sum applies it to all later rows.
    shift = np.where(hours, -_HOUR * np.sign(steps), np.where(days, _DAY, 0.0))
    at = shown + np.append(0.0, np.cumsum(shift)) if shift.any() else shown
    steps = np.diff(at)
    reset = steps < -LONGEST_S
    if not reset.any():
        if n_back := int((steps < 0).sum()):
            notes.append("1 step back in time" if n_back == 1 else "steps back in time")
        return at, no_resets, notes
    if not _was_clock_set(at, usual, values):
        return at, no_resets, [*notes, Note("rows are not in order of time: sorted", "warning")]
    # leave a gap of one frame: the true length is unknown
    at = at + np.append(0.0, np.cumsum(np.where(reset, 2 * usual - steps, 0.0)))
    times = format_count(int(reset.sum()), "time")
    notes.append(Note(f"the clock goes back {times}: the recording is split there", "warning"))
    return at, np.append(False, reset), notes


def _was_clock_set(at: Floats, usual: float, values: Floats | None) -> bool:
    """Return whether the clock was reset: sorting the rows by time would mix them up."""
    order = np.argsort(at, kind="stable")
    steps, before = np.diff(at[order]), np.diff(at)
    close = steps < 0.5 * usual
    if values is not None:
        # duplicate rows are no evidence
        one, other = values[order[:-1]], values[order[1:]]
        close &= ~((steps == 0) & ((one == other) | (np.isnan(one) & np.isnan(other))).all(axis=1))
    # Sorting a reset clock interleaves rows, which creates many short steps.
    crowded = int(close.sum()) - int((np.abs(before) < 0.5 * usual).sum())
    if crowded > 4 * int((before < -LONGEST_S).sum()):
        return True
    hole = max(LONGEST_S, 3 * usual)
    return not is_unix_time(at[0]) and (steps > hole).sum() > (before > hole).sum()


def _spread_packets(at: Floats, values: Floats | None) -> tuple[Floats, list[Note | str]]:
    """Return times with rows of a packet, which share one time, spread up to the next packet."""
    same = np.diff(at) == 0
    if same.mean() < _PACKETS:
        return at, []
    if values is not None:
        one, other = values[:-1][same], values[1:][same]
        differ = (np.isfinite(one) & np.isfinite(other) & (one != other)).any(axis=1)
        if differ.mean() < 0.1:  # duplicate rows, or several sensors at one time
            return at, []
    starts = np.append(np.flatnonzero(np.append(True, ~same)), len(at))
    sizes = np.diff(starts)
    begins = at[starts[:-1]]
    # seconds between rows in each packet, and the median
    period = np.append(np.diff(begins), np.nan) / sizes
    usual = float(np.nanmedian(period[1:])) if len(period) > 2 else float(period[0])
    # `fmin` ignores nan, and limits the period before a pause.
    period = np.fmin(period, 1.5 * usual)
    period[-1] = usual
    within = np.arange(len(at)) - np.repeat(starts[:-1], sizes)
    spread = np.repeat(begins, sizes) + within * np.repeat(period, sizes)
    if len(begins) > 1 and sizes[0] < np.median(sizes):  # recording began within a packet
        first = int(sizes[0])
        spread[:first] = begins[1] - usual * np.arange(first, 0, -1)
    count = format_count(int(same.sum()), "row")
    note = f"{count} with the same time as the row before: spread evenly up to the next time"
    return spread, [Note(note, "warning")]


def _find_fastest_rate(moments: Floats, values: Floats | None) -> float:
    """Return the rate of the rows, or of the fastest sensor if each fills only some rows."""
    every = _measure_rate(moments)
    if values is None:
        return every
    groups = (seen for _, seen in _group_by_missing_rows(np.isfinite(values)))
    rates = [_measure_rate(moments[seen]) for seen in groups if seen.sum() > 1]
    # A few values in quick succession may give more than the rate of all rows.
    return min(every, max(rates, default=every))


def _measure_rate(moments: Floats) -> float:
    """Return rows per second.

    Average the steps near the median: millisecond clocks give steps of 8 and 9 at 120 Hz, and
    lost rows give steps of several periods. If these do not add up to the duration, as when one
    row in three is late, average all steps but holes.
    """
    steps = np.diff(moments)
    median = float(np.median(steps))
    counted = steps[steps <= max(LONGEST_S, 3 * median)]
    ordinary = counted[np.abs(counted - median) <= _ORDINARY * median * (1 + 1e-9)]
    if len(ordinary) >= _MOST * len(counted):
        period = float(ordinary.mean())
        n_periods = float(np.maximum(np.rint(counted / period), 1).sum())
        if abs(period * n_periods - counted.sum()) <= _ADDS_UP * counted.sum():
            return n_periods / float(counted.sum())
    return len(counted) / float(counted.sum())


def _snap_to_grid(frames: Floats, fps: float) -> Floats:
    """Return whole frames if rows are regular between holes, else the frames unchanged.

    After a pause rows may be off the grid by a constant fraction of a frame, which is removed.
    """
    # Number the parts between holes, and measure frames from the first of each part.
    part = np.append(0, np.cumsum(np.diff(frames) > LONGEST_S * fps + 1))
    firsts = np.flatnonzero(np.diff(part, prepend=-1))
    since = np.rint(frames - frames[firsts][part])
    # Mean offset of each part from whole frames.
    ahead = np.bincount(part, frames - since) / np.bincount(part)
    if np.abs(frames - since - ahead[part]).max() > 2 * UNEVEN:
        return frames
    snapped = since + np.rint(ahead)[part]
    # rows of neighbouring parts must not share a frame
    if (np.diff(snapped)[np.diff(frames) > 0.5] <= 0).any():
        return frames
    return np.asarray(snapped - snapped[0], np.float64)


def _round_rate(fps: float, share: float) -> float:
    """Return the rate rounded to hertz or thousandths if within this fraction of it."""
    rounded_rates = (round(fps, digits) for digits in (0, 3))
    return next(
        (rate for rate in rounded_rates if rate > 0 and abs(fps - rate) <= share * fps), fps
    )


def _describe_timing(steps: Floats, doubled: int, fps: float, *, exact: bool) -> list[Note | str]:
    """Return a note on uneven times; ``exact`` if all rows are at whole frames."""
    counts = [
        (doubled, "row", "with the same time as another"),
        (int((steps * fps > 1.5).sum()), "step", "longer than a frame and a half"),
    ]
    parts = [f"{format_count(n, one)} {what}" for n, one, what in counts if n]
    if exact and not parts:
        return []
    return [f"times are uneven ({', '.join(parts) or 'jitter'}): resampled to {fps:g} Hz"]


def _add_frames_and_clock(
    timing: Timing,
    frames: Floats,
    seconds: Floats,
    clock_offset: Floats,
    was_reset: Masks,
    max_frames: int,
) -> Timing:
    """Return the timing with the frames of its rows, gaps, and clock.

    Arrays have a value per row, in time order: ``frames`` (fractional), ``seconds``,
    ``clock_offset`` (time in the file minus seconds), and ``was_reset``, true for the first row
    after the clock went back. Pauses are shortened to fit into ``max_frames``.
    """
    rate, notes = timing.fps, list(timing.notes)
    frames, cut = _shorten_pauses(frames, max_frames)
    if cut.any():
        k = int(cut.argmax())
        pause_s = seconds[k + 1] - seconds[k]
        text = (
            f"{format_count(int(cut.sum()), 'pause')}, the first of {pause_s:.4g} "
            f"s after second {frames[k] / rate:.4g}: the recording is split there, and its "
            "duration does not include pauses"
        )
        notes.append(Note(text, "warning"))
    # The clock has one span from each row at which it jumps against the recording.
    jumps = np.flatnonzero(cut | (np.abs(np.diff(clock_offset)) > LONGEST_S)) + 1
    starts = np.append(0, jumps)
    start_times = (seconds + clock_offset)[starts]
    clock = None
    # No clock if the times in the file are the seconds of the recording.
    if len(starts) > 1 or abs(start_times[0]) > 0.5 / rate:
        clock = Clock((frames[starts] / rate).tolist(), start_times.tolist())
    # A gap holds the whole frames strictly between the two rows at a split.
    splits = np.flatnonzero(cut | was_reset[1:])
    gap_starts = np.floor(frames[splits]).astype(np.int64) + 1
    gap_stops = np.ceil(frames[splits + 1]).astype(np.int64)
    gaps = zip(gap_starts.tolist(), gap_stops.tolist(), strict=True)
    return replace(
        timing,
        at=frames,
        n_frames=int(np.floor(frames[-1] + UNEVEN)) + 1,
        gaps=tuple((start, stop) for start, stop in gaps if start < stop),
        notes=tuple(notes),
        clock=clock,
    )


def _shorten_pauses(frames: Floats, most: int) -> tuple[Floats, Masks]:
    """Return frames with the longest pauses cut to fit into ``most``, and a mask of these."""
    steps = np.diff(frames)
    cut = np.zeros(len(steps), np.bool_)
    excess = frames[-1] - most
    if excess > 0:
        longest = np.argsort(-steps, kind="stable")
        # Frames saved by cutting the n longest pauses; two remain of each.
        saved = np.cumsum(np.floor(steps[longest]) - 2)
        count = int(np.searchsorted(saved, excess)) + 1
        if count > len(steps) or steps[longest[count - 1]] <= 3:
            raise ParameterError(
                "the frame rate cannot be inferred from the times: give fps= (--fps)"
            )
        cut[longest[:count]] = True
        # remove whole frames, so that rows stay on the grid
        frames = frames - np.append(0.0, np.cumsum(np.where(cut, np.floor(steps) - 2, 0.0)))
    return frames, cut


def _average_duplicates(at: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return each time once, and the mean values of rows with that time."""
    # First row of each distinct time; `reduceat` sums the rows up to the next start.
    starts = np.flatnonzero(np.diff(at, prepend=-np.inf) > 0)
    if len(starts) == len(at):
        return at, values
    present = np.isfinite(values)
    counts = np.add.reduceat(present, starts, axis=0, dtype=np.float64)
    sums = np.add.reduceat(np.where(present, values, 0.0), starts, axis=0)
    with np.errstate(invalid="ignore"):
        return at[starts], sums / counts


def _group_by_missing_rows(present: Masks) -> Iterator[tuple[list[int], Masks]]:
    """Yield groups of channels with values in the same rows, and a mask of these rows."""
    found: dict[bytes, list[int]] = {}
    for channel in range(present.shape[1]):
        found.setdefault(np.packbits(present[:, channel]).tobytes(), []).append(channel)
    for channels in found.values():
        yield channels, present[:, channels[0]]


def find_longest_filled(steps: Floats, fps: float) -> float:
    """Return the longest hole of a channel that is filled, in frames.

    ``steps`` are those from one of its values to the next.
    """
    longest = LONGEST_S * fps + 1e-9
    # A channel may be slower than the others but regular: then allow 2.5 of its own steps.
    # With fewer steps the median says little, and one value per frame is expected.
    usual = float(np.median(steps)) if len(steps) >= RATE_STEPS else 1.0
    is_slow = 1.5 < usual <= _SLOWEST_S * fps
    if is_slow and (np.abs(steps - usual) <= _ORDINARY * usual).mean() > _MOST:
        longest = max(longest, 2.5 * usual)
    return longest


def _find_holes(known_frames: Floats, n_frames: int, fps: float) -> NDArray[np.int64]:
    """Return the holes (holes, 2): frames [start, stop) between known frames too far apart."""
    max_step = find_longest_filled(np.diff(known_frames), fps)
    # Frames within half a frame of a known one count as known. -1 and n_frames enclose them all.
    ends = np.concatenate([[-1.0], known_frames, [float(n_frames)]])
    starts = np.floor(ends[:-1] + 0.5).astype(np.int64) + 1
    stops = np.minimum(np.ceil(ends[1:] - 0.5).astype(np.int64), n_frames)
    is_hole = np.diff(ends) - 1 > max_step
    spans = np.column_stack([np.maximum(starts, 0), stops])[is_hole]
    return spans[spans[:, 0] < spans[:, 1]]


def fill_gaps_in_channels(
    timing: Timing, values: Floats, names: Sequence[str]
) -> tuple[Floats, tuple[str, ...], tuple[tuple[int, int], ...], list[Note | str]]:
    """Return finite values of each frame, the names of their channels, the gaps, and notes.

    A frame lies in a gap if any channel is missing for long. A channel that is missing in most
    frames is left out. Raise ParameterError if a channel has no number, or nothing is left between
    the gaps.
    """
    resampled = timing.resample(values)
    doubts = find_faulty_channels(resampled, timing.fps, names)
    notes: list[Note | str] = []
    if resampled.filled:
        values_filled = format_count(resampled.filled, "missing value")
        notes.append(f"{values_filled} interpolated linearly")
    if resampled.missing is None:
        return resampled.values, tuple(names), timing.gaps, [*notes, *doubts]
    jumps = mark_spans(timing.gaps, len(resampled.values))
    for name, channel_missing in zip(names, resampled.missing.T, strict=True):
        if channel_missing.all():
            raise ParameterError(
                f"column {name!r} contains no numbers: name the other columns (--columns)"
            )
    # Frames without any channel say nothing about single ones.
    recorded = ~resampled.missing.all(axis=1)
    shares = resampled.missing[recorded].mean(axis=0)
    sparse = shares > _MISSING
    if sparse.any() and not sparse.all():
        left_out = [name for name, out in zip(names, sparse, strict=True) if out]
        others = [name for name, out in zip(names, sparse, strict=True) if not out]
        found, kept, gaps, notes = fill_gaps_in_channels(timing, values[:, ~sparse], others)
        remark = "channels without values most of the time are left out: "
        notes = [Note(remark + join_names(left_out, most=4), "warning"), *notes]
        return found, kept, gaps, notes
    long = resampled.missing.any(axis=1)
    if (long | jumps).all():
        raise ParameterError(
            "every frame lacks some channel for too long: choose columns with fewer gaps "
            "(--columns)"
        )
    # Gaps where the clock was reset are reported already.
    holes = find_spans(long & ~jumps)
    if len(holes):
        frames = format_count(int((long & ~jumps).sum()), "frame")
        notes.append(f"{format_count(len(holes), 'gap')} of more than {LONGEST_S:g} s, {frames}")
    lost = int((long & recorded).sum())
    if lost > _LOST * recorded.sum():
        worst = [f"{names[i]} ({shares[i]:.0%})" for i in np.argsort(-shares) if shares[i] > 0]
        remark = (
            f"{lost / timing.fps:.4g} of {recorded.sum() / timing.fps:.4g} s are gaps, as single "
            f"channels have no values there: {join_names(worst, most=4)}; choose other columns "
            "(--columns)"
        )
        notes.append(Note(remark, "warning"))
    return resampled.values, tuple(names), list_spans(long | jumps), [*notes, *doubts]


def find_faulty_channels(
    resampled: Resampled, fps: float, names: Sequence[str]
) -> list[Note | str]:
    """Return warnings about channels that freeze for seconds or are clipped."""
    frozen, clipped = [], []
    least = max(2, round(FROZEN_S * fps))
    for channel, name in enumerate(names):
        track = resampled.values[:, channel]
        if resampled.missing is not None:
            track = track[~resampled.missing[:, channel]]
        if len(track) < 2:
            continue
        same = np.diff(track) == 0
        runs = find_spans(same)
        lengths = runs[:, 1] - runs[:, 0]
        long = lengths >= least
        others = len(same) - int(lengths[long].sum())
        if long.any() and others >= least and lengths[~long].sum() <= (1 - _CHANGES) * others:
            first = runs[long][0]
            seconds = int(lengths[long].max()) / fps
            frozen.append(f"{name} ({seconds:.3g} s at {first[0] / fps:.4g} s)")
        if _is_clipped(track, runs[~long]):
            clipped.append(name)
    remarks = {
        "channels that stay constant for a while": frozen,
        "channels clipped at their largest values": clipped,
    }
    return [Note(f"{remark}: {join_names(named, most=4)}", "warning")
            for remark, named in remarks.items() if named]  # fmt: skip


def _is_clipped(track: Floats, runs: NDArray[np.intp]) -> bool:
    """Return whether runs of successive values often equal the maximum or minimum."""
    # a slower sensor repeats its values for some rows: these count once
    held = round(len(track) / max(1, len(track) - int((runs[:, 1] - runs[:, 0]).sum())))
    long = runs[runs[:, 1] - runs[:, 0] >= _CLIPPED * held - 1]
    if len(long) < 2:
        return False
    firsts = long[:, 0]
    ends, lengths = track[firsts], long[:, 1] - long[:, 0] + 1
    # A smooth peak in coarse steps is flat, too, but values approach it step by step.
    entries = np.abs(ends - track[np.maximum(firsts - 1, 0)])
    moves = np.abs(np.diff(track))
    coarse = _COARSE * float(moves[moves > 0].min(initial=np.inf))
    low, middle, high = np.percentile(track, (25, 50, 75))
    for limit in (track.min(), track.max()):
        cut = ends == limit
        often = int(lengths[cut].sum()) >= _CLIPS * len(track) and cut.sum() > 1
        far = abs(limit - middle) > high - low > 0  # excludes resting values, such as zero force
        if often and far and np.median(entries[cut]) >= coarse:
            return len(np.unique(track)) >= _LEVELS
    return False
