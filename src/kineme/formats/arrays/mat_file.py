"""Parse MAT files of version 5 (MATLAB 5 to 7.2, written by -v6 and -v7).

The file starts with 128 bytes of text and the byte order. Elements follow: type, size and as many
bytes, padded to eight. An element of type 15 holds another one, compressed. An array has flags,
dimensions and a name, followed by its numbers, characters, cells or fields. Sparse arrays, objects,
tables and functions are skipped.

No more memory is allocated than the file holds, arrays are views of its bytes, and all damage
raises the same error. `scipy.io.loadmat` copies the data (0.4 s for 86 MB); on 700 damaged files it
requested more than 3 GB once and raised errors from OSError to UnboundLocalError.

Source: The MathWorks, "MAT-File Format", R2023a.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from kineme._util.arrays import Array
from kineme.formats.files import FileContent

Bytes = memoryview
Value = Any
"""An array of numbers, a text, a list of cells, or a dict of fields."""

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_NUMBERS = {
    1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8",
}  # fmt: skip
_TEXTS = {16: "utf-8", 17: "utf-16", 18: "utf-32"}
_CELL, _STRUCT, _CHAR, _NUMERIC = 1, 2, 4, range(6, 16)
_COMPLEX = 0x08
_MAX_DIMENSIONS = 32
_MAX_DEPTH = 30  # nesting of structures


class _DamagedError(ValueError):
    """Raised if a file contradicts itself."""


def parse_mat(content: FileContent) -> dict[str, Value]:
    """Return the variables of a MAT file by name; raise ReadError if it is damaged."""
    data = memoryview(content.data)
    order = {b"IM": "<", b"MI": ">"}.get(bytes(data[126:128]))
    if len(data) < _HEADER or order is None:
        raise content.error("is not a MAT file of version 5: save it with -v7 or as CSV")
    budget = content.memory_limit
    variables: dict[str, Value] = {}
    try:
        for kind, body in _split_elements(data[_HEADER:], order):
            if kind == _COMPRESSED:
                unpacked = _unpack(body, budget)
                budget -= len(unpacked)
                kind, body = next(_split_elements(unpacked, order), (0, memoryview(b"")))  # noqa: PLW2901
            if kind == _MATRIX:
                name, value = _parse_array(body, order, 0)
                if name and value is not None:
                    variables[name] = value
    except (_DamagedError, zlib.error) as error:
        raise content.error(f"is not a complete MAT file: {error}") from None
    return variables


def _unpack(body: Bytes, budget: int) -> Bytes:
    engine = zlib.decompressobj()
    # Unpack at most the budget; a remaining tail shows that the element is larger.
    unpacked = engine.decompress(body, max(1, budget))
    if engine.unconsumed_tail:
        raise _DamagedError("it claims to unpack far more than it contains")
    return memoryview(unpacked)


def _split_elements(data: Bytes, order: str) -> Iterator[tuple[int, Bytes]]:
    """Yield type and bytes of each element."""
    offset = 0
    while offset + 8 <= len(data):
        first, size = np.frombuffer(data, f"{order}u4", 2, offset).tolist()
        if first >> 16:  # a small element: four bytes of size and type, four of data
            kind, size, start, step = first & 0xFFFF, first >> 16, offset + 4, 8
            if size > 4:
                raise _DamagedError(f"a small element of {size} bytes")
        else:
            kind, start = first, offset + 8
            # Elements are padded to eight bytes, except compressed ones.
            step = 8 + (size if kind == _COMPRESSED else -(-size // 8) * 8)
        if start + size > len(data):
            raise _DamagedError(
                f"an element of {size} bytes, but only {len(data) - start} are left"
            )
        yield kind, data[start : start + size]
        offset += step


def _parse_array(body: Bytes, order: str, depth: int) -> tuple[str, Value]:
    """Return name and value of an array; the value is None for kinds that are skipped."""
    if not body:
        return "", np.empty((0, 0))
    if depth > _MAX_DEPTH:
        raise _DamagedError("its structures are nested too deeply")
    parts = _split_elements(body, order)
    flags, shape = (
        _parse_counts(_read_element(parts), order),
        _parse_counts(_read_element(parts), order),
    )
    name = bytes(_read_element(parts)[1]).decode("utf-8", "replace")
    if not flags or not shape or min(shape) < 0 or len(shape) > _MAX_DIMENSIONS:
        raise _DamagedError("an array without flags or dimensions")
    # The class of the array is in the low byte of its flags.
    kind, is_complex = flags[0] & 0xFF, flags[0] >> 8 & _COMPLEX
    if kind in _NUMERIC and not is_complex:
        return name, _reshape(_parse_numbers(*_read_element(parts), order), shape)
    if kind == _CHAR:
        return name, _parse_text(*_read_element(parts), shape, order)
    if kind == _CELL:
        return name, [_parse_array(part, order, depth + 1)[1] for _, part in parts]
    if kind == _STRUCT:
        return name, _parse_fields(parts, shape, order, depth)
    return name, None


def _read_element(parts: Iterator[tuple[int, Bytes]]) -> tuple[int, Bytes]:
    element = next(parts, None)
    if element is None:
        raise _DamagedError("an array is truncated")
    return element


def _parse_numbers(kind: int, data: Bytes, order: str) -> Array:
    if kind not in _NUMBERS:
        raise _DamagedError(f"numbers of the unknown type {kind}")
    number = np.dtype(order + _NUMBERS[kind])
    return np.frombuffer(data, number, len(data) // number.itemsize)


def _parse_counts(part: tuple[int, Bytes], order: str) -> list[int]:
    values = _parse_numbers(*part, order)
    if values.dtype.kind not in "iu":
        raise _DamagedError("flags or dimensions that are not whole numbers")
    return [int(value) for value in values.tolist()]


def _reshape(flat: Array, shape: list[int]) -> Array:
    count = 1
    for n in shape:
        count *= n
    if count != len(flat):
        raise _DamagedError(f"{len(flat)} numbers for an array of shape {tuple(shape)}")
    # MATLAB stores columns first.
    return flat.reshape(shape, order="F")


def _parse_text(kind: int, data: Bytes, shape: list[int], order: str) -> Value:
    """Return a text; for several rows, a list of texts without trailing blanks."""
    if kind in _TEXTS:
        coding = _TEXTS[kind] + ("" if kind == 16 else "-le" if order == "<" else "-be")
        letters = list(bytes(data).decode(coding, "replace"))
    else:
        letters = [
            chr(int(code)) if 0 < code < 0xD800 else " "
            for code in _parse_numbers(kind, data, order)
        ]
    # Characters are stored column by column: every n-th belongs to one row.
    rows = shape[0]
    if rows <= 1 or len(letters) % rows:
        return "".join(letters)
    return ["".join(letters[row::rows]).rstrip() for row in range(rows)]


def _parse_fields(
    parts: Iterator[tuple[int, Bytes]], shape: list[int], order: str, depth: int
) -> Value:
    """Return the fields of a structure by name; of an array of structures, those of the first."""
    width = _parse_counts(_read_element(parts), order)
    names = bytes(_read_element(parts)[1])
    if len(width) != 1 or width[0] < 1 or 0 in shape:
        return {}
    step = width[0]
    keys = [
        # All names have the same width, padded with zero bytes.
        names[i : i + step].split(b"\0")[0].decode("utf-8", "replace")
        for i in range(0, len(names), step)
    ]
    return {key: _parse_array(_read_element(parts)[1], order, depth + 1)[1] for key in keys}
