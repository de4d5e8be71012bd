"""Segment a recording while it is made: rows in, events out."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from os import PathLike
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats, Masks
from kineme._util.checks import as_floats, as_texts, check_type, is_number, join_names
from kineme._util.json import options_from_json, options_to_json
from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.live.events import (
    ActivityEnded,
    ActivityStarted,
    Event,
    Finals,
    Gap,
    Look,
    Looks,
    Notice,
    Row,
)
from kineme.live.intake import Frames, Hole, Intake, Piece
from kineme.live.looking import Layout, RecentPast, choose_options
from kineme.live.storage import Announced, StreamState, load_state, save_state
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals, Skeleton
from kineme.recordings.arrays import as_rate
from kineme.recordings.column_names import name_column
from kineme.recordings.operations import resample
from kineme.recordings.times import UNITS_OF_TIME, as_seconds
from kineme.segments.segmentation import Segmentation, check_same_length

PIECE = 1000
"""Rows that are processed at once if many are pushed."""
PART_COUNTED = 0.75
"""Share of the usual length at which the current repetition is announced."""


class Stream:
    """Segment rows as they arrive.

    Parameters
    ----------
    fps : float
        Frames per second of the stream. Rows with times are resampled to this rate.
    channels : sequence of str, optional
        Names of the channels of sensors.
    skeleton : Skeleton, optional
        Skeleton of a body. Rows are then the positions of its joints in metres, y up.
    delay : float
        Seconds after which the start of an activity is final at the earliest, and with it the end
        and the repetitions of the activity before. A shorter delay makes more errors.
    memory : float
        Seconds of the recent past that are segmented each time.
    interval : float
        Seconds between two segmentations of the recent past.
    known : (recording, segments), optional
        An earlier result with the same channels or joints. Clusters that are recognised keep
        their numbers and labels.
    **options
        Options of `kineme.segment`: ``preset``, ``effectors``, ``emg``, constants of the preset.

    Raises
    ------
    ParameterError
        Neither channels nor a skeleton, or both; an invalid value of an option; an earlier result
        that does not fit.

    Examples
    --------
    >>> import numpy as np
    >>> import kineme
    >>> stream = kineme.Stream(fps=50, channels=["x", "y"])
    >>> angle = np.linspace(0, 30 * np.pi, 1500)
    >>> events = stream.push(np.column_stack([np.sin(angle), np.cos(angle)]))
    >>> events += stream.finish()
    >>> events[-1].repetitions
    15
    """

    def __init__(
        self,
        *,
        fps: float,
        channels: Sequence[str] | None = None,
        skeleton: Skeleton | None = None,
        delay: float = 5.0,
        memory: float = 40.0,
        interval: float = 2.0,
        known: tuple[Motion | Signals, Segmentation] | None = None,
        **options: Any,
    ) -> None:
        if (channels is None) == (skeleton is None):
            raise ParameterError("give a stream channels=[names] or skeleton=")
        names = () if channels is None else as_texts(channels, "names of channels")
        if channels is not None and not names:
            raise ParameterError("a stream has at least one channel")
        if skeleton is not None:
            check_type(skeleton, Skeleton, "Stream", "motion.skeleton is one")
        for name, seconds in (("delay", delay), ("memory", memory), ("interval", interval)):
            if not (is_number(seconds) and seconds > 0):
                raise ParameterError(f"{name} must be a number above 0, not {seconds!r:.60}")
        if memory < 2 * (delay + interval):
            raise ParameterError(
                f"memory is {memory:g} s: give at least twice delay plus interval, "
                f"{2 * (delay + interval):g} s"
            )
        layout = Layout(as_rate(fps), names, skeleton)
        chosen = SegmentOptions.of(**options)
        if chosen.features is not None:
            raise ParameterError("features= cannot be used with a stream: push them as channels")
        looked = choose_options(chosen, signals=skeleton is None)
        self.fps, self.delay, self.memory, self.interval = layout.fps, delay, memory, interval
        self.layout, self.options = layout, chosen
        self._state = StreamState(
            Intake(self.fps, layout.value_names),
            Finals(self.fps),
            RecentPast(layout, looked),
            next_look=self._frames(interval),
        )
        if known is not None:
            self._remember(known)

    def __repr__(self) -> str:
        what = f"{self.layout.n_values} channels"
        if self.layout.skeleton is not None:
            what = f"{self.layout.skeleton.n_joints} joints"
        return f"<Stream of {what} at {self.fps:g} Hz, second {self._state.now / self.fps:.1f}>"

    def push(
        self, values: ArrayLike, times: ArrayLike | None = None, *, unit: str | None = None
    ) -> list[Event]:
        """Add rows; return the new events.

        Parameters
        ----------
        values : (channels,), (rows, channels) or (rows, joints, 3) array_like or data frame
            NaN where a value is missing. Columns of a data frame are taken by their names.
        times : (rows,) array_like, optional
            Time of each row: numbers in any unit since any origin, dates, or texts.
            Without times, rows are frames at `fps`.
        unit : str, optional
            Unit of numbers: ``"s"``, ``"ms"``, ``"us"`` or ``"ns"``. By default it follows from
            the steps of the first 20 rows, which are held back until then.

        Returns
        -------
        list of Event
            They do not depend on how many rows are pushed at a time.

        Raises
        ------
        ParameterError
            Rows of the wrong shape or without a channel, invalid times, or an unknown unit. The
            stream continues without them.
        """
        if self._state.is_finished:
            raise ParameterError("the stream is finished: make a new one")
        rows = self._as_rows(values)
        seconds, is_in_seconds = None, False
        if times is not None:
            seconds, is_in_seconds = _as_numbers(times, unit)
            if len(seconds) != len(rows):
                raise ParameterError(f"there are {len(rows)} rows and {len(seconds)} times")
        if not len(rows):
            return []
        if self._state.is_timed not in (None, seconds is not None):
            raise ParameterError("either all rows of a stream have times or none")
        self._state.is_timed = seconds is not None
        if is_in_seconds:
            self._state.intake.per_second = 1.0
        events: list[Event] = []
        for first in range(0, len(rows), PIECE):
            piece = slice(first, first + PIECE)
            part = None if seconds is None else seconds[piece]
            events += self._absorb(self._state.intake.add(rows[piece], part))
        return events

    def _as_rows(self, values: ArrayLike) -> Floats:
        """Return rows as a (rows, values) array, with NaN for every value that is not finite."""
        n_values = self.layout.n_values
        rows = as_floats(_select_channels(values, self.layout.value_names), "rows")
        joints = self.layout.skeleton and (self.layout.skeleton.n_joints, 3)
        if not rows.size:
            return np.empty((0, n_values))
        fits = rows.shape[-1:] == (n_values,) and rows.ndim <= 2
        if not (fits or (rows.ndim == 1 and n_values == 1) or rows.shape[-2:] == joints):
            raise ParameterError(f"rows have {n_values} values each, not shape {rows.shape}")
        return np.where(np.isfinite(rows), rows, np.nan).reshape(-1, n_values)

    def finish(self) -> list[Event]:
        """End the stream; return the last events. All segments are final then."""
        if self._state.is_finished:
            return []
        events = self._absorb(self._state.intake.finish())
        self._state.is_finished = True
        self._end_gap(self._state.now, events)
        return events + self._settle()

    @property
    def is_finished(self) -> bool:
        """Return whether the stream has ended.

        Examples
        --------
        >>> Stream(fps=50, channels=["x"]).is_finished
        False
        """
        return self._state.is_finished

    def frames(self, first: int = 0) -> tuple[int, Floats]:
        """Return the frames of the recent past from a given frame on.

        Parameters
        ----------
        first : int
            Frame of the stream.

        Returns
        -------
        first : int
            The first frame that is returned: a later one if older frames were dropped.
        frames : (frames, values) array
            NaN where nothing was recorded.

        Examples
        --------
        >>> stream = Stream(fps=50, channels=["x"])
        >>> events = stream.push(np.zeros((50, 1)))
        >>> start, frames = stream.frames(40)
        >>> start + len(frames) <= 50
        True
        """
        past = self._state.past
        past.collect()
        first = min(max(first, past.start), past.start + len(past.values))
        chosen = slice(first - past.start, None)
        return first, np.where(past.missing[chosen, None], np.nan, past.values[chosen])

    @property
    def segmentation(self) -> Segmentation:
        """Return the segments that are final, and the current activity, with the clock of the rows.

        The end of the current activity may still move in both directions. Its repetitions are added
        when they are final: when it ends, or the older half of `memory` at a time.

        Raises ParameterError while nothing is final.
        """
        finals = self._state.finals
        if not finals.frontier:
            raise ParameterError("nothing of the stream is final yet")
        preset = self._state.past.options.resolved(signals=self.layout.skeleton is None)
        provenance: dict[str, Any] = {
            "kineme": __version__,
            "preset": preset.name,
            "method": preset.method,
            "parameters": {"unit": preset.unit, **preset.parameters()},
            "notes": [
                f"segmented as a stream with a delay of {self.delay:g} s",
                *self._state.intake.said,
            ],
        }
        if (clock := self._state.intake.make_clock()) is not None:
            provenance["clock"] = clock.to_json()
        return Segmentation.from_columns(
            finals.columns(), n_frames=finals.frontier, fps=self.fps, provenance=provenance
        )

    def save(self, path: str | PathLike[str]) -> None:
        """Write the state of the stream to one file.

        Raises WriteError if it cannot be written.
        """
        skeleton = self.layout.skeleton
        body = skeleton and {
            "names": skeleton.names,
            "parents": skeleton.parents,
            "offsets": skeleton.offsets.tolist(),
        }
        settings = {
            "fps": self.fps,
            "channels": self.layout.channels if skeleton is None else None,
            "skeleton": body,
            "delay": self.delay,
            "memory": self.memory,
            "interval": self.interval,
            "options": options_to_json(self.options),
        }
        save_state(self._state, settings, path)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Return the stream that `save` wrote; it continues where it was.

        Raises ReadError if the file holds no stream.
        """
        settings, fill = load_state(path)
        options = options_from_json(SegmentOptions, settings.pop("options"))
        body = settings.pop("skeleton")
        stream = cls(**settings, skeleton=body and Skeleton(**body), **as_keywords(options))
        fill(stream._state)
        return stream

    def _frames(self, seconds: float) -> int:
        return max(1, round(seconds * self.fps))

    def _absorb(self, pieces: Sequence[Piece]) -> list[Event]:
        """Add frames and holes; segment the recent past whenever the interval is over."""
        events: list[Event] = []
        for piece in pieces:
            if isinstance(piece, str):
                events.append(Notice(at_s=self._state.now / self.fps, text=piece))
            elif isinstance(piece, Frames):
                self._take(piece.values, piece.missing, events)
            elif piece.n_frames <= self._frames(self.memory):
                last = np.repeat(self._state.intake.filler[None], piece.n_frames, axis=0)
                self._take(last, np.ones(piece.n_frames, np.bool_), events)
            else:
                self._skip(piece, events)
        return events

    def _take(self, values: Floats, missing: Masks, events: list[Event]) -> None:
        """Add frames, and look whenever the next look is due."""
        start = 0
        while start < len(values):
            stop = min(len(values), start + self._state.next_look - self._state.now)
            self._state.past.append(values[start:stop], missing[start:stop])
            self._watch_gaps(missing[start:stop], events)
            self._state.now += stop - start
            start = stop
            if self._state.now >= self._state.next_look:
                events += self._look()
                self._state.next_look = self._state.now + self._frames(self.interval)

    def _skip(self, hole: Hole, events: list[Event]) -> None:
        """Skip a hole that is longer than the recent past."""
        events += self._settle()
        # One missing frame tells that a gap begins; nothing else of the hole is needed.
        self._watch_gaps(np.ones(1, np.bool_), events)
        self._state.now += hole.n_frames
        self._state.finals.frontier = self._state.now
        self._state.past.drop_before(self._state.now)
        self._state.past.start, self._state.before = self._state.now, None
        self._state.next_look = self._state.now + self._frames(self.interval)

    def _watch_gaps(self, missing: Masks, events: list[Event]) -> None:
        """Add events for gaps that begin or end."""
        edges = np.flatnonzero(np.diff(missing, prepend=self._state.gap is not None))
        for edge in edges.tolist():
            if missing[edge]:
                self._state.gap = self._state.now + edge
                second = self._state.gap / self.fps
                events.append(Gap(at_s=second, state="provisional", start_s=second, stop_s=second))
            else:
                self._end_gap(self._state.now + edge, events)

    def _end_gap(self, stop: int, events: list[Event]) -> None:
        if self._state.gap is not None:
            stop_s = stop / self.fps
            events.append(Gap(at_s=stop_s, start_s=self._state.gap / self.fps, stop_s=stop_s))
            self._state.gap = None

    def _look(self) -> list[Event]:
        """Segment the recent past; return events for what became final and what is new."""
        look = self._state.past.look(self._state.finals)
        horizon = self._state.now - self._frames(self.delay)
        events = self._advance(look, self._state.before, horizon)
        self._announce(look, events)
        self._state.before = look
        self._state.past.drop_before(self._state.now - self._frames(self.memory))
        return events

    def _settle(self) -> list[Event]:
        """Make everything final."""
        events: list[Event] = []
        if self._state.now > self._state.finals.frontier:
            events = self._advance(self._state.past.look(self._state.finals), None, self._state.now)
        over = len(self._state.finals.activities)
        events += self._state.finals.close(self._state.now, self._state.now / self.fps)
        self._keep_examples(over)
        self._state.announced = Announced()
        return events

    def _advance(self, look: Look, before: Look | None, horizon: int) -> list[Event]:
        over = len(self._state.finals.activities)
        delay, now = self._frames(self.delay), self._state.now
        looks = Looks(look, before, horizon, delay, self._frames(self.memory), now)
        events = self._state.finals.advance(looks)
        self._keep_examples(over)
        return events

    def _keep_examples(self, first: int) -> None:
        for row in self._state.finals.activities[first:]:
            if row.cluster >= 0:
                self._state.past.keep_example(row)

    def _announce(self, look: Look, events: list[Event]) -> None:
        """Add provisional events for the current activity that were not announced before."""
        finals, announced, current = self._state.finals, self._state.announced, look.activities[-1]
        at_s, label = self._state.now / self.fps, finals.labels.get(current.cluster, "")
        begin_s = current.start / self.fps
        if current.cluster != announced.cluster:
            if announced.cluster >= 0:
                ended = ActivityEnded(
                    at_s=at_s,
                    state="provisional",
                    start_s=announced.start / self.fps,
                    # An activity that this look no longer has begins after the current one.
                    stop_s=max(announced.start / self.fps, begin_s),
                    cluster=announced.cluster,
                    repetitions=announced.n_repetitions,
                    label=finals.labels.get(announced.cluster, ""),
                )
                events.append(ended)
            announced = self._state.announced = Announced(current.start, current.cluster)
            if current.cluster >= 0:
                started = ActivityStarted(
                    at_s=at_s,
                    state="provisional",
                    start_s=begin_s,
                    cluster=current.cluster,
                    label=label,
                )
                events.append(started)
        if current.cluster < 0:
            return
        is_open = finals.cluster == current.cluster and current.start < finals.frontier
        n_final = finals.n_repetitions if is_open else 0
        coming, _ = finals.uncounted(look.primitives, current.start)
        coming = _drop_incomplete(coming, self._state.now)
        if len(coming) + n_final < 2:  # a single one may be the activity itself
            return
        for number, row in enumerate(coming, n_final + 1):
            if number > announced.n_repetitions:
                events.append(finals.repetition(row, number, at_s, state="provisional"))
        announced.n_repetitions = max(announced.n_repetitions, n_final + len(coming))

    def _remember(self, known: Any) -> None:
        """Store examples and labels of the clusters of an earlier result."""
        if not (isinstance(known, tuple | list) and len(known) == 2):
            raise ParameterError(f"known must be (recording, segments), not {known!r:.60}")
        recording, segments = known
        skeleton = self.layout.skeleton
        advice = "kineme.as_signals(data, fps=...) and kineme.read(path) give one"
        check_type(recording, Motion if skeleton else Signals, "known", advice)
        check_type(segments, Segmentation, "known", "kineme.segment(recording) gives one")
        check_same_length(segments, recording.n_frames)
        ratio = self.fps / recording.fps
        recording = resample(recording, self.fps)
        if isinstance(recording, Signals):
            values = recording.select(self.layout.channels).values
        elif skeleton is not None and recording.skeleton.names == skeleton.names:
            values = recording.positions
        else:
            raise ParameterError("the recording of known has other joints than the stream")
        earlier = RecentPast(self.layout, self._state.past.options)
        earlier.append(values.reshape(len(values), -1), np.zeros(len(values), np.bool_))
        for row in segments.activities:
            if row.cluster >= 0:
                start, stop = round(row.start_frame * ratio), round(row.stop_frame * ratio)
                earlier.keep_example(Row(start, stop, row.cluster))
                if row.label:
                    self._state.finals.labels[row.cluster] = row.label
        self._state.past.examples = earlier.examples
        self._state.finals.highest = max(earlier.examples, default=-1)


