"""Read HDF5 files as variables: groups as dicts, data sets as arrays, lists of texts as lists.

MATLAB files of version 7.3 are HDF5 with their own header. Their arrays have reversed dimensions,
texts are stored as numbers, and cells as references.

Needs h5py. A data set that claims to be larger than the file can hold is rejected.
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from kineme._util.checks import require_extra
from kineme._util.files import shorten_error
from kineme.formats.files import FileContent

SIGNATURE = b"\x89HDF\r\n\x1a\n"
_MAX_DEPTH = 30
_BYTES_PER_LINK = 1000
# Errors that h5py raises on damaged files, depending on the location of the damage.
_DAMAGE = (
    OSError, RuntimeError, LookupError, ValueError, TypeError, AttributeError, SystemError,
    OverflowError, MemoryError,
)  # fmt: skip


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


def collect_texts(value: Any) -> list[str]:
    """Return the texts in a value: a string, fixed-length bytes, or nested lists of these."""
    if isinstance(value, str):
        return [value]
    if isinstance(value, np.ndarray) and value.dtype.kind == "S":
        return [text.decode("utf-8", "replace") for text in value.ravel().tolist()]
    items = value if isinstance(value, list) else []
    return [text for item in items for text in collect_texts(item)]
