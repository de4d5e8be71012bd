"""Nodes of an FBX file: a tree of names and values, whichever way it is written."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Protocol

from numpy.typing import NDArray

from kineme.formats.files import FileContent

BYTES_PER_NODE = 600
"""What a node takes in memory, with a few values."""


class Stored(Protocol):
    """An array that was left in the file."""

    def raw(self, content: FileContent) -> bytes:
        """Its bytes as they are in the file."""
        ...

    def read(self, content: FileContent) -> NDArray[Any]: ...


@dataclass(slots=True)
class FBXNode:
    """A node: its values are numbers, texts, bytes or arrays in the file.

    ``start`` and ``stop`` are where it is in a binary file, 0 elsewhere.
    """

    name: str
    values: list[Any] = field(default_factory=list)
    children: list[FBXNode] = field(default_factory=list)
    start: int = 0
    stop: int = 0

    def child(self, name: str) -> FBXNode | None:
        """Return the first one of this name."""
        return next(self.all(name), None)

    def all(self, name: str) -> Iterator[FBXNode]:
        return (child for child in self.children if child.name == name)

    def number(self, at: int, usual: float = 0.0) -> float:
        """Return a value as a number; the usual one where there is none."""
        value = self.values[at] if at < len(self.values) else None
        return value if isinstance(value, int | float) else usual

    def text(self, at: int) -> str:
        value = self.values[at] if at < len(self.values) else None
        return value if isinstance(value, str) else ""

    def stored(self, child: str) -> Stored | None:
        """Return the array in a child, as yet in the file; None where there is none."""
        found = self.child(child)
        value = found.values[0] if found and found.values else None
        if value is None or isinstance(value, str | bytes | int | float):
            return None
        stored: Stored = value
        return stored

    def array(self, content: FileContent, child: str) -> NDArray[Any] | None:
        """Return the array in a child; None where there is none."""
        stored = self.stored(child)
        return None if stored is None else stored.read(content)


def require_node_memory(content: FileContent, count: int) -> None:
    """ReadError where so many nodes take more memory than the file can honestly need."""
    if count % 1000 == 0:
        content.require_memory(BYTES_PER_NODE * count, f"{count} nodes")
