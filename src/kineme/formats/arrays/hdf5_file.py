"""HDF5 files as variables by name: groups are dicts, data sets arrays, lists of texts lists.

MATLAB's files of version 7.3 are HDF5 with a header of their own; their arrays
have their dimensions the other way round, texts are numbers, cells references.

Needs h5py. A data set that claims more than the file can hold is refused.
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from kineme._util.checks import require_extra
from kineme._util.files import shorten_error
from kineme.formats.files import FileContent

SIGNATURE = b"\x89HDF\r\n\x1a\n"
_DEEPEST = 30
_BYTES_PER_LINK = 1000
# What h5py raises on damaged files, depending on where the damage is.
_DAMAGE = (
    OSError, RuntimeError, LookupError, ValueError, TypeError, AttributeError, SystemError,
    OverflowError, MemoryError,
)  # fmt: skip


def parse_hdf5(content: FileContent) -> dict[str, Any]:
    """Return the contents of an HDF5 file by name; ReadError where it is none or damaged."""
    with require_extra("h5py", "hdf5"):
        import h5py
    try:
        with h5py.File(io.BytesIO(content.data), "r") as file:
            return _Reader(content, file).group(file, 0)
    except _DAMAGE as error:
        raise content.error(f"is no whole HDF5 file: {shorten_error(error)}") from error


class _Reader:
    """Reads groups and data sets while there is room for what they claim."""

    def __init__(self, content: FileContent, file: Any) -> None:
        self.content, self.file = content, file
        self.required = 0
        self.open: list[Any] = []  # the groups that the one being read is in

    def require_memory(self, size: int) -> None:
        self.required += size
        self.content.require_memory(self.required, "to unpack to much more than it holds")

    def group(self, group: Any, depth: int) -> dict[str, Any]:
        """Return what lies in a group, each time that it is linked to."""
        import h5py

        if depth > _DEEPEST:
            raise ValueError("groups too deep in one another")
        if group in self.open:
            raise ValueError(f"its group {group.name!r:.60} is linked into itself")
        self.open.append(group)
        found: dict[str, Any] = {}
        for name in group:
            if name.startswith("#"):  # MATLAB's references
                continue
            link = group.get(name, getlink=True)
            if not isinstance(link, h5py.HardLink):  # to other files, or in a circle
                continue
            self.require_memory(_BYTES_PER_LINK)
            found[name] = self.value(group[name], depth)
        self.open.pop()
        return found

    def value(self, item: Any, depth: int) -> Any:
        import h5py

        if isinstance(item, h5py.Group):
            return self.group(item, depth + 1)
        if not isinstance(item, h5py.Dataset) or item.shape is None:
            return None
        # Python integers, which do not overflow with absurd shapes.
        self.require_memory(int(np.prod(item.shape, dtype=object)) * max(1, item.dtype.itemsize))
        if item.attrs.get("MATLAB_empty", 0):
            return np.empty((0, 0))
        if h5py.check_ref_dtype(item.dtype) is not None:
            return self.cells(item, depth)
        return _read_dataset(item)

    def cells(self, item: Any, depth: int) -> list[Any]:
        """Return what the references of a data set point to."""
        if depth > _DEEPEST:
            raise ValueError("cells too deep in one another")
        # Empty references are left out.
        return [self.value(self.file[ref], depth + 1) for ref in item[()].ravel() if ref]


def _read_dataset(item: Any) -> Any:
    """Return a data set of numbers or texts; None if of anything else."""
    import h5py

    if h5py.check_string_dtype(item.dtype) is not None:
        lines = np.atleast_1d(item.asstr(errors="replace")[()]).ravel()
        return [str(line) for line in lines]
    array = np.asarray(item[()])
    # Arrays of other kinds, such as compounds, are passed over.
    if array.dtype.kind not in "iufbS":
        return None
    matlab = item.attrs.get("MATLAB_class", b"")
    if matlab == b"char":
        # MATLAB stores its columns first, so rows are columns here.
        rows = ["".join(map(chr, row)) for row in np.atleast_2d(array.T).tolist()]
        return rows[0] if len(rows) == 1 else [row.rstrip() for row in rows]
    return array.T if matlab else array


def collect_texts(value: Any) -> list[str]:
    """Return the texts in a value, whether a list of them, one, or fixed-length bytes."""
    if isinstance(value, str):
        return [value]
    if isinstance(value, np.ndarray) and value.dtype.kind == "S":
        return [text.decode("utf-8", "replace") for text in value.ravel().tolist()]
    items = value if isinstance(value, list) else []
    return [text for item in items for text in collect_texts(item)]
