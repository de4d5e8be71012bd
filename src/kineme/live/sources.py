"""Sources of rows: lines of text, a replayed recording, Lab Streaming Layer, OSC.

A source yields `Rows`, which are empty while nothing arrives.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from itertools import chain, islice
from queue import Empty, Queue
from threading import Thread
from time import monotonic, sleep, time
from typing import Any, TypeVar

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import format_count, join_names, make_unique, require_extra
from kineme.errors import ParameterError
from kineme.live.intake import count_rows_for_unit, guess_unit
from kineme.recordings import Motion, Signals, Skeleton
from kineme.recordings.column_names import EMPTY, select_channels
from kineme.recordings.regular import place_rows
from kineme.recordings.times import (
    UNITS_OF_TIME,
    as_seconds,
    find_time_unit,
    is_time,
    is_timing,
    parse_date,
)

T = TypeVar("T")
WAIT_S = 0.2
"""Seconds after which a source yields empty rows if nothing arrives."""
AHEAD = 1000
"""Largest number of lines that are read ahead."""
PIECE_S = 0.1
"""Seconds of a recording that are replayed at once."""
TIMED_ROWS, MOST_TIMED_ROWS = 50, 5000
"""Number of rows from which rate and unit are found, and if these have fewer than four times."""
FOUND_S = 10.0
"""Seconds to wait for an LSL stream."""
BONE = "/VMC/Ext/Bone/Pos"
UNUSED = ("/OK", "/T", "/Apply")
"""Endings of OSC addresses that carry no measurement."""


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows (rows, channels), their times if known, and remarks for the user."""

    values: Floats
    seconds: Floats | None = None
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Source:
    """A source of rows."""

    fps: float  # 0 if unknown, see `measure_rate`
    channels: tuple[str, ...]
    rows: Iterator[Rows]
    skeleton: Skeleton | None = None  # set if the channels are x, y and z of its joints
    has_unit: bool = True  # whether times are in seconds; if not, `measure_rate` finds their unit


def replay(recording: Motion | Signals, speed: float = 1.0) -> Source:
    """Return a recording as a source at a multiple of its speed; 0: without waiting."""
    skeleton = recording.skeleton if isinstance(recording, Motion) else None
    values = recording.values if isinstance(recording, Signals) else recording.positions
    frames = np.array(values, np.float64).reshape(len(values), -1)
    for start, stop in recording.gaps:
        frames[start:stop] = np.nan
    names = tuple(recording.names) if isinstance(recording, Signals) else ()
    if skeleton is not None:
        names = tuple(f"{joint}_{axis}" for joint in skeleton.names for axis in "xyz")
    step = max(1, round(PIECE_S * recording.fps))

    def rows() -> Iterator[Rows]:
        begun = monotonic()
        for start in range(0, len(frames), step):
            if speed > 0:
                due = begun + min(start + step, len(frames)) / recording.fps / speed
                sleep(max(0.0, due - monotonic()))
            yield Rows(frames[start : start + step])

    return Source(recording.fps, names, rows(), skeleton)


def read_lines(lines: Iterable[str], columns: Sequence[str] = ()) -> Source:
    """Return lines of CSV or JSON as a source.

    The first line of a CSV names the channels, or is a row of numbers; cells are separated by
    commas, tabs or semicolons, and may have decimal commas. Each line of JSON is an object of
    numbers by channel, or a list of numbers; nested ones become ``acc_x`` or ``acc_1``. Channels
    have a number in the first row. ``columns`` are their patterns; by default, names of counters
    and labels are left out. Invalid lines are dropped with a remark.
    """
    queue: Queue[str | None] = Queue(AHEAD)

    def fill() -> None:
        for line in lines:
            queue.put(line)
        queue.put(None)

    Thread(target=fill, daemon=True).start()
    parser = _Parser(iter(queue.get, None), columns)

    def rows() -> Iterator[Rows]:
        waiting: list[str | None] = [*parser.first_lines]
        is_open = True
        while is_open:
            waiting += _drain(queue)
            is_open = None not in waiting  # `fill` ends with None
            yield parser.parse([line for line in waiting if line is not None])
            waiting = []

    has_unit = parser.time is None or parser.unit is not None
    return Source(0.0, parser.channels, rows(), has_unit=has_unit)


def _drain(queue: Queue[T]) -> list[T]:
    """Return all items in a queue; wait up to `WAIT_S` for the first."""
    found: list[T] = []
    try:
        found.append(queue.get(timeout=WAIT_S))
        while len(found) < AHEAD:
            found.append(queue.get_nowait())
    except Empty:
        pass
    return found


