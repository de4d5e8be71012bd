"""Read MAT files of MATLAB: variables with joint positions, exports of QTM, or channels.

Variables are named arrays, see `kineme.formats.arrays.numpy_files`. If the file holds exactly one
structure, its fields count as variables.

QTM (Qualisys) exports a structure with ``FrameRate`` and ``Trajectories.Labeled.Data`` (markers, 4,
frames) and ``Labels``, in millimetres with z up.

A file of version 5 (MATLAB 5 to 7.2, written by -v6 and -v7) starts with 128 bytes of text and the
byte order. Elements follow: type, size and as many bytes, padded to eight. An element of type 15
holds another one, compressed. An array has flags, dimensions and a name, followed by its numbers,
characters, cells or fields. Sparse arrays, objects, tables and functions are skipped.

No more memory is allocated than the file holds, arrays are views of its bytes, and all damage
raises the same error. `scipy.io.loadmat` copies the data (0.4 s for 86 MB); on 700 damaged files it
requested more than 3 GB once and raised errors from OSError to UnboundLocalError.

Files of version 7.3 are HDF5 with their own header, and need h5py. Their arrays have reversed
dimensions, texts are stored as numbers, and cells as references. Groups become dicts, data sets
arrays, lists of texts lists. A data set that claims to be larger than the file can hold is
rejected.

Source: The MathWorks, "MAT-File Format", R2023a.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import prod
from typing import Any

import numpy as np

from kineme._util.arrays import Array
from kineme._util.checks import require_extra
from kineme._util.files import shorten_error
from kineme.formats.arrays.numpy_files import Arrays, arrays_to_motion, find_common_length
from kineme.formats.channels.reading import (
    ChannelTable,
    list_needed_columns,
    make_channel_table,
    select_columns,
    to_signals,
)
from kineme.formats.dialects import hold_channels
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.registry import Format
from kineme.recordings import Motion, Signals
from kineme.recordings.column_names import is_body
from kineme.recordings.times import is_timing

Bytes = memoryview
Value = Any
"""An array of numbers, a text, a list of cells, or a dict of fields."""

SIGNATURE = b"\x89HDF\r\n\x1a\n"
_MAX_DEPTH = 30
_BYTES_PER_LINK = 1000
# Errors that h5py raises on damaged files, depending on the location of the damage.
_DAMAGE = (
    OSError, RuntimeError, LookupError, ValueError, TypeError, AttributeError, SystemError,
    OverflowError, MemoryError,
)  # fmt: skip
_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_NUMBERS = {
    1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8",
}  # fmt: skip
_TEXTS = {16: "utf-8", 17: "utf-16", 18: "utf-32"}
_CELL, _STRUCT, _CHAR, _NUMERIC = 1, 2, 4, range(6, 16)
_COMPLEX = 0x08
_MAX_DIMENSIONS = 32
_RATES = (
    "fps", "fs", "rate", "frame_rate", "framerate", "samplerate", "sampling_rate", "frequency",
)  # fmt: skip


def read_mat(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """Return the motion in a MAT file, or its channels if it holds no joints."""
    variables = read_variables(content)
    labeled = _find_labeled(variables)
    if labeled is not None and not options.channels:
        return _read_qtm(content, *labeled, options)
    arrays = to_arrays(variables)
    if options.channels or _hold_channels(arrays):
        table = arrays_to_channels(content, arrays, options.columns or None)
        return to_signals(content, "MAT", table, options.fps)
    return arrays_to_motion(content, "MAT", arrays, options)


def read_variables(content: FileContent) -> dict[str, Any]:
    """Return the variables of a MAT file of any version, by name."""
    # Version 7.3 puts a header of 512 bytes before the HDF5 signature.
    is_hdf5 = content.data.startswith(SIGNATURE) or content.data[512:520] == SIGNATURE
    variables = parse_hdf5(content) if is_hdf5 else parse_mat(content)
    if not variables:
        raise content.error(
            "it has no readable variable: export tables and objects with writetable"
        )
    return variables


def to_arrays(variables: Mapping[str, Any]) -> dict[str, Array]:
    """Return numbers and texts as arrays; drop MATLAB's second dimension of vectors and scalars."""
    structures = [value for value in variables.values() if isinstance(value, Mapping)]
    # The fields of a single structure count as variables.
    if len(structures) == 1:
        variables = {**structures[0], **variables}
    arrays: dict[str, Array] = {}
    for name, value in variables.items():
        if isinstance(value, np.ndarray) and value.dtype.kind in "iufb":
            # MATLAB has no vectors: they are matrices of one row or column.
            single = value.ndim == 2 and 1 in value.shape
            arrays[name] = value.ravel() if single and value.size > 1 else value
            arrays[name] = arrays[name].reshape(()) if value.size == 1 else arrays[name]
        elif words := collect_texts(value):
            arrays[name] = np.array(words)
    return arrays


