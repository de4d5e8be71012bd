"""Parse the nodes of an FBX file of version 7, binary or text: a tree of names and values.

In a binary file a node is::

    end of the node, number of values, their bytes   each 32 bits; 64 from version 7.5 on
    length of the name, the name                     8 bits
    values                                           a letter for the type, then the value
    nodes                                            up to an empty one

Arrays store their length, whether zlib compressed them, and their bytes. In a text file a node is
``Name: value, value { nodes }``, an array ``*3 { a: 1,2,3 }``, and a semicolon starts a comment.
Arrays are parsed on demand, since most belong to meshes.

Source: the format is not published; A. Gessler and C. Barton, "FBX binary file format
specification", Blender's developer blog, 2013, and files of various programs.
"""

from __future__ import annotations

import re
import struct
import zlib
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ReadError
from kineme.formats.files import FileContent

BYTES_PER_NODE = 600
"""Bytes of memory of a node with a few values."""
MAGIC = b"Kaydara FBX Binary  \x00"
TEXT = re.compile(rb"^(\xef\xbb\xbf)?\s*;\s*FBX\s+\d|^FBXHeaderExtension\s*:", re.MULTILINE)
OLDEST = 7000
"""Oldest supported version, in thousandths."""
START = 27
"""Offset of the first node of a binary file."""
WIDE = 7500
"""First version with 64 bits in the head of nodes."""

_TOKEN = re.compile(
    rb"""\s*+ (?: ; [^\n]*+ \s*+ )*+ (?:
    (?P<text> "[^"]*" ) | (?P<name> [^\s,{}":;*]++ ) [ \t]*+ : | (?P<mark> [{},] ) |
    \* (?P<count> \d+ ) | (?P<word> [^\s,{}":;*]+ ) )""",
    re.VERBOSE,
)
_ARRAY = re.compile(rb"\s*\{\s*a\s*:")
_ESCAPES = ((b"&quot;", b'"'), (b"&lf;", b"\n"), (b"&cr;", b"\r"))
_BOM = b"\xef\xbb\xbf"
_MAX_DIGITS = 40  # of a number
_SCALARS = {
    kind: struct.Struct(f"<{code}") for kind, code in zip(b"YCBIFDL", "hbbifdq", strict=True)
}
_ARRAYS = dict(zip(b"fdlibc", ("<f4", "<f8", "<i8", "<i4", "<i1", "<i1"), strict=True))


@dataclass(slots=True)
class StoredArray(ABC):
    """An array in the bytes of a file from ``start`` to ``stop``, parsed on demand."""

    content: FileContent
    count: int
    start: int
    stop: int

    @property
    def raw(self) -> bytes:
        return self.content.data[self.start : self.stop]

    @abstractmethod
    def read(self) -> NDArray[Any]: ...


@dataclass(slots=True)
class FBXNode:
    """A node whose values are numbers, texts, bytes or arrays in the file.

    ``start`` and ``stop`` are its offsets in a binary file, else 0.
    """

    name: str
    values: list[Any] = field(default_factory=list)
    children: list[FBXNode] = field(default_factory=list)
    start: int = 0
    stop: int = 0

    def child(self, name: str) -> FBXNode | None:
        """Return the first child of this name, or None."""
        return next(self.all(name), None)

    def all(self, name: str) -> Iterator[FBXNode]:
        return (child for child in self.children if child.name == name)

    def number(self, index: int, default: float = 0.0) -> float:
        """Return a value as a number, ``default`` if it is not one."""
        value = self.values[index] if index < len(self.values) else None
        return value if isinstance(value, int | float) else default

    def text(self, index: int) -> str:
        value = self.values[index] if index < len(self.values) else None
        return value if isinstance(value, str) else ""

    def stored(self, child: str) -> StoredArray | None:
        """Return the unparsed array in a child, None if there is none."""
        node = self.child(child)
        value = node.values[0] if node and node.values else None
        return value if isinstance(value, StoredArray) else None

    def array(self, child: str) -> NDArray[Any] | None:
        """Return the array in a child, None if there is none."""
        stored = self.stored(child)
        return None if stored is None else stored.read()


def parse_fbx(content: FileContent) -> tuple[int, FBXNode]:
    """Return the version of an FBX file, in thousandths, and its nodes, below a nameless root."""
    if content.data.startswith(MAGIC):
        if len(content.data) < START:
            raise content.error("the file ends in its header: it is truncated")
        # The four bytes before the first node are the version.
        version = int.from_bytes(content.data[START - 4 : START], "little")
        _refuse_old(content, version)
        return version, _parse_binary(content, get_head_struct(version))
    # Offsets count bytes, so the text stays bytes.
    utf8 = FileContent(content.path, content.text.encode()) if content.is_utf16 else content
    root = _TextParser(utf8).root
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


def require_node_memory(content: FileContent, count: int) -> None:
    """Raise ReadError if so many nodes need more memory than the file can plausibly need."""
    if count % 1000 == 0:  # checking each node would be slow
        content.require_memory(BYTES_PER_NODE * count, f"{count} nodes")


def get_head_struct(version: int) -> struct.Struct:
    """Return the struct of the fields before a node's name in a binary file."""
    return struct.Struct("<QQQB" if version >= WIDE else "<IIIB")


