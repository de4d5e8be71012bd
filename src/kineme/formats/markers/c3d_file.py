"""Parse C3D files: header, parameters, then points and analog samples frame by frame.

Blocks have 512 bytes. Integers and floats have the format of the processor named in the parameter
section: Intel, DEC or MIPS (SGI). A frame holds four numbers for each point, x, y, z and its
residual (negative: not seen), followed by the analog samples. All are 16-bit integers that need
scaling, or floats if the scale is negative. A point exactly at the origin was not seen either:
programs without residuals store it so.

Counts that exceed 16 bits are stored in several places, and any of them may be wrong or saturated.
The number of frames is the largest of the stored counts for which the file has enough bytes. Labels
beyond the 255th are in LABELS2, LABELS3 and so on. A parameter may be an integer where the manual
specifies a float, and vice versa.

A record of the parameter section consists of the length of its name, the number of its group
(negative if the record is the group), the name, the distance to the next record, and for parameters
type, dimensions and values. Values are parsed on demand.

No more memory is allocated than the file holds. The tests compare the results with ezc3d. It is not
used because damaged files crash the process, and it does not read MIPS files.

Source: Motion Lab Systems, "The C3D file format: a technical user guide" (2021).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import count
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.formats.files import FileContent

Stored = NDArray[Any]
"""Float32 or int16."""

BLOCK = 512
INTEL, DEC, MIPS = 84, 85, 86
_HEADER_EVENTS = 12345  # value that marks headers whose events have labels of four letters


@dataclass(frozen=True)
class C3D:
    """Contents of a C3D file."""

    labels: list[str]  # one per point
    points: Floats  # (frames, points, 3) in the file's unit, NaN where not seen
    rate: float  # frames per second, 0 if the file has none
    first_frame: int  # number in the capture, counted from 1
    analog: Floats  # (samples, channels), scaled
    analog_labels: list[str]
    analog_units: list[str]
    analog_rate: float  # samples per second
    events: tuple[tuple[float, str], ...]  # seconds from the first frame, and label
    event_subjects: tuple[str, ...]  # of each event, empty if unknown
    parameters: Parameters


def parse_c3d(content: FileContent) -> C3D:
    """Return the contents of a C3D file; raise ReadError if it is invalid or has no whole frame."""
    file = Layout(content)
    parameters = file.parameters
    # One row per frame: points first, then analog samples.
    raw = file.frames()
    n, _ = file.counts
    analog = _scale_analog(file, raw[:, 4 * n :])
    events = _read_events(file)
    return C3D(
        labels=_read_labels(parameters, "POINT", n, "point"),
        points=_scale_points(raw[:, : 4 * n].reshape(len(raw), n, 4), file.scale),
        rate=file.rate,
        first_frame=file.first_frame,
        analog=analog,
        analog_labels=_read_labels(parameters, "ANALOG", analog.shape[1], "channel"),
        analog_units=_pad(parameters.strings("ANALOG", "UNITS"), analog.shape[1]),
        analog_rate=file.rate * len(analog) / len(raw),
        events=tuple((at, label) for at, label, _ in events),
        event_subjects=tuple(subject for *_, subject in events),
        parameters=parameters,
    )


def _scale_analog(file: Layout, raw: Stored) -> Floats:
    """Return the scaled analog samples (samples, channels), empty if the counts do not fit."""
    total = raw.shape[1]
    per_frame = file.header.samples_per_frame or 1
    channels = int(file.parameters.number("ANALOG", "USED", total // per_frame))
    if channels <= 0 or total % channels:
        return np.empty((0, 0))
    values = raw.reshape(-1, channels)
    is_unsigned = "UNSIGNED" in file.parameters.strings("ANALOG", "FORMAT")
    if is_unsigned and values.dtype.kind == "i":
        values = as_unsigned(values)
    scale = _repeat_per_channel(file.parameters, "SCALE", channels, 1.0)
    scale *= file.parameters.number("ANALOG", "GEN_SCALE", 1.0)
    # The offsets are stored like the samples.
    offset = _repeat_per_channel(file.parameters, "OFFSET", channels, 0.0, signed=not is_unsigned)
    return np.asarray((values - offset) * scale, np.float64)


def _repeat_per_channel(
    parameters: Parameters, name: str, channels: int, default: float, *, signed: bool = True
) -> Floats:
    values = parameters.numbers("ANALOG", name, signed=signed)[:channels]
    return np.array(values + [default] * (channels - len(values)))


def _read_events(file: Layout) -> list[tuple[float, str, str]]:
    """Return seconds from the first frame, label and subject of each event in time order.

    Events are those of the EVENT group, else of the header.
    """
    if file.rate == 0:
        return []
    # Stored times count from frame 1 of the capture, which may precede the file's first frame.
    start = (file.first_frame - 1) / file.rate
    used = int(file.parameters.number("EVENT", "USED", 0))
    times = file.parameters.numbers("EVENT", "TIMES")  # minutes and seconds in turn
    labels = file.parameters.strings("EVENT", "LABELS")
    sides = _pad(file.parameters.strings("EVENT", "CONTEXTS"), len(labels))
    subjects = _pad(file.parameters.strings("EVENT", "SUBJECTS"), len(labels))
    rows = zip(times[::2], times[1::2], sides, labels, subjects, strict=False)
    events = [(60 * m + s, f"{side} {label}".strip(), who) for m, s, side, label, who in rows]
    events = events[:used] or [(at, label, "") for at, label in read_header_events(file)]
    return sorted((round(t - start, 6), label, who) for t, label, who in events if np.isfinite(t))


def read_header_events(file: Layout) -> list[tuple[float, str]]:
    """Return seconds from frame 1 and label of the events in the first block."""
    data, kind = file.content.data, file.parameters.processor
    # Word 150 of the header marks labels of four letters; the next word is their count.
    magic, n = np.frombuffer(data, get_number_type(kind, real=False), 2, 2 * 149).tolist()
    if magic != _HEADER_EVENTS:
        return []
    # Times begin at word 153 and labels at word 199, 18 at most.
    words = np.frombuffer(data, get_number_type(kind, real=True), 18, 2 * 152)
    times = as_float32(words, kind).tolist()
    labels = [decode_text(data[at : at + 4]) for at in range(2 * 198, 2 * 198 + 72, 4)]
    return list(zip(times, labels, strict=True))[: max(n, 0)]


def _scale_points(stored: Stored, scale: float) -> Floats:
    """Return positions (frames, points, 3), NaN where a point was not seen."""
    positions = stored[:, :, :3].astype(np.float64)
    if stored.dtype.kind == "i":
        positions *= scale
    # A negative residual marks a point that was not seen.
    is_visible = (stored[:, :, 3] >= 0) & np.isfinite(positions).all(axis=2)
    positions[~(is_visible & positions.any(axis=2))] = np.nan
    return positions


def _read_labels(parameters: Parameters, group: str, n: int, default: str) -> list[str]:
    labels = list(parameters.strings(group, "LABELS"))
    for number in count(2):
        more = parameters.strings(group, f"LABELS{number}")
        if not more or len(labels) >= n:
            break
        labels += more
    return [label or f"{default}{i}" for i, label in enumerate(_pad(labels, n), 1)]


def _pad(labels: list[str], n: int) -> list[str]:
    return labels[:n] + [""] * (n - len(labels))


@dataclass(frozen=True)
class Header:
    """Used fields of the first block."""

    points: int
    analog_per_frame: int
    first_frame: int
    last_frame: int
    scale: float
    data_block: int
    samples_per_frame: int
    rate: float


@dataclass(frozen=True)
class Layout:
    """Positions and counts of the data in a file, see `kineme.formats.markers.c3d_file`."""

    content: FileContent

    @cached_property
    def parameters(self) -> Parameters:
        return read_parameters(self.content)

    @cached_property
    def header(self) -> Header:
        """Fields of the first block, in the number formats of the processor."""
        data, kind = self.content.data, self.parameters.processor
        # Counts above 32767 need unsigned integers.
        words = as_unsigned(np.frombuffer(data, get_number_type(kind, real=False), 12)).tolist()
        # A real takes two words.
        reals = as_float32(np.frombuffer(data, get_number_type(kind, real=True), 6), kind)
        return Header(  # the specification counts words from 1
            points=words[1],
            analog_per_frame=words[2],
            first_frame=words[3],
            last_frame=words[4],
            scale=float(reals[3]),  # words 7 and 8; word 6 is the largest gap to interpolate
            data_block=words[8],
            samples_per_frame=words[9],
            rate=float(reals[5]),  # words 11 and 12
        )

    @cached_property
    def counts(self) -> tuple[int, int]:
        """Number of points and analog samples in a frame.

        Header and parameters state both. If they differ, the counts are used for which the declared
        frames fill the file up to its last block, which may be padded.
        """
        header = (self.header.points, self.header.analog_per_frame)
        used = int(self.parameters.number("POINT", "USED", header[0]))
        per_frame = max(self.header.samples_per_frame, 1)
        channels = int(self.parameters.number("ANALOG", "USED", -1))
        samples = channels * per_frame if channels >= 0 else header[1]
        if used == header[0] and samples == header[1]:
            return header
        # Try all combinations of the two sources.
        pairs = dict.fromkeys((n, m) for n in (used, header[0]) for m in (header[1], samples))
        fitting = [pair for pair in pairs if any(pair) and self._fills(*pair)]
        remark = (
            f"the header counts {header[0]} points and {header[1]} analog samples in a frame, "
            f"the parameters {used} and {samples}"
        )
        # Pairs with equally many numbers per frame have the same layout.
        widths = {4 * n + m for n, m in fitting}
        if len(fitting) == 1 or (fitting and used == header[0] and len(widths) == 1):
            n, m = fitting[0]
            self.content.warn(f"{remark}: {n} and {m} used, since they fit the length of the file")
            return fitting[0]
        if used == header[0] and not fitting:  # the file may be truncated
            self.content.warn(f"{remark}: those of the header used")
            return header
        fit = "either fits" if fitting else "neither fits"
        raise self.content.error(f"{remark}, and {fit} the length of the file: it is damaged")

    def _fills(self, n_points: int, per_frame: int) -> bool:
        """Return whether one of the declared numbers of frames ends in the file's last block."""
        width = (4 * n_points + per_frame) * self._kind.itemsize
        size = len(self.content.data) - self.start
        ends = (frames * width for frames in self._declared_frames())
        # The end must be in the last block; one additional block of padding is common.
        return any(end <= size < (end // BLOCK + 2) * BLOCK for end in ends if end)

    @cached_property
    def _kind(self) -> np.dtype[Any]:
        return get_number_type(self.parameters.processor, real=self.scale < 0)

    @cached_property
    def start(self) -> int:
        """Offset of the data in bytes."""
        block = self.header.data_block or int(self.parameters.number("POINT", "DATA_START", 0))
        if block < 2:
            raise self.content.error("the header states no position of the data, or no points")
        return (block - 1) * BLOCK

    @cached_property
    def scale(self) -> float:
        return self.parameters.number("POINT", "SCALE", self.header.scale) or self.header.scale

    @cached_property
    def rate(self) -> float:
        rate = self.parameters.number("POINT", "RATE", self.header.rate) or self.header.rate
        return rate if np.isfinite(rate) and rate > 0 else 0.0

    @cached_property
    def first_frame(self) -> int:
        return self._long("ACTUAL_START_FIELD") or self.header.first_frame

    def frames(self) -> Stored:
        """Return the stored data section (frames, numbers)."""
        start, kind = self.start, self._kind
        n_points, per_frame = self.counts
        width = 4 * n_points + per_frame
        if width == 0:
            raise self.content.error("the header states no position of the data, or no points")
        available = max(len(self.content.data) - start, 0) // (width * kind.itemsize)
        declared = self._declared_frames()
        # Use the largest declared count that fits, else all complete frames.
        n = max((frames for frames in declared if 0 < frames <= available), default=available)
        if n == 0:
            reason = f"less than one frame of {n_points} points: the file is truncated"
            raise self.content.error(reason)
        if n not in declared:
            self.content.warn(f"{max(declared)} frames declared, {n} found and kept")
        raw = np.frombuffer(self.content.data, kind, n * width, start).reshape(n, width)
        return as_float32(raw, self.parameters.processor) if self.scale < 0 else raw

    def _declared_frames(self) -> set[int]:
        """Return the numbers of frames that header and parameters state, which may differ."""
        start, stop = self._long("ACTUAL_START_FIELD"), self._long("ACTUAL_END_FIELD")
        counts = {
            self.header.last_frame - self.header.first_frame + 1,
            int(self.parameters.number("POINT", "FRAMES", 0)),
            int(self.parameters.number("POINT", "LONG_FRAMES", 0)),
            stop - start + 1 if start and stop else 0,
        }
        return {frames for frames in counts if frames > 0} or {0}

    def _long(self, name: str) -> int:
        """Return a 32-bit count stored as two words, the low one first; 0 if it is missing."""
        low, *high = self.parameters.numbers("TRIAL", name)[:2] or [0.0]
        return int(low) + (int(high[0]) << 16 if high else 0)


@dataclass(frozen=True)
class Record:
    """Position of a group or parameter in a C3D file, in bytes."""

    number: int  # number of its group, negative if the record is the group
    name: str  # in upper case
    start: int
    values: int  # position of type, dimensions and values, or of a group's description
    stop: int | None  # start of the next record; may be missing in the last one


@dataclass(frozen=True)
class Parameters:
    """Values of a C3D file by group and name, both in upper case."""

    content: FileContent
    processor: int
    start: int  # first byte of the section
    records: list[Record]

    @cached_property
    def places(self) -> dict[tuple[str, str], int]:
        """Offset of the values of each parameter."""
        groups = {-record.number: record.name for record in self.records if record.number < 0}
        return {
            (groups.get(record.number, ""), record.name): record.values
            for record in self.records
            if record.number > 0
        }

    def number(self, group: str, name: str, default: float) -> float:
        """Return the first value as a finite number, ``default`` if there is none."""
        values = self.numbers(group, name)
        return values[0] if values and np.isfinite(values[0]) else default

    def numbers(self, group: str, name: str, *, signed: bool = False) -> list[float]:
        """Return the values as numbers, none if they are text.

        Integers are unsigned counts unless ``signed``.
        """
        kind, _, data = self.stored(group, name)
        if kind == 4:
            reals = np.frombuffer(data, get_number_type(self.processor, real=True))
            return list(map(float, as_float32(reals, self.processor)))
        if kind not in (1, 2):
            return []
        code = np.dtype("i1") if kind == 1 else get_number_type(self.processor, real=False)
        integers = np.frombuffer(data, code)
        return list(map(float, integers if signed else as_unsigned(integers)))

    def strings(self, group: str, name: str) -> list[str]:
        """Return the values as text, none if they are numbers."""
        return [decode_text(text) for text in self.texts(group, name)]

    def texts(self, group: str, name: str) -> list[bytes]:
        """Return the values as bytes, none if they are numbers."""
        kind, shape, data = self.stored(group, name)
        width = shape[0] if shape else 1
        if kind != -1 or width == 0:
            return []
        return [data[at : at + width] for at in range(0, len(data), width)]

    def stored(self, group: str, name: str) -> tuple[int, list[int], bytes]:
        """Return type, dimensions and bytes of a parameter; empty if it is missing or truncated."""
        offset = self.places.get((group, name))
        data = self.content.data
        if offset is None or offset + 2 > len(data):
            return 0, [], b""
        kind = int.from_bytes(data[offset : offset + 1], signed=True)
        # The number of dimensions, then one byte for each.
        start = offset + 2 + data[offset + 1]
        shape = list(data[offset + 2 : start])
        # The type is the size of a value in bytes; -1 is text.
        size = abs(kind) * prod(shape)
        if start + size > len(data):
            return 0, [], b""
        return kind, shape, data[start : start + size]


def read_parameters(content: FileContent) -> Parameters:
    """Return the parameters; raise ReadError if the section is missing or its processor unknown."""
    data = content.data
    start = (max(data[0], 1) - 1) * BLOCK if data else 0
    if len(data) < max(start + 4, BLOCK):
        reason = "the file ends before its parameters: it is truncated or not a C3D file"
        raise content.error(reason)
    processor = data[start + 3]
    if processor not in (INTEL, DEC, MIPS):
        raise content.error(
            f"processor type {processor} is not Intel ({INTEL}), DEC ({DEC}) or MIPS "
            f"({MIPS}): the file is damaged or not a C3D file"
        )
    order = "big" if processor == MIPS else "little"
    records: list[Record] = []
    offset = start + 4
    while offset + 2 <= len(data):
        length = abs(int.from_bytes(data[offset : offset + 1], signed=True))
        group = int.from_bytes(data[offset + 1 : offset + 2], signed=True)
        after = offset + 2 + length
        # The distance to the next record counts from its own position.
        step = int.from_bytes(data[after : after + 2], order)  # type: ignore[arg-type]
        if length == 0 or group == 0:
            break
        name = decode_text(data[offset + 2 : after]).upper()
        records.append(Record(group, name, offset, after + 2, after + step if step else None))
        if step == 0:
            break
        offset = after + step
    return Parameters(content, processor, start, records)


def get_number_type(processor: int, *, real: bool) -> np.dtype[Any]:
    """Return the stored type of a number; DEC's floats additionally need `as_float32`."""
    return np.dtype((">" if processor == MIPS else "<") + ("f4" if real else "i2"))


def as_unsigned(integers: NDArray[Any]) -> NDArray[Any]:
    """Return the same bytes as unsigned integers."""
    return integers.view(integers.dtype.str.replace("i", "u"))


def as_float32(values: NDArray[Any], processor: int) -> NDArray[np.float32]:
    """Return the values with DEC's floats converted to IEEE's."""
    if processor != DEC:
        return values
    # DEC swaps the two words of a float; its exponent is larger by two, a factor of 4.
    words = np.ascontiguousarray(values).view("<u2")
    exchanged = words.reshape(-1, 2)[:, ::-1].copy().view("<f4").reshape(values.shape)
    return np.asarray(exchanged / 4, np.float32)


def decode_text(data: bytes) -> str:
    """Return text without padding blanks or zeros; UTF-8, else Latin-1 of older programs."""
    data = data.partition(b"\0")[0]
    try:
        return data.decode().strip()
    except UnicodeDecodeError:
        return data.decode("latin-1").strip()
