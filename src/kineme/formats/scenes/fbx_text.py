"""Parse FBX text (7.x): ``Name: value, value { nodes }``, arrays as ``*3 { a: 1,2,3 }``.

A semicolon starts a comment. Arrays are parsed on demand.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ReadError
from kineme.formats.files import FileContent
from kineme.formats.scenes.fbx_nodes import FBXNode, require_node_memory

TEXT = re.compile(rb"^(\xef\xbb\xbf)?\s*;\s*FBX\s+\d|^FBXHeaderExtension\s*:", re.MULTILINE)

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


def parse_text(content: FileContent) -> FBXNode:
    """Return the nodes of a text, below one without a name."""
    return _TextParser(content).root


class _TextParser:
    """Parse one token after another."""

    def __init__(self, content: FileContent) -> None:
        self.content = content
        # Offsets count bytes, so the text stays bytes.
        self.data = content.text.encode("utf-8") if content.is_utf16 else content.data
        self.root = FBXNode("")
        self.open_nodes = [self.root]
        self.node: FBXNode | None = None  # the node whose values are being read
        self.count = 0
        self.offset = len(_BOM) if self.data.startswith(_BOM) else 0
        while match := _TOKEN.match(self.data, self.offset):
            self.offset = match.end()
            self._parse_token(match)
        if self.data[self.offset :].strip():
            raise self._make_error(
                f"{self.data[self.offset : self.offset + 40].strip()!r} is not FBX", self.offset
            )
        if len(self.open_nodes) > 1:
            raise content.error(f"the '}}' of {self.open_nodes[-1].name!r:.40} is missing")

    def _make_error(self, reason: str, offset: int) -> ReadError:
        # Count lines only when a message needs them.
        return self.content.error(reason, self.data.count(b"\n", 0, offset) + 1)

    def _parse_token(self, match: re.Match[bytes]) -> None:
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
        array = _TextArray(int(count[:_MAX_DIGITS]), self.data, start.end(), stop)
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


@dataclass(slots=True)
class _TextArray:
    """An array in a text file, parsed on demand."""

    count: int
    data: bytes
    start: int
    stop: int

    def raw(self, _: FileContent) -> bytes:
        return self.data[self.start : self.stop]

    def read(self, content: FileContent) -> NDArray[Any]:
        words = self.raw(content).split(b",")
        line = self.data.count(b"\n", 0, self.start) + 1
        try:
            values = np.array(words, np.float64) if words != [b""] else np.empty(0)
        except ValueError:
            raise content.error("an array contains a value that is not a number", line) from None
        if len(values) != self.count:
            raise content.error(f"{len(values)} numbers in an array of {self.count}", line)
        return values
