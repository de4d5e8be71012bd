"""Parse the nodes of an FBX file of version 7, binary or text.

In a binary file a node is::

    end of the node, number of values, their bytes   each 32 bits; 64 from version 7.5 on
    length of the name, the name                     8 bits
    values                                           a letter for the type, then the value
    nodes                                            up to an empty one

Arrays store their length, whether zlib compressed them, and their bytes. They are parsed on demand,
since most belong to meshes.

Source: the format is not published; A. Gessler and C. Barton, "FBX binary file format
specification", Blender's developer blog, 2013, and files of various programs.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.formats.files import FileContent
from kineme.formats.scenes.fbx_nodes import FBXNode, require_node_memory
from kineme.formats.scenes.fbx_text import parse_text

MAGIC = b"Kaydara FBX Binary  \x00"

OLDEST = 7000
"""Oldest supported version, in thousandths."""

START = 27
"""Offset of the first node of a binary file."""

WIDE = 7500
"""First version with 64 bits in the head of nodes."""

_SCALARS = {
    ord(letter): struct.Struct(f"<{code}")
    for letter, code in zip("YCBIFDL", "hbbifdq", strict=True)
}
_ARRAYS = {
    ord(letter): f"<{code}"
    for letter, code in zip("fdlibc", ("f4", "f8", "i8", "i4", "i1", "i1"), strict=True)
}


def parse_fbx(content: FileContent) -> tuple[int, FBXNode]:
    """Return the version of an FBX file, in thousandths, and its nodes, below a nameless root."""
    if content.data.startswith(MAGIC):
        if len(content.data) < START:
            raise content.error("the file ends in its header: it is truncated")
        # The four bytes before the first node are the version.
        version = int.from_bytes(content.data[START - 4 : START], "little")
        _refuse_old(content, version)
        return version, _parse_binary(content, get_head_struct(version))
    root = parse_text(content)
    header = root.child("FBXHeaderExtension")
    version_node = header.child("FBXVersion") if header else None
    number = version_node.values[0] if version_node and version_node.values else 0
    version = number if isinstance(number, int) else 0
    _refuse_old(content, version)
    return version, root


def _refuse_old(content: FileContent, version: int) -> None:
    if version < OLDEST:
        name = f"FBX {version // 1000}.{version % 1000 // 100}" if version else "an FBX too old"
        raise content.error(
            f"is {name}, a format of before 2011: open it in the program that made it, or in "
            "Autodesk's FBX Converter, and export FBX 2014 (7.4) or later"
        )


def get_head_struct(version: int) -> struct.Struct:
    """Return the struct of the fields before a node's name in a binary file."""
    return struct.Struct("<QQQB" if version >= WIDE else "<IIIB")


def _parse_binary(content: FileContent, head: struct.Struct) -> FBXNode:
    data = content.data
    root = FBXNode("")
    # Use a stack instead of recursion, since nodes may be nested deeply.
    open_nodes: list[tuple[FBXNode, int]] = [(root, len(data))]
    offset, nodes = START, 0
    while open_nodes:
        node, stop = open_nodes[-1]
        if offset == stop and node is not root:
            open_nodes.pop()
            continue
        if offset + head.size > stop:
            raise content.error("ends between two nodes: the file is truncated or damaged")
        end, count, size, length = head.unpack_from(data, offset)
        first, offset = offset, offset + head.size
        # An empty node ends the list of children.
        if end == 0:
            if node is not root and offset != stop:
                raise content.error(
                    f"node {node.name!r:.40} does not have the length it states: damaged"
                )
            open_nodes.pop()
            continue
        start = offset + length
        if not start + size <= end <= stop:
            raise content.error("a node is longer than its parent: truncated or damaged")
        nodes += 1
        require_node_memory(content, nodes)
        name = data[offset:start].decode("utf-8", "replace")
        child = FBXNode(name, _parse_values(content, start, start + size, count), [], first, end)
        node.children.append(child)
        offset = start + size
        # The rest of the node holds its children.
        if offset < end:
            open_nodes.append((child, end))
    return root


def _parse_values(content: FileContent, offset: int, stop: int, count: int) -> list[Any]:
    values: list[Any] = []
    for _ in range(count):
        if offset >= stop:
            raise content.error("a node has fewer values than it states: truncated or damaged")
        try:
            value, offset = _parse_value(content.data, offset)
        except struct.error:
            raise content.error("ends within a value: the file is truncated") from None
        except KeyError:
            kind = chr(content.data[offset])
            raise content.error(f"a value is of the unknown type {kind!r}: damaged") from None
        if offset > stop:
            raise content.error("a value is longer than its node: truncated or damaged")
        values.append(value)
    return values


def _parse_value(data: bytes, offset: int) -> tuple[Any, int]:
    """Return a value and the offset of the next one."""
    kind = data[offset]
    offset += 1
    if scalar := _SCALARS.get(kind):
        return scalar.unpack_from(data, offset)[0], offset + scalar.size
    if kind in b"SR":
        size = int.from_bytes(data[offset : offset + 4], "little")
        raw = data[offset + 4 : offset + 4 + size]
        return raw.decode("utf-8", "replace") if kind == ord("S") else raw, offset + 4 + size
    code = _ARRAYS[kind]
    count, packed, size = struct.unpack_from("<III", data, offset)
    return _BinaryArray(code, count, packed, offset + 12, size), offset + 12 + size


@dataclass(slots=True)
class _BinaryArray:
    """An array in a binary file, parsed on demand."""

    code: str
    count: int
    packed: int
    start: int
    size: int

    def raw(self, content: FileContent) -> bytes:
        return content.data[self.start : self.start + self.size]

    def read(self, content: FileContent) -> NDArray[Any]:
        raw = self.raw(content)
        size = self.count * np.dtype(self.code).itemsize
        if self.packed:
            content.require_memory(size, f"an array of {self.count} numbers")
            try:
                # One more byte reveals an array longer than declared.
                raw = zlib.decompressobj().decompress(raw, size + 1)
            except zlib.error as error:
                raise content.error(f"an array cannot be unpacked: {error}") from None
        if len(raw) != size:
            raise content.error(
                f"an array does not have the {self.count} numbers it states: damaged"
            )
        return np.frombuffer(raw, self.code)
