"""How the docstrings' ``name : meaning`` becomes what the numpydoc parser reads.

There the word after the colon is a type. Types are in the signatures, so the
parser gets the name alone and the meaning below it, unless it is a shape or type.
"""

from __future__ import annotations

import re
from typing import Any

from griffe import Extension, Object

_ENTRY = re.compile(r"^(?P<name>[\w*, ]+?) : (?P<meaning>.+)$")
_TYPE = re.compile(r"\(.*\)( pairs)?|(str or )?[A-Z]\w+|int|float|str")
_SECTIONS = {"Parameters", "Raises"}


class PlainDocstrings(Extension):
    """Rewrites docstrings as they are loaded."""

    def on_object(self, *, obj: Object, **_: Any) -> None:
        if obj.docstring is not None:
            obj.docstring.value = numpydoc(obj.docstring.value)


def numpydoc(text: str) -> str:
    """The docstring with meanings on lines of their own and its source in bold."""
    text = re.sub(r"^Source\n-+\n", "**Source:** ", text, flags=re.MULTILINE)
    text = re.sub(r"^Source: ", "**Source:** ", text, flags=re.MULTILINE)
    text = re.sub(r":\w+:`[~.]?([\w.]+)`", r"`\1`", text)
    text = re.sub(r"^::\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"::$", ":", text, flags=re.MULTILINE)
    lines: list[str] = []
    section = None
    source = text.splitlines()
    for line, following in zip(source, [*source[1:], ""], strict=True):
        if following.startswith("---") and not line.startswith(" "):
            section = line
        elif line.startswith("**Source:**"):
            section = None
        entry = _ENTRY.match(line) if section in _SECTIONS else None
        if entry is None or _TYPE.fullmatch(entry["meaning"].removesuffix(", optional")):
            lines.append(line)
        else:
            lines += [entry["name"], f"    {entry['meaning']}"]
    return "\n".join(lines)