class _Parser:
    """Parser of lines; their layout is that of the first lines.

    ``names`` are all columns, or all numbers of a line of JSON; ``time`` is the column of the
    times, and ``at`` are those of the channels.
    """

    def __init__(self, lines: Iterator[str], columns: Sequence[str]) -> None:
        lines = filter(str.strip, lines)
        first = next(lines, "")
        if not first:
            raise ParameterError("no lines received: the first line must name the channels")
        self.is_json = first.lstrip()[:1] in ("{", "[")
        self.separator = next((mark for mark in "\t;" if mark in first), ",")
        try:
            cells = self._split_line(first)
        except ValueError as error:
            raise ParameterError(f"the first line is not complete JSON: {first:.60}") from error
        is_row = self.is_json or all(_is_number(cell) for cell in cells.values())
        names = list(cells) if is_row else [cell.strip() for cell in cells.values()]
        self.names = make_unique(names, allow_empty=True)
        self.time = next((i for i, name in enumerate(self.names) if is_time(name)), None)
        # None if there are no times, or their unit is unknown.
        self.unit = None if self.time is None else find_time_unit(self.names[self.time])
        wanted = [
            i
            for i, name in enumerate(self.names)
            if i != self.time
            and (
                any(fnmatchcase(name, each) for each in columns)
                if columns
                else name and not is_timing(name)
            )
        ]
        reason = f"none of the columns is a channel ({join_names(self.names)})"
        self.first_lines: list[str] = []  # rows that are read here already
        self.at: list[int] = []
        for line in islice(chain([first] if is_row else [], lines), TIMED_ROWS):
            self.first_lines.append(line)
            try:
                row = self._parse_row(line)
            except ValueError as error:
                reason = str(error)
                continue
            numeric = [self.names[i] for i in wanted if _is_number(row[i])]
            chosen = numeric if columns else select_channels(numeric)
            self.at = [i for i in wanted if self.names[i] in chosen]
            if np.isfinite([_parse_number(row[i]) for i in self.at]).any():
                break
        if not self.at:
            raise ParameterError(reason)
        if self.time is not None and not _is_number(row[self.time]):
            self.unit = "s"  # dates
        self.channels = tuple(self.names[i] for i in self.at)
        others = wanted if columns else range(len(self.names))
        left = [self.names[i] for i in others if i not in (*self.at, self.time)]
        # Told with the next rows.
        self.remarks = (f"columns that are not channels: {join_names(left)}",) if left else ()

    def parse(self, lines: Sequence[str]) -> Rows:
        """Parse lines into rows."""
        rows, seconds, wrong, texts = [], [], 0, 0
        for line in filter(str.strip, lines):
            try:
                cells = self._parse_row(line)
                second = 0.0 if self.time is None else self._parse_time(cells[self.time])
            except ValueError:
                wrong += 1
                continue
            row = [_parse_number(cells[i]) if _is_number(cells[i]) else None for i in self.at]
            n_texts = row.count(None)
            if n_texts == len(row):  # such as names of columns
                wrong += 1
                continue
            rows.append(row)
            seconds.append(second)
            texts += n_texts
        values = np.array(rows, np.float64).reshape(-1, len(self.at))  # NaN for None
        remarks, self.remarks = list(self.remarks), ()
        if wrong:
            lines = format_count(wrong, "line")
            expected = format_count(len(self.names), "cell")
            remarks.append(f"{lines} left out: not a row of {expected}")
        if texts:
            remarks.append(f"{format_count(texts, 'cell')} of text left out")
        return Rows(values, None if self.time is None else np.array(seconds), tuple(remarks))

    def _split_line(self, line: str) -> dict[str, Any]:
        """Return the cells of a line by name; those of a CSV are numbered."""
        return _flatten(
            json.loads(line) if self.is_json else next(csv.reader([line], delimiter=self.separator))
        )

    def _parse_row(self, line: str) -> list[Any]:
        """Return the cells of a line in the order of `names`; raise ValueError if they differ."""
        cells = self._split_line(line)
        n_cells, n_names = len(cells), len(self.names)
        if not self.is_json and n_cells != n_names:
            raise ValueError(f"rows have {n_cells} cells, but the first line has {n_names}")
        if self.is_json and cells.keys().isdisjoint(self.names):
            raise ValueError("rows have none of the names in the first line")
        return [cells.get(name) for name in self.names] if self.is_json else [*cells.values()]

    def _parse_time(self, cell: Any) -> float:
        """Return a time in seconds; numbers without a unit are unchanged."""
        if _is_number(cell):
            return _parse_number(cell) / UNITS_OF_TIME[self.unit or "s"]
        return parse_date(cell.strip())


def _flatten(values: Any, name: str = "") -> dict[str, Any]:
    """Return nested values by name, items of lists by number.

    Examples
    --------
    >>> _flatten({"time": 0, "acc": {"x": 1}, "gyro": [2, 3]})
    {'time': 0, 'acc_x': 1, 'gyro_1': 2, 'gyro_2': 3}
    """
    if isinstance(values, list):
        values = {str(number): value for number, value in enumerate(values, 1)}
    if not isinstance(values, dict):
        return {name: values}
    found: dict[str, Any] = {}
    for key, value in values.items():
        found |= _flatten(value, f"{name}_{key}" if name else key)
    return found


