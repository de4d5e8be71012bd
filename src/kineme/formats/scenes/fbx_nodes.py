"""Represent the nodes of an FBX file, binary or text: a tree of names and values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Protocol

from numpy.typing import NDArray

from kineme.formats.files import FileContent

BYTES_PER_NODE = 600
"""Bytes of memory of a node with a few values."""


class StoredArray(Protocol):
    """An array that is parsed on demand."""

    def raw(self, content: FileContent) -> bytes:
        """Return its bytes in the file."""
        ...

    def read(self, content: FileContent) -> NDArray[Any]: ...


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
        if value is None or isinstance(value, str | bytes | int | float):
            return None
        stored: StoredArray = value
        return stored

    def array(self, content: FileContent, child: str) -> NDArray[Any] | None:
        """Return the array in a child, None if there is none."""
        stored = self.stored(child)
        return None if stored is None else stored.read(content)


def require_node_memory(content: FileContent, count: int) -> None:
    """Raise ReadError if so many nodes need more memory than the file can plausibly need."""
    if count % 1000 == 0:  # checking each node would be slow
        content.require_memory(BYTES_PER_NODE * count, f"{count} nodes")
