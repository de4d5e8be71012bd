"""Resample rows with arbitrary times to frames at one rate, as the rows arrive.

`kineme.recordings.regular` does this for files; here only the rows of the last half second are
known. Rows with equal times are averaged, packets of rows that share a time are spread. Holes of up
to 0.2 s are interpolated linearly, longer ones become gaps. A channel that is slower than the
others repeats its last value: if it is regular, for as long as it is filled in files. If the clock
is set back, the stream continues after a gap of one frame.

The frames do not depend on how many rows are added at a time: they are made in blocks, and a block
waits for the rows of the 0.2 s after it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import ceil, floor, log10

import numpy as np

from kineme._util.arrays import Floats, Masks
from kineme.recordings.regular import (
    LONGEST_S,
    RATE_STEPS,
    UNEVEN,
    Timing,
    find_longest_filled,
)
from kineme.recordings.times import UNITS_OF_TIME, Clock, is_near_full_hour, is_unix_time

BLOCK_S = 0.1
"""Seconds of frames that are made at once."""
SUDDEN_S = 2.0
"""Seconds: a longer step of the clock must be confirmed by the next row."""
COUNTED_S = 2.0
"""Seconds over which rows are counted to check the given rate."""
ABSENT_S = 2.0
"""Seconds without a value after which a channel is left out."""
OTHER_RATE = 1.5
"""Ratio from which two rates count as different."""
UNIT_ROWS, UNIT_STEPS = 20, 3
"""Rows, and steps of their times, from which the unit of the times is guessed."""
FULL_PACKET = 0.75, 1.5
"""Frames per row of a packet. Below the range rows are duplicates, above it some are lost."""
SHIFTS_S = (-86400.0, -3600.0, 3600.0)
"""Seconds: steps of local clocks (midnight, summer time) that are undone.