def collect_texts(value: Any) -> list[str]:
    """Return the texts in a value: a string, fixed-length bytes, or nested lists of these."""
    if isinstance(value, str):
        return [value]
    if isinstance(value, np.ndarray) and value.dtype.kind == "S":
        return [text.decode("utf-8", "replace") for text in value.ravel().tolist()]
    items = value if isinstance(value, list) else []
    return [text for item in items for text in collect_texts(item)]


def arrays_to_channels(
    content: FileContent, arrays: Arrays, columns: Sequence[str] | None
) -> ChannelTable:
    """Return the named channels in a MAT file's arrays, or those of the most frequent length.

    Each column of a matrix is a channel, ``NAME_1`` and so on; the longer side is time.
    """
    rates = {name.lower(): array for name, array in arrays.items() if array.ndim == 0}
    rate = next((float(rates[key]) for key in _RATES if key in rates), None)
    channels: dict[str, Array] = {}
    for name, array in arrays.items():
        if array.dtype.kind not in "iufb" or array.size == 0:
            continue
        if array.ndim == 1:
            channels[name] = array
        elif array.ndim == 2:
            tracks = array.T if len(array) >= array.shape[1] else array
            channels |= {f"{name}_{i}": track for i, track in enumerate(tracks, 1)}
    length = find_common_length(channels)
    times = {name: name for name in channels if is_timing(name)}
    columns = select_columns(content, list(channels), columns, list(channels), times)
    if columns:
        length = len(channels[columns[0]])
    as_long = [name for name, channel in channels.items() if len(channel) == length]
    chosen = list_needed_columns(columns, as_long, times)
    for name in chosen:
        if name not in as_long:
            raise content.error(
                f"column {name!r} is not as long as {chosen[0]!r}: choose columns of one rate"
            )
    values = {name: np.asarray(channels[name], np.float64) for name in chosen}
    table = make_channel_table(content, as_long, values, columns, times)
    others = [name for name in channels if name not in as_long]
    if columns is None and others:
        note = f"left out, since their length differs: {', '.join(others)}"
        table = replace(table, notes=(*table.notes, note))
    has_rate = rate is not None and np.isfinite(rate) and rate > 0
    return replace(table, rate=rate) if has_rate else table


def _hold_channels(arrays: Arrays) -> bool:
    """Return whether no array holds positions of joints, by names and shapes."""
    if {"poses", "positions"} & arrays.keys():
        return False
    flat = [name for name, array in arrays.items() if array.ndim <= 1]
    tracks = (name for name, a in arrays.items() if a.ndim == 2 and a.shape[1] == 3)
    return hold_channels(flat) and not any(map(is_body, tracks))


def _find_labeled(
    variables: Mapping[str, Any],
) -> tuple[Mapping[str, Any], Mapping[str, Any]] | None:
    """Return QTM's structure and its labelled trajectories, or None."""
    for value in variables.values():
        item = value
        for key in ("Trajectories", "Labeled"):
            item = item.get(key) if isinstance(item, Mapping) else None
        if isinstance(item, Mapping) and {"Data", "Labels"} <= item.keys():
            return value, item
    return None


def _read_qtm(
    content: FileContent, head: Mapping[str, Any], labeled: Mapping[str, Any], options: ReadOptions
) -> Motion:
    """Return the markers of an export of QTM; see the module's docstring."""
    names, data = collect_texts(labeled["Labels"]), labeled["Data"]
    if not isinstance(data, np.ndarray) or data.dtype.kind not in "iuf" or data.ndim != 3:
        raise content.error(
            "Trajectories.Labeled.Data must be numbers of shape (markers, 4, frames)"
        )
    if len(names) != data.shape[0] or data.shape[1] < 3 or 0 in data.shape:
        raise content.error(f"{len(names)} Labels for Data of shape {data.shape}")
    rate = head.get("FrameRate")
    stated = float(rate.ravel()[0]) if isinstance(rate, np.ndarray) and rate.size == 1 else 0.0
    fps = content.choose_rate(options.fps, stated, "it has no FrameRate")
    # Markers, axes, frames become frames, markers, axes; the fourth number is a residual.
    positions = np.asarray(data[:, :3], np.float64).transpose(2, 0, 1)
    points = Points(
        names,
        positions,
        fps,
        options.unit,
        options.up,
        stated_unit="mm",
        usual_up="z",
        person=options.person,
    )
    return to_motion(points, content.provenance("MAT of QTM", []))


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


