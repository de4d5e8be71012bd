"""Add events to a C3D file: rewrite the parameters of the group EVENT, copy all other bytes.

The parameter section is a list of records, each with the distance to the next one. Records of other
groups, points and analog samples stay unchanged. If the section needs more blocks, the data move
down and three pointers are updated: the header's pointer to the data, POINT:DATA_START, and the
header's pointer to labels and ranges.

Text, integers and floats have the format of the file's processor. An event has a side (CONTEXTS), a
name (LABELS), minutes and seconds (TIMES, counted from frame 1), an icon, and a subject (SUBJECTS).
Events in the header, as older programs write them, are copied to the group, since readers look
there first; they also stay in the header.

Source: Motion Lab Systems, "The C3D file format: a technical user guide" (2021); icons and
descriptions are those of Vicon Nexus.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.errors import WriteError
from kineme.formats.files import FileContent
from kineme.formats.markers.c3d_file import (
    BLOCK,
    DEC,
    MIPS,
    Layout,
    Parameters,
    as_float32,
    get_number_type,
    read_header_events,
    read_parameters,
)

RawRecord = tuple[int, str, bytes]
"""Number of its group (negative if it is the group), name in upper case, and bytes."""

EVENT = "EVENT"
PER_EVENT = ("USED", "CONTEXTS", "LABELS", "DESCRIPTIONS", "TIMES", "SUBJECTS", "ICON_IDS",
             "GENERIC_FLAGS")  # fmt: skip
"""Parameters with one value per event, which are rewritten."""
TEXTS = ("CONTEXTS", "LABELS", "DESCRIPTIONS", "SUBJECTS")
"""Those of `PER_EVENT` that are texts."""
MAX_EVENTS = 255
"""Maximum number of events: a dimension is one byte."""
ICONS = {
    "Foot Strike": (1, "The instant the heel strikes the ground"),
    "Foot Off": (2, "The instant the toe leaves the ground"),
}
"""Icon and description by the label of an event."""
_LABELS_AND_RANGES = 12345
"""Value that marks headers with a pointer to the block of labels and ranges."""


@dataclass(frozen=True)
class C3DEvent:
    """An event: seconds from the first frame of the file, and a label such as ``Foot Strike``.

    The side is ``Left``, ``Right``, ``General``, or empty if unknown. Without a subject, it is the
    first one of the file.
    """

    seconds: float
    side: str
    label: str
    subject: str = ""


def add_events(content: FileContent, events: Sequence[C3DEvent]) -> bytes:
    """Return the bytes of a C3D file with these events in addition to its own."""
    layout = Layout(content)
    layout.frames()  # raises ReadError if the data are missing
    if not layout.rate:
        raise content.error("has no frame rate, so the times of events are unknown")
    table = _collect_events(layout, events)
    if len(table["LABELS"]) > MAX_EVENTS:
        raise WriteError(
            content.path,
            f"cannot take {len(table['LABELS'])} events: a C3D file holds {MAX_EVENTS} at most",
        )
    if not events:
        return content.data
    data = _replace_section(layout, _replace_event_records(layout, table))
    if not _is_kept(layout.parameters, read_parameters(FileContent(content.path, data)), table):
        raise content.error("has overlapping parameter records: it is damaged")
    return data


def _is_kept(before: Parameters, after: Parameters, table: dict[str, list[Any]]) -> bool:
    """Return whether a file still has its parameters, and has these events."""
    # Besides the events only `DATA_START` may change.
    unchanged = (
        key
        for key in before.places
        if key[0] != EVENT or key[1] not in PER_EVENT
        if key != ("POINT", "DATA_START")
    )
    return (
        all(before.stored(*key) == after.stored(*key) for key in unchanged)
        and int(after.number(EVENT, "USED", 0)) == len(table["LABELS"])
        and len(after.numbers(EVENT, "TIMES")) == 2 * len(table["LABELS"])
    )


def _collect_events(layout: Layout, events: Sequence[C3DEvent]) -> dict[str, list[Any]]:
    """Return the values of all events by parameter: those of the file first."""
    parameters, first = layout.parameters, (layout.first_frame - 1) / layout.rate
    # The reader ignores events without a label, too.
    used = min(int(parameters.number(EVENT, "USED", 0)), len(parameters.texts(EVENT, "LABELS")))
    times = parameters.numbers(EVENT, "TIMES")
    pairs = list(zip(times[::2], times[1::2], strict=False))[:used]
    table: dict[str, list[Any]] = {"TIMES": pairs}
    stored: dict[str, list[Any]] = {name: parameters.texts(EVENT, name) for name in TEXTS}
    for name in ("ICON_IDS", "GENERIC_FLAGS"):
        stored[name] = list(map(int, parameters.numbers(EVENT, name, signed=True)))
    for name, values in stored.items():
        missing = [b"" if name in TEXTS else 0] * (len(pairs) - len(values))
        table[name] = values[: len(pairs)] + missing
    first_subject = (parameters.texts("SUBJECTS", "NAMES") or [b""])[0]
    in_header = [] if pairs else read_header_events(layout)
    for event in (*(C3DEvent(at - first, "", name) for at, name in in_header), *events):
        icon, description = ICONS.get(event.label, (0, ""))
        table["TIMES"].append(divmod(event.seconds + first, 60))
        table["CONTEXTS"].append(event.side.encode())
        table["LABELS"].append(event.label.encode())
        table["DESCRIPTIONS"].append(description.encode())
        table["SUBJECTS"].append(event.subject.encode() or first_subject)
        table["ICON_IDS"].append(icon)
        table["GENERIC_FLAGS"].append(1)  # detected, not marked manually
    return table


def _replace_event_records(layout: Layout, table: dict[str, list[Any]]) -> list[RawRecord]:
    """Return all records, with rewritten records of events at the end."""
    parameters, processor = layout.parameters, layout.parameters.processor
    records = _read_records(parameters)
    groups = {-number: name for number, name, _ in records if number < 0}
    number = next((each for each, name in groups.items() if name == EVENT), 0)
    result = [each for each in records if not (each[0] == number > 0 and each[1] in PER_EVENT)]
    # Use the first free number of a group.
    if not number:
        number = next((n for n in range(1, 128) if n not in groups), 0)
        if not number:
            reason = "has 127 groups of parameters already, the maximum, so events cannot be added"
            raise layout.content.error(reason)
        result.append((-number, EVENT, _encode_record(-number, EVENT, b"\0", processor)))
    n = len(table["LABELS"])
    times = np.array(table["TIMES"], np.float32)
    new_records: list[tuple[str, int, list[int], bytes]] = [
        ("USED", 2, [], _encode_integers([n], processor)),
        ("TIMES", 4, [2, n], _encode_reals(times, processor)),
        ("ICON_IDS", 2, [n], _encode_integers(table["ICON_IDS"], processor)),
        ("GENERIC_FLAGS", 1, [n], bytes(each & 255 for each in table["GENERIC_FLAGS"])),
    ]
    for name in TEXTS:
        # All texts of a parameter have the same width, padded with blanks.
        width = max(1, *map(len, table[name]))
        padded = b"".join(each.ljust(width) for each in table[name])
        new_records.append((name, -1, [width, n], padded))
    for name, kind, shape, values in sorted(new_records, key=lambda each: PER_EVENT.index(each[0])):
        body = bytes([kind & 255, len(shape), *shape]) + values + b"\0"  # without a description
        result.append((number, name, _encode_record(number, name, body, processor)))
    return result


def _read_records(parameters: Parameters) -> list[RawRecord]:
    """Return the stored records, each from the length of its name to the start of the next one."""
    data, records = parameters.content.data, []
    for record in parameters.records:
        stop = record.stop
        if stop is None:  # the last record may not state its end
            stop = _find_end(data, record.number, record.values)
        raw = bytearray(data[record.start : stop])
        # Rewrite the distance: it was 0 in the last record.
        raw[record.values - 2 - record.start : record.values - record.start] = _encode_distance(
            stop - (record.values - 2), parameters.processor
        )
        records.append((record.number, record.name, bytes(raw)))
    return records


def _find_end(data: bytes, number: int, values: int) -> int:
    """Return the end of a record whose values or group description start at byte ``values``."""
    if number > 0:
        # Type, number of dimensions, dimensions, values.
        shape = data[values + 2 : values + 2 + data[values + 1]]
        kind = int.from_bytes(data[values : values + 1], signed=True)
        values += 2 + len(shape) + abs(kind) * prod(shape)
    # A description follows, its length first.
    return values + 1 + (data[values] if values < len(data) else 0)


def _encode_record(number: int, name: str, body: bytes, processor: int) -> bytes:
    head = bytes([len(name), number & 255]) + name.encode()
    return head + _encode_distance(len(body) + 2, processor) + body


def _encode_distance(length: int, processor: int) -> bytes:
    return length.to_bytes(2, "big" if processor == MIPS else "little")


def _replace_section(layout: Layout, records: list[RawRecord]) -> bytes:
    """Return the bytes of the file with these records as its parameters."""
    content, parameters = layout.content, layout.parameters
    data, kind = content.data, parameters.processor
    start = parameters.start
    available = layout.start - start
    if available <= 0:
        raise content.error("has its data before its parameters, so events cannot be added")
    last_record = max((record.start for record in parameters.records), default=start)
    # The third byte is the number of blocks of the section.
    size = data[start + 2] * BLOCK
    if not last_record - start < size <= available:  # the count is wrong
        size = available
    # Two zero bytes end the list of records.
    body = b"".join(raw for _, _, raw in records) + bytes(2)
    # Rounded up to whole blocks; the section never shrinks.
    blocks = max(size, -(-(len(body) + 4) // BLOCK) * BLOCK) // BLOCK
    if blocks > 255:
        raise WriteError(content.path, "has no space for this many events in its parameters")
    head = data[start : start + 2] + bytes([blocks, kind])
    section = bytearray((head + body).ljust(blocks * BLOCK, b"\0"))
    grown = blocks - size // BLOCK
    header = bytearray(data[:start])
    # The data move down, so pointers to them grow.
    if grown:
        _move_pointer(header, 2 * 8, kind, grown)
        if header[2 * 147 : 2 * 148] == _encode_integers([_LABELS_AND_RANGES], kind):
            _move_pointer(header, 2 * 148, kind, grown)
        points = {-number for number, name, _ in records if number < 0 and name == "POINT"}
        offset = 4
        for number, name, raw in records:
            if name == "DATA_START" and number in points:
                # Length, group and distance precede the type.
                length = abs(int.from_bytes(raw[:1], signed=True))
                _move_value(section, offset + 4 + length, kind, grown)
            offset += len(raw)
    return bytes(header + section) + data[start + size :]


def _move_value(section: bytearray, values: int, processor: int, by: int) -> None:
    """Add ``by`` blocks to a parameter whose type is at byte ``values`` of the section."""
    offset = values + 2 + section[values + 1]
    if section[values] == 2:
        _move_pointer(section, offset, processor, by)
    elif section[values] == 4:
        kind = get_number_type(processor, real=True)
        stored = np.frombuffer(bytes(section[offset : offset + 4]), kind)
        new_value = as_float32(stored, processor) + by
        section[offset : offset + 4] = _encode_reals(new_value, processor)


def _move_pointer(data: bytearray, offset: int, processor: int, by: int) -> None:
    """Add ``by`` blocks to a pointer of two bytes, unless it is 0 (null)."""
    order: Any = "big" if processor == MIPS else "little"
    block = int.from_bytes(data[offset : offset + 2], order)
    if block:
        data[offset : offset + 2] = (block + by).to_bytes(2, order)


def _encode_integers(values: Sequence[int], processor: int) -> bytes:
    return np.array(values, get_number_type(processor, real=False)).tobytes()


def _encode_reals(values: NDArray[np.float32], processor: int) -> bytes:
    """Return floats in the processor's format; DEC has larger exponents and swapped words."""
    if processor != DEC:
        return values.astype(get_number_type(processor, real=True)).tobytes()
    words = (values * np.float32(4)).astype("<f4").view("<u2").reshape(-1, 2)[:, ::-1]
    return words.tobytes()