A step forward is a pause unless it leads to a full hour of a clock that counts from 1970.
"""


@dataclass(frozen=True, eq=False)
class Frames:
    """Consecutive frames (frames, channels), and which of them are missing."""

    values: Floats
    missing: Masks


@dataclass(frozen=True)
class Hole:
    """A number of frames without any row."""

    n_frames: int


Piece = Frames | Hole | str
"""Output of `Intake`. A string is a message about the rows."""


@dataclass
class Intake:
    """Rows that are not frames yet, and the state of their clock."""

    fps: float
    channels: Sequence[str]
    n_rows: int = 0  # rows without a time so far
    per_second: float = 0.0  # units of the times per second; 0 while the unit is unknown
    ahead_s: float = 0.0  # seconds by which the clock is ahead of the stream
    last_s: float = np.nan  # time of the last row; nan before the first row
    # (spans, 2): second of the stream from which the clock runs without a step, and its time there.
    clock_spans: Floats = field(default_factory=lambda: np.empty((0, 2)))
    emitted: int = 0  # next frame
    run_start: int = 0  # first frame after the last hole
    # Frames and rows since the rate was last checked, and whether it differed then.
    counted: int = 0
    counted_rows: int = 0
    other_rate: bool = False
    in_packets: bool = False  # whether the last rows with equal times were a packet
    said: list[str] = field(default_factory=list)  # messages that were sent already
    # Fractional frame (rows,) and values (rows, channels) of each row that is still needed.
    at: Floats = field(default_factory=lambda: np.empty(0))
    rows: Floats = field(default_factory=lambda: np.empty((0, 0)))
    # Rows whose time can only be interpreted with the next row.
    held_times: Floats = field(default_factory=lambda: np.empty(0))
    held_rows: Floats = field(default_factory=lambda: np.empty((0, 0)))
    filler: Floats = field(default_factory=lambda: np.empty(0))  # values of the last frame
    # Whether each channel has values, and the frames of its last ones, nan if it had fewer.
    seen: Masks = field(default_factory=lambda: np.empty(0, np.bool_))
    last_at: Floats = field(default_factory=lambda: np.empty((0, 0)))

    def __post_init__(self) -> None:
        if not self.filler.size:
            self.filler = np.zeros(len(self.channels))
            self.seen = np.zeros(len(self.channels), np.bool_)
            self.rows = self.held_rows = np.empty((0, len(self.channels)))
        if not self.last_at.size:
            self.last_at = np.full((len(self.channels), RATE_STEPS + 1), np.nan)

    def add(self, rows: Floats, times: Floats | None = None) -> list[Piece]:
        """Add rows (rows, channels), nan where missing; return the frames that are now complete.

        ``times`` are in any unit since any origin.
        """
        pieces: list[Piece] = []
        if times is None:
            self._append(self.n_rows + np.arange(len(rows), dtype=np.float64), rows)
            self.n_rows += len(rows)
        else:
            rows = np.concatenate([self.held_rows, rows])
            times = np.concatenate([self.held_times, times])
            self._place(rows, times, pieces)
        self._emit(pieces)
        return pieces

    def finish(self) -> list[Piece]:
        """Return the frames of all remaining rows."""
        pieces: list[Piece] = []
        if len(self.held_times):
            self.per_second = self.per_second or guess_unit(self.held_times, self.fps)
            # An extra row confirms the time of a single held row.
            times = np.append(self.held_times, self.held_times[-1])
            nothing = np.full((1, len(self.channels)), np.nan)
            self._place(np.concatenate([self.held_rows, nothing]), times, pieces)
        if self.in_packets:
            self._spread_packet(float(self.at[-1]) + np.inf)
        self._emit(pieces, finished=True)
        return pieces

    def make_clock(self) -> Clock | None:
        """Return the clock of the times; None if they are the seconds of the stream."""
        seconds, times = self.clock_spans.T.tolist()
        if len(times) > 1 or any(abs(time) > 0.5 / self.fps for time in times):
            return Clock(seconds, times)
        return None

    def _place(self, rows: Floats, times: Floats, pieces: list[Piece]) -> None:
        """Find the frame of each row; hold rows whose time needs the next row."""
        self.held_rows, self.held_times = rows[:0], times[:0]
        known = np.isfinite(times)
        if not known.all():
            self._say(pieces, "rows without a time are left out")
            rows, times = rows[known], times[known]
        if not self.per_second:
            needed = count_rows_for_unit(times)
            if not needed:
                self.held_rows, self.held_times = rows, times
                return
            # Exactly these rows, so that the unit does not depend on how many come at a time.
            self.per_second = guess_unit(times[:needed], self.fps)
        start = 0
        while start < len(times):
            seconds = times[start:] / self.per_second - self.ahead_s
            if np.isnan(self.last_s):  # the first row is at frame 0
                self.last_s = 0.0
                self._set_clock(float(seconds[0]), 0.0)
                self._append(np.zeros(1), rows[start : start + 1])
                start += 1
                continue
            steps = np.diff(seconds, prepend=self.last_s)
            odd = (steps * self.fps <= UNEVEN) | (steps > SUDDEN_S)
            count = int(odd.argmax()) if odd.any() else len(seconds)
            if not count:
                placed = self._place_odd(seconds, rows[start], pieces)
                if placed is None:
                    self.held_rows, self.held_times = rows[start:], times[start:]
                    return
                count = placed
            else:
                self._append(seconds[:count] * self.fps, rows[start : start + count])
                self.last_s = float(seconds[count - 1])
            start += count

    def _place_odd(self, seconds: Floats, row: Floats, pieces: list[Piece]) -> int | None:
        """Handle a row whose time repeats, decreases or jumps; return how many rows are done.

        None if the next row is needed first; 0 if the clock was corrected instead.
        """
        step = float(seconds[0]) - self.last_s
        if abs(step) * self.fps <= UNEVEN:
            self._append(self.at[-1:], row[None])
            return 1
        if -LONGEST_S <= step < 0:
            self._say(pieces, "rows older than the row before are left out")
            return 1
        if len(seconds) == 1:
            return None
        if abs(seconds[1] - seconds[0]) >= abs(seconds[1] - self.last_s):
            self._say(pieces, "single rows whose time differs from all others are left out")
            return 1
        if self._correct_clock(step, pieces):
            return 0
        self._append(seconds[:1] * self.fps, row[None])
        self.last_s = float(seconds[0])
        return 1

    def _correct_clock(self, step: float, pieces: list[Piece]) -> bool:
        """Undo a step of the clock if it was set; return whether it was."""
        near = max(LONGEST_S, 3 / self.fps)
        now_s = self.last_s + self.ahead_s + step
        is_on_the_hour = is_unix_time(now_s) and is_near_full_hour(now_s, near)
        for shift in SHIFTS_S:
            if abs(step - shift) <= near and (shift < 0 or is_on_the_hour):
                self._say(pieces, "the clock changes by an hour or a day: corrected")
                self._set_clock(self.ahead_s + shift, self.last_s + 1 / self.fps)
                return True
        if step < 0:
            pieces.append(f"the clock goes back by {-step:.4g} s: the stream continues after a gap")
            # Far enough from the last row to make a gap.
            hole = LONGEST_S + 2 / self.fps
            self._set_clock(self.ahead_s + step - hole, self.last_s + hole)
        return step < 0

    def _set_clock(self, ahead_s: float, second: float) -> None:
        """Store by how much the clock is ahead from a second of the stream on."""
        self.ahead_s = ahead_s
        before = self.clock_spans[self.clock_spans[:, 0] < second]
        self.clock_spans = np.concatenate([before, [[second, second + ahead_s]]])

    def _append(self, at: Floats, rows: Floats) -> None:
        """Store rows that have a frame; spread the packet before them."""
        if len(self.at) and at[0] > self.at[-1]:
            self._spread_packet(float(at[0]))
        self.at = np.append(self.at, at)
        self.rows = np.concatenate([self.rows, rows])

    def _spread_packet(self, next_at: float) -> None:
        """Spread the last rows if they share a frame and fill the time up to the next row."""
        first = int(np.searchsorted(self.at, self.at[-1]))
        size = len(self.at) - first
        each = (next_at - float(self.at[-1])) / size
        if size > 1:
            self.in_packets = each >= FULL_PACKET[0]
            if self.in_packets:
                self.at[first:] += np.arange(size) * (each if each <= FULL_PACKET[1] else 1.0)

    def _emit(self, pieces: list[Piece], *, finished: bool = False) -> None:
        """Output the frames that no later row can change."""
        after = ceil(LONGEST_S * self.fps) + 2
        block = max(1, round(BLOCK_S * self.fps))
        while len(self.at):
            holes = np.flatnonzero(np.diff(self.at) - 1 > LONGEST_S * self.fps + 1e-9)
            stop = self.emitted + block
            if len(holes) or finished:
                last = self.at[holes[0]] if len(holes) else self.at[-1]
                end = floor(float(last) + 0.5) + 1
                if self.emitted < end:
                    stop = min(stop, end)
                    pieces.append(self._make(stop, min(stop + after, end), after, pieces))
                elif len(holes):
                    self._leap(int(holes[0]) + 1, pieces)
                else:
                    return
            elif self.at[-1] >= stop + after:
                pieces.append(self._make(stop, stop + after, after, pieces))
            else:
                return

    def _leap(self, row: int, pieces: list[Piece]) -> None:
        """Continue with a row after a hole."""
        self.at, self.rows = self.at[row:], self.rows[row:]
        begin = ceil(float(self.at[0]) - 0.5)
        if begin > self.emitted:
            pieces.append(Hole(begin - self.emitted))
        self.emitted = self.run_start = max(begin, self.emitted)
        self.counted = self.counted_rows = 0

    def _make(self, stop: int, end: int, before: int, pieces: list[Piece]) -> Frames:
        """Return the frames up to `stop`, computed from the rows up to `end`."""
        base = max(self.emitted - before, self.run_start)
        first, last = np.searchsorted(self.at, [base - 0.5, end])
        at, rows = self.at[first:last] - base, self.rows[first:last]
        near = np.rint(at)
        at = np.where(np.abs(at - near) <= UNEVEN, near, at)
        found = Timing(self.fps, np.arange(len(at)), at, end - base).resample(rows)
        made = slice(self.emitted - base, stop - base)
        values = found.values[made].copy()
        self.seen = self.seen | np.isfinite(values).any(axis=0)
        inside = (self.at >= self.emitted - 0.5) & (self.at < stop - 0.5)
        for frame, row in zip(self.at[inside], self.rows[inside], strict=True):
            has_value = np.isfinite(row)
            self.last_at[has_value, :-1] = self.last_at[has_value, 1:]
            self.last_at[has_value, -1] = frame
        missing: Masks = np.zeros(len(values), np.bool_)
        if found.missing is not None:
            missing = self._find_gaps(found.missing[made], pieces)
            for i, row in enumerate(values):  # A channel without a value repeats its last one.
                row[:] = np.where(np.isfinite(row), row, values[i - 1] if i else self.filler)
        self.filler = values[-1]
        self._compare_rate(stop - self.emitted, int(inside.sum()), pieces)
        self.emitted = stop
        kept = max(0, int(np.searchsorted(self.at, stop - before)) - 1)
        self.at, self.rows = self.at[kept:], self.rows[kept:]
        return Frames(values, missing)

    def _find_gaps(self, holes: Masks, pieces: list[Piece]) -> Masks:
        """Return the frames in a gap; ``holes`` (frames, channels) are longer than `LONGEST_S`."""
        frames = self.emitted + np.arange(len(holes))
        gaps = np.asarray(holes.all(axis=1))
        for channel in np.flatnonzero(holes.any(axis=0) & self._report_absent(pieces)):
            if not self.seen[channel]:
                gaps |= holes[:, channel]
                continue
            # Steps are nan until the rate of the channel is known.
            steps = np.diff(self.last_at[channel])
            usual, longest = np.median(steps), find_longest_filled(steps, self.fps)
            if usual >= longest:
                continue  # it has values in few rows, and none is expected
            since = frames - self.last_at[channel, -1]
            patience = max(longest, ABSENT_S * self.fps)
            if np.isnan(usual):
                patience *= 2.5  # it may be as slow as any channel that is filled
            else:
                is_fast = longest < LONGEST_S * self.fps + 1
                gaps |= holes[:, channel] & ((since > longest) | is_fast)
            if since[-1] > patience and not holes.all():
                # Its sensor is off: it counts as one that never had a value.
                self.seen[channel], self.last_at[channel] = False, np.nan
        return gaps

    def _report_absent(self, pieces: list[Piece]) -> Masks:
        """Report channels without a value; return those that make a gap where they are missing."""
        if self.emitted < ABSENT_S * self.fps or not self.seen.any() or self.seen.all():
            return np.ones_like(self.seen)
        for name, seen in zip(self.channels, self.seen.tolist(), strict=True):
            if not seen:
                self._say(pieces, f"channel {name} has no value: left out until it has one")
        return self.seen

    def _compare_rate(self, n_frames: int, n_rows: int, pieces: list[Piece]) -> None:
        """Report when rows begin to arrive at another rate than the given one."""
        self.counted += n_frames
        self.counted_rows += n_rows
        if self.counted < COUNTED_S * self.fps:
            return
        rate = self.counted_rows / self.counted * self.fps
        other = not 1 / OTHER_RATE < rate / self.fps < OTHER_RATE
        if other and not self.other_rate:
            pieces.append(f"rows come at about {rate:.3g} Hz instead of {self.fps:g} Hz")
        self.counted, self.counted_rows, self.other_rate = 0, 0, other

    def _say(self, pieces: list[Piece], text: str) -> None:
        if text not in self.said:
            self.said.append(text)
            pieces.append(text)


def count_rows_for_unit(times: Floats) -> int:
    """Return how many of the first rows tell the unit of their times; 0 if there are too few."""
    changes = np.flatnonzero(np.diff(times))
    if len(times) < UNIT_ROWS or len(changes) < UNIT_STEPS:
        return 0
    return max(UNIT_ROWS, int(changes[UNIT_STEPS - 1]) + 2)


def guess_unit(times: Floats, fps: float) -> float:
    """Return the units per second for which rows at these times are usually a frame apart.

    1 if the times are equal.

    Examples
    --------
    >>> guess_unit(np.array([0, 700, 720, 740, 760]) + 81_000_000, 50.0)
    1000.0
    """
    steps = np.diff(times)
    changes = np.flatnonzero(steps)
    if not len(changes):
        return 1.0
    # Rows that share a time are a packet: its rows divide the step to the next time.
    sizes = np.diff(changes, prepend=-1)
    frames = fps * float(np.median(np.repeat(np.abs(steps[changes]) / sizes, sizes)))
    per_second = sorted(set(UNITS_OF_TIME.values()))
    return min(per_second, key=lambda unit: abs(log10(frames / unit)))