def _parse_binary(content: FileContent, head: struct.Struct) -> FBXNode:
    """Return the root of a binary file; ``head`` is the layout of what precedes each node."""
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
        values = _parse_values(content, start, start + size, count)
        child = FBXNode(name, values, start=first, stop=end)
        node.children.append(child)
        offset = start + size
        # The rest of the node holds its children.
        if offset < end:
            open_nodes.append((child, end))
    return root


def _parse_values(content: FileContent, offset: int, stop: int, count: int) -> list[Any]:
    """Return the ``count`` values of a node, which lie before ``stop``."""
    values: list[Any] = []
    for _ in range(count):
        if offset >= stop:
            raise content.error("a node has fewer values than it states: truncated or damaged")
        try:
            value, offset = _parse_value(content, offset)
        except struct.error:
            raise content.error("ends within a value: the file is truncated") from None
        except KeyError as error:
            kind = chr(error.args[0])
            raise content.error(f"a value is of the unknown type {kind!r}: damaged") from None
        if offset > stop:
            raise content.error("a value is longer than its node: truncated or damaged")
        values.append(value)
    return values


def _parse_value(content: FileContent, offset: int) -> tuple[Any, int]:
    """Return a value and the offset of the next one."""
    data = content.data
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
    stop = offset + 12 + size
    return _BinaryArray(content, count, offset + 12, stop, code, packed), stop


@dataclass(slots=True)
class _BinaryArray(StoredArray):
    code: str
    packed: int

    def read(self) -> NDArray[Any]:
        raw, size = self.raw, self.count * np.dtype(self.code).itemsize
        if self.packed:
            self.content.require_memory(size, f"an array of {self.count} numbers")
            try:
                # One more byte reveals an array longer than declared.
                raw = zlib.decompressobj().decompress(raw, size + 1)
            except zlib.error as error:
                raise self.content.error(f"an array cannot be unpacked: {error}") from None
        if len(raw) != size:
            reason = f"an array does not have the {self.count} numbers it states: damaged"
            raise self.content.error(reason)
        return np.frombuffer(raw, self.code)


class _TextParser:
    """Parse one token after another."""

    def __init__(self, content: FileContent) -> None:
        self.content, self.data = content, content.data
        self.root = FBXNode("")
        self.open_nodes = [self.root]
        self.node: FBXNode | None = None  # the node whose values are being read
        self.count = 0
        self.offset = len(_BOM) if self.data.startswith(_BOM) else 0
        while match := _TOKEN.match(self.data, self.offset):
            self.offset = match.end()
            self._parse_token(match)
        if self.data[self.offset :].strip():
            word = self.data[self.offset : self.offset + 40].strip()
            raise self._make_error(f"{word!r} is not FBX", self.offset)
        if len(self.open_nodes) > 1:
            raise content.error(f"the '}}' of {self.open_nodes[-1].name!r:.40} is missing")

    def _make_error(self, reason: str, offset: int) -> ReadError:
        # Count lines only when a message needs them.
        return self.content.error(reason, self.content.line_at(offset))

    def _parse_token(self, match: re.Match[bytes]) -> None:
        """Add a token to the node that is open, or open or close one."""
        kind = match.lastgroup or ""
        value, offset = match[kind], match.start(kind)
        if kind == "name":
            self.node = FBXNode(value.decode("utf-8", "replace"))
            self.open_nodes[-1].children.append(self.node)
            self.count += 1
            require_node_memory(self.content, self.count)
        elif value == b"}" and kind == "mark":
            if len(self.open_nodes) == 1:
                raise self._make_error("there is one '}' too many", offset)
            self.open_nodes.pop()
            self.node = None
        elif self.node is None:
            raise self._make_error(f"a name expected, found {value[:40]!r}", offset)
        elif value == b"{" and kind == "mark":
            self.open_nodes.append(self.node)
            self.node = None
        elif kind == "count":
            self.node.values.append(self._parse_array(value))
            self.node = None
        elif kind == "text":
            self.node.values.append(_unquote(value))
        elif kind == "word":
            self.node.values.append(_parse_word(value))

    def _parse_array(self, count: bytes) -> _TextArray:
        """Return the array that starts here, and skip it."""
        start, stop = _ARRAY.match(self.data, self.offset), self.data.find(b"}", self.offset)
        if start is None or stop < 0:
            raise self._make_error("an array without its numbers", self.offset)
        array = _TextArray(self.content, int(count[:_MAX_DIGITS]), start.end(), stop)
        self.offset = stop + 1
        return array


def _unquote(quoted: bytes) -> str:
    raw = quoted[1:-1]
    for escape, letter in _ESCAPES:
        raw = raw.replace(escape, letter)
    return raw.decode("utf-8", "replace")


def _parse_word(word: bytes) -> int | float | str:
    for number in (int, float):
        try:
            # Limit the digits: converting millions of them takes long.
            return number(word[:_MAX_DIGITS])
        except ValueError:
            continue
    return word.decode("utf-8", "replace")


class _TextArray(StoredArray):
    __slots__ = ()

    def read(self) -> NDArray[Any]:
        words, line = self.raw.split(b","), self.content.line_at(self.start)
        try:
            values = np.array(words, np.float64) if words != [b""] else np.empty(0)
        except ValueError:
            reason = "an array contains a value that is not a number"
            raise self.content.error(reason, line) from None
        if len(values) != self.count:
            reason = f"{len(values)} numbers in an array of {self.count}"
            raise self.content.error(reason, line)
        return values