def _parse_number(cell: Any) -> float:
    """Return a cell as a number, NaN if it is empty; raise ValueError if it is text."""
    if not isinstance(cell, str):
        return np.nan if cell is None else float(cell)
    return np.nan if cell.strip().lower() in EMPTY else float(cell.replace(",", "."))


def _is_number(cell: Any) -> bool:
    try:
        _parse_number(cell)
    except ValueError:
        return False
    return True


def receive_lsl(name: str) -> Source:
    """Return a stream of the Lab Streaming Layer, by its name or type, as a source.

    ParameterError if there is no such stream, MissingDependencyError without pylsl.
    """
    with require_extra("pylsl", "lsl"):
        import pylsl
    infos = pylsl.resolve_byprop("name", name, timeout=FOUND_S / 2) or pylsl.resolve_byprop(
        "type", name, timeout=FOUND_S / 2
    )
    if not infos:
        raise ParameterError(f"no LSL stream has the name or type {name!r}")
    inlet = pylsl.StreamInlet(infos[0])
    info = inlet.info(FOUND_S)
    names, channel = [], info.desc().child("channels").child("channel")
    while not channel.empty():
        names.append(channel.child_value("label"))
        channel = channel.next_sibling()
    count = info.channel_count()
    if len(names) != count:
        names = [str(number) for number in range(1, count + 1)]

    def rows() -> Iterator[Rows]:
        while True:
            try:
                samples, stamps = inlet.pull_chunk(timeout=WAIT_S)
            except pylsl.util.LostError:
                return
            values = np.array(samples, np.float64).reshape(-1, count)
            yield Rows(values, np.array(stamps, np.float64))

    channels = tuple(make_unique(names, allow_empty=True))
    return Source(float(info.nominal_srate()), channels, rows())


def receive_osc(port: int, host: str = "127.0.0.1") -> Source:
    """Return OSC messages, such as those of VMC, as a source.

    Messages with different addresses form one row, until an address repeats. Bones of VMC
    contribute their rotations. The channels are those of the first complete row.
    """
    with require_extra("python-osc", "osc"):
        from pythonosc.dispatcher import Dispatcher
        from pythonosc.osc_server import BlockingOSCUDPServer
    queue: Queue[tuple[float, dict[str, float]]] = Queue()
    row: dict[str, float] = {}

    def add_message(address: str, *values: Any) -> None:
        """Add a message to the row; if the row has it already, queue the row and begin another."""
        if address.endswith(UNUSED):
            return
        # Texts, such as the name of a bone, are part of the channel's name.
        texts = [value for value in values if isinstance(value, str)]
        numbers = [float(value) for value in values if isinstance(value, int | float)]
        if address == BONE:
            numbers = numbers[3:]  # the position precedes the rotation
        name = "_".join([address.rpartition("/")[2], *texts])
        if f"{name}_1" in row:  # the row has this message already
            queue.put((time(), dict(row)))
            row.clear()
        row.update({f"{name}_{i}": number for i, number in enumerate(numbers, 1)})

    dispatcher = Dispatcher()
    dispatcher.set_default_handler(add_message)
    server = BlockingOSCUDPServer((host, port), dispatcher)
    Thread(target=server.serve_forever, daemon=True).start()
    queue.get()  # the first row may be incomplete
    first = queue.get()
    channels = tuple(first[1])

    def rows() -> Iterator[Rows]:
        waiting = [first]
        try:
            while True:
                waiting += _drain(queue)
                values = [[found.get(name, np.nan) for name in channels] for _, found in waiting]
                seconds = np.array([second for second, _ in waiting])
                yield Rows(np.array(values).reshape(-1, len(channels)), seconds)
                waiting = []
        finally:
            server.shutdown()
            server.server_close()

    return Source(0.0, channels, rows())


def measure_rate(source: Source, fps: float = 0.0) -> Source:
    """Return the source with times in seconds, and the rate measured from them unless given.

    Both follow from the first rows. Raises ParameterError if there are no times, or too few rows.
    """
    begun: list[Rows] = []
    times = np.empty(0)
    for piece in source.rows:
        begun.append(piece)
        if piece.seconds is None:
            raise ParameterError("rows have no time column: give --fps")
        times = np.append(times, piece.seconds)
        # Rows of a packet share a time, so that many rows may have few times.
        if len(times) >= (TIMED_ROWS if count_rows_for_unit(times) else MOST_TIMED_ROWS):
            break
    seconds, _ = as_seconds(times, "s" if source.has_unit else None)
    # Channels may have rows of their own, so the values tell the rate of the fastest.
    fps = fps or place_rows(seconds, np.concatenate([piece.values for piece in begun])).fps
    per_second = 1.0 if source.has_unit else guess_unit(times[np.isfinite(times)], fps)

    def rows() -> Iterator[Rows]:
        for piece in chain(begun, source.rows):
            assert piece.seconds is not None  # noqa: S101 (for mypy)
            yield replace(piece, seconds=piece.seconds / per_second)

    return replace(source, fps=fps, rows=rows(), has_unit=True)
