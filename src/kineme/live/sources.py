"""Sources of rows: lines of text, a replayed recording, Lab Streaming Layer, OSC.

A source yields `Rows`, which are empty while nothing arrives.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from queue import Empty, Queue
from threading import Thread
from time import monotonic, sleep, time
from typing import Any, TypeVar

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import join_names, make_unique, require_extra
from kineme.errors import ParameterError
from kineme.recordings import Motion, Signals, Skeleton
from kineme.recordings.regular import place_rows
from kineme.recordings.times import UNITS_OF_TIME, as_seconds, find_time_unit, is_time, parse_date

T = TypeVar("T")
WAIT_S = 0.2
"""Seconds after which a source yields empty rows if nothing arrives."""
AHEAD = 1000
"""Largest number of lines that are read ahead."""
PIECE_S = 0.1
"""Seconds of a recording that are replayed at once."""
TIMED_ROWS = 50
"""Number of rows from which the rate of a source is measured if it does not state it."""
FOUND_S = 10.0
"""Seconds to wait for an LSL stream."""
BONE = "/VMC/Ext/Bone/Pos"
UNUSED = ("/OK", "/T", "/Apply")
"""Endings of OSC addresses that carry no measurement."""


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows (rows, channels), their times in seconds if known, and remarks for the user."""

    values: Floats
    seconds: Floats | None = None
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Source:
    """A source of rows.

    Attributes
    ----------
    fps : float
        Frames per second; 0 if unknown, see `measure_rate`.
    channels : tuple of str
    rows : iterator of Rows
    skeleton : Skeleton, optional
        Skeleton, if the channels are x, y and z of its joints.
    """

    fps: float
    channels: tuple[str, ...]
    rows: Iterator[Rows]
    skeleton: Skeleton | None = None


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

    The first line of a CSV names the channels, or is a row of numbers. Each line of JSON is an
    object of numbers by channel, or a list of numbers. ``columns`` are patterns of the channels to
    use. Invalid lines are dropped with a remark.
    """
    queue: Queue[str | None] = Queue(AHEAD)

    def fill() -> None:
        for line in lines:
            queue.put(line)
        queue.put(None)

    Thread(target=fill, daemon=True).start()
    first = queue.get()
    while first is not None and not first.strip():
        first = queue.get()
    if first is None:
        raise ParameterError("no lines received: the first line must name the channels")
    parser = _Parser(first, columns)

    def rows() -> Iterator[Rows]:
        waiting: list[str | None] = [*parser.first_lines]
        is_open = True
        while is_open:
            waiting += _drain(queue)
            is_open = None not in waiting  # `fill` ends with None
            yield parser.parse([line for line in waiting if line is not None])
            waiting = []

    return Source(0.0, parser.channels, rows())


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
    """Parser of lines; their layout is that of the first line."""

    def __init__(self, first: str, columns: Sequence[str]) -> None:
        self.is_json = first.lstrip()[:1] in ("{", "[")
        cells = self._cells(first)
        if isinstance(cells, dict):
            names = list(cells)
        elif self.is_json or all(_is_number(cell) for cell in cells):
            names = [str(number) for number in range(1, len(cells) + 1)]
        else:
            names = [str(cell).strip() for cell in cells]
        keeps_first = self.is_json or names != [str(cell).strip() for cell in cells]
        self.first_lines = [first] if keeps_first else []
        self.names = make_unique(names, allow_empty=True)
        self.time = next((i for i, name in enumerate(self.names) if is_time(name)), None)
        self.at = [
            i
            for i, name in enumerate(self.names)
            if i != self.time and (not columns or any(fnmatchcase(name, each) for each in columns))
        ]
        if not self.at:
            raise ParameterError(f"none of the columns is a channel ({join_names(self.names)})")
        self.channels = tuple(self.names[i] for i in self.at)
        self.unit = None if self.time is None else find_time_unit(self.names[self.time])

    def parse(self, lines: Sequence[str]) -> Rows:
        """Parse lines into rows."""
        rows, seconds, wrong = [], [], 0
        for line in lines:
            if not line.strip():
                continue
            try:
                cells = self._cells(line)
                if isinstance(cells, dict):
                    cells = [cells.get(name) for name in self.names]
                row = [_number(cells[i]) for i in self.at]
                if len(cells) != len(self.names):
                    wrong += 1
                    continue
                if self.time is not None:
                    seconds.append(self._seconds(cells[self.time]))
                rows.append(row)
            except (ValueError, TypeError, IndexError):
                wrong += 1
        values = np.array(rows, np.float64).reshape(-1, len(self.at))
        remarks = (f"{wrong} lines without {len(self.names)} cells left out",) if wrong else ()
        return Rows(values, None if self.time is None else np.array(seconds), remarks)

    def _cells(self, line: str) -> Any:
        return json.loads(line) if self.is_json else next(csv.reader([line]))

    def _seconds(self, cell: Any) -> float:
        """Return a time in seconds; numbers without a unit are unchanged."""
        try:
            return _number(cell) / UNITS_OF_TIME[self.unit or "s"]
        except ValueError:
            return parse_date(cell.strip())


def _number(cell: Any) -> float:
    if cell is None or (isinstance(cell, str) and not cell.strip()):
        return np.nan
    return float(cell)


def _is_number(cell: Any) -> bool:
    try:
        _number(cell)
    except (ValueError, TypeError):
        return False
    return True


def receive_lsl(name: str) -> Source:
    """Return a stream of the Lab Streaming Layer, by its name or type, as a source.

    Raises
    ------
    ParameterError
        There is no such stream.
    MissingDependencyError
        pylsl is not installed.
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

    def take(address: str, *values: Any) -> None:
        """Add a message to the row; queue the row before if the message begins the next one."""
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
    dispatcher.set_default_handler(take)
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


def measure_rate(source: Source) -> Source:
    """Return the source with the rate measured from the times of its first rows.

    Raises ParameterError if there are no times, or too few rows.
    """
    begun: list[Rows] = []
    count = 0
    for piece in source.rows:
        begun.append(piece)
        count += len(piece.values)
        if piece.seconds is None:
            raise ParameterError("rows have no time column: give --fps")
        if count >= TIMED_ROWS:
            break
    seconds = np.concatenate([piece.seconds for piece in begun if piece.seconds is not None])
    seconds = as_seconds(seconds)[0]

    def rows() -> Iterator[Rows]:
        yield from begun
        yield from source.rows

    return replace(source, fps=place_rows(seconds).fps, rows=rows())