def as_keywords(options: SegmentOptions) -> dict[str, Any]:
    """Return options as keyword arguments of `Stream`."""
    own = {name: value for name, value in vars(options).items() if name != "constants"}
    return {**own, **options.constants}


def _select_channels(values: Any, names: Sequence[str]) -> Any:
    """Return the values with these names from a data frame, or a row of it; others unchanged."""
    columns = getattr(values, "column_names", getattr(values, "columns", ()))  # pyarrow, polars
    given = values.keys() if hasattr(values, "keys") else columns
    keys = {name_column(key): key for key in given if isinstance(key, str | tuple)}
    if not keys or len(keys) < len(given):  # an array, or columns without names
        return values
    if absent := [name for name in names if name not in keys]:
        raise ParameterError(f"rows have no {join_names(absent)}, but {join_names([*keys])}")
    return np.moveaxis(as_floats([values[keys[name]] for name in names], "rows"), 0, -1)


def _as_numbers(times: ArrayLike, unit: str | None) -> tuple[Floats, bool]:
    """Return times as numbers, and whether they are seconds: dates, texts, or of a given unit."""
    if unit not in (None, *UNITS_OF_TIME):
        raise ParameterError(f"unit is one of {join_names([*UNITS_OF_TIME])}, not {unit!r:.60}")
    given = np.atleast_1d(np.asarray(times))
    if given.dtype.kind == "O":  # such as numbers with None
        with suppress(ValueError, TypeError):
            given = given.astype(np.float64)
    try:
        if unit is None and given.dtype.kind in "iuf":
            return given.astype(np.float64), False
        return np.asarray(as_seconds(given, unit)[0], np.float64), True
    except (ValueError, TypeError) as error:
        raise ParameterError(f"invalid times: {error}") from None


def _drop_incomplete(rows: list[Row], now: int) -> list[Row]:
    """Return repetitions without the current one, unless it is about as long as the others."""
    if not rows or rows[-1].stop < now:
        return rows
    lengths = [float(row.stop - row.start) for row in rows[:-1]]
    usual = float(np.median(lengths or [np.inf]))
    return rows if rows[-1].stop - rows[-1].start >= PART_COUNTED * usual else rows[:-1]
