"""Read npz and npy files with joint positions, and write motions to npz.

An npz holds named arrays, see `kineme.formats.arrays.named_arrays`. `write_npz` stores all of a
motion except its provenance.

An npy holds positions (frames, joints, 3) without names, or records with named fields as a table.
Pickled objects are rejected, as are archives that claim to unpack to much more than they hold.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from lzma import LZMAError
from pathlib import Path
from tokenize import TokenError
from typing import Any
from warnings import catch_warnings

import numpy as np
from numpy.lib import format as npy_format

from kineme._util.arrays import Array
from kineme._util.files import atomic_write, shorten_error
from kineme.formats.arrays.named_arrays import arrays_to_motion, positions_to_motion
from kineme.formats.columns import columns_to_motion
from kineme.formats.files import FileContent, clean_names
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.recordings import Motion

_MAX_DIMENSIONS = 32
# Errors that numpy raises on damaged headers, which are Python literals.
_HEADER_DAMAGE = (
    ValueError, TypeError, LookupError, AttributeError, SyntaxError, OverflowError, TokenError,
    RecursionError, MemoryError,
)  # fmt: skip


def read_npz(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion in an npz archive."""
    return arrays_to_motion(content, "npz", read_arrays(content), options)


def read_npy(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion in an npy array."""
    array = _parse_array(content, content.data, "the array")
    if array.dtype.names:
        columns = {name: array[name] for name in array.dtype.names}
        return columns_to_motion(content, "npy", columns, options)
    return positions_to_motion(content, "npy", {"positions": array}, options)


def write_npz(motion: Motion, path: Path) -> None:
    """Write all of a motion except its provenance to an npz archive."""
    skeleton = motion.skeleton
    arrays: dict[str, Any] = {
        "positions": motion.positions,
        "fps": motion.fps,
        "names": np.array(clean_names(path, skeleton.names, str)),
        "parents": np.array(skeleton.parents),
        "offsets": skeleton.offsets,
        "end_sites": np.array(sorted(skeleton.end_sites), np.int64),
    }
    if motion.rotations is not None:
        arrays["rotations"] = motion.rotations
    if motion.gaps:
        arrays["gaps"] = np.array(motion.gaps, np.int64)
    with atomic_write(path) as draft, draft.open("wb") as file:
        np.savez(file, **arrays)


def read_arrays(content: FileContent) -> dict[str, Array]:
    """Return the arrays of an npz by name; skip those of objects.

    Raise ReadError if the archive is damaged, or claims to hold much more than it can.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content.data)) as archive:
            infos = archive.infolist()
            size = sum(info.file_size for info in infos)
            content.require_memory(size, f"to unpack to {size / 1e6:.0f} MB")
            arrays = {}
            for info in infos:
                data = archive.read(info)
                if info.filename.endswith(".npy") and not _is_pickled(data):
                    name = info.filename.removesuffix(".npy")
                    arrays[name] = _parse_array(content, data, name)
    except (zipfile.BadZipFile, zlib.error, LZMAError, OSError, EOFError, ValueError) as error:
        raise content.error(f"is not a complete npz archive: {error}") from error
    except (NotImplementedError, RuntimeError) as error:  # other compressions, passwords
        raise content.error(f"its archive cannot be read: {error}") from error
    return arrays


def _is_pickled(data: bytes) -> bool:
    return b"'descr': '|O'" in data[:256]


def _parse_array(content: FileContent, data: bytes, name: str) -> Array:
    """Return the array in the bytes of an npy, as a view of them."""
    file = io.BytesIO(data)
    try:
        is_version_1 = npy_format.read_magic(file) == (1, 0)
        header = (
            npy_format.read_array_header_1_0 if is_version_1 else npy_format.read_array_header_2_0
        )
        with catch_warnings(action="ignore"):  # of headers from Python 2
            shape, fortran, dtype = header(file)
        if dtype.hasobject:
            raise content.error(f"{name} holds pickled objects, which are not read")
        if len(shape) > _MAX_DIMENSIONS:
            raise content.error(f"{name} has {len(shape)} dimensions, more than any recording")
        count = int(np.prod(shape, dtype=object))
        # The header may claim more than the file holds.
        if count < 0 or count * dtype.itemsize > len(data) - file.tell():
            raise content.error(f"{name} claims shape {shape}, more than the file holds")
        if count == 0 or dtype.itemsize == 0:
            return np.empty(0)
        flat = np.frombuffer(data, dtype, count, file.tell())
    except _HEADER_DAMAGE as error:
        raise content.error(f"{name} is not an npy array: {shorten_error(error)}") from error
    return flat.reshape(shape, order="F" if fortran else "C")


NPZ = Format("npz", (".npz",), lambda head: head.startswith(b"PK\x03\x04"), read_npz, write_npz)
NPY = Format("npy", (".npy",), lambda head: head.startswith(b"\x93NUMPY"), read_npy)