class _DamagedError(ValueError):
    """Raised if a file contradicts itself."""


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
    flags, shape = (_parse_counts(_read_element(parts), order) for _ in range(2))
    name = bytes(_read_element(parts)[1]).decode("utf-8", "replace")
    if not flags or not shape or min(shape) < 0 or len(shape) > _MAX_DIMENSIONS:
        raise _DamagedError("an array without flags or dimensions")
    # The class of the array is in the low byte of its flags.
    kind, is_complex = flags[0] & 0xFF, flags[0] >> 8 & _COMPLEX
    if kind in _NUMERIC and not is_complex:
        flat = _parse_numbers(*_read_element(parts), order)
        if prod(shape) != len(flat):
            raise _DamagedError(f"{len(flat)} numbers for an array of shape {tuple(shape)}")
        return name, flat.reshape(shape, order="F")  # MATLAB stores columns first
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
    counts: list[int] = values.tolist()
    return counts


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
    fields = {}
    # All names have the same width, padded with zero bytes.
    for i in range(0, len(names), width[0]):
        key = names[i : i + width[0]].split(b"\0")[0].decode("utf-8", "replace")
        fields[key] = _parse_array(_read_element(parts)[1], order, depth + 1)[1]
    return fields


def parse_hdf5(content: FileContent) -> dict[str, Any]:
    """Return the contents of an HDF5 file by name; raise ReadError if it is damaged."""
    with require_extra("h5py", "hdf5"):
        import h5py
    try:
        with h5py.File(io.BytesIO(content.data), "r") as file:
            return _HDF5Reader(content, file).read_group(file, 0)
    except _DAMAGE as error:
        raise content.error(f"is not a complete HDF5 file: {shorten_error(error)}") from error


class _HDF5Reader:
    """Read groups and data sets within the memory limit of the file."""

    def __init__(self, content: FileContent, file: Any) -> None:
        self.content, self.file = content, file
        self.required = 0
        self.open: list[Any] = []  # the groups above the one being read

    def require_memory(self, size: int) -> None:
        self.required += size
        self.content.require_memory(self.required, "to unpack far more than it contains")

    def read_group(self, group: Any, depth: int) -> dict[str, Any]:
        """Return the contents of a group; they count again for every link to it."""
        import h5py

        if depth > _MAX_DEPTH:
            raise ValueError("its groups are nested too deeply")
        if group in self.open:
            raise ValueError(f"its group {group.name!r:.60} contains a link to itself")
        self.open.append(group)
        contents: dict[str, Any] = {}
        for name in group:
            if name.startswith("#"):  # targets of MATLAB's references
                continue
            link = group.get(name, getlink=True)
            if not isinstance(link, h5py.HardLink):  # soft links may be circular or leave the file
                continue
            self.require_memory(_BYTES_PER_LINK)
            contents[name] = self.read_value(group[name], depth)
        self.open.pop()
        return contents

    def read_value(self, item: Any, depth: int) -> Any:
        import h5py

        if isinstance(item, h5py.Group):
            return self.read_group(item, depth + 1)
        if not isinstance(item, h5py.Dataset) or item.shape is None:
            return None
        # Python integers do not overflow with absurd shapes.
        self.require_memory(int(np.prod(item.shape, dtype=object)) * max(1, item.dtype.itemsize))
        if item.attrs.get("MATLAB_empty", 0):
            return np.empty((0, 0))
        if h5py.check_ref_dtype(item.dtype) is not None:
            return self.read_cells(item, depth)
        return _read_dataset(item)

    def read_cells(self, item: Any, depth: int) -> list[Any]:
        """Return the values that the references of a data set point to."""
        if depth > _MAX_DEPTH:
            raise ValueError("its cells are nested too deeply")
        # Skip empty references.
        return [self.read_value(self.file[ref], depth + 1) for ref in np.ravel(item[()]) if ref]


def _read_dataset(item: Any) -> Any:
    """Return a data set of numbers or texts; None for other kinds."""
    import h5py

    if h5py.check_string_dtype(item.dtype) is not None:
        lines = np.atleast_1d(item.asstr(errors="replace")[()]).ravel()
        return [str(line) for line in lines]
    array = np.asarray(item[()])
    # Skip arrays of other kinds, such as compounds.
    if array.dtype.kind not in "iufbS":
        return None
    matlab_class = item.attrs.get("MATLAB_class", b"")
    if matlab_class == b"char":
        # MATLAB stores columns first, so HDF5's columns are its rows.
        rows = ["".join(map(chr, row)) for row in np.atleast_2d(array.T).tolist()]
        return rows[0] if len(rows) == 1 else [row.rstrip() for row in rows]
    return array.T if matlab_class else array


FORMAT = Format("MAT", (".mat",), lambda head: head.startswith(b"MATLAB "), read_mat, channels=True)
