"""The TypeScript side of the messages, made from the Python one.

    python src/kineme/web/pages/make_messages.py

writes ``src/messages.ts`` beside this file from :mod:`kineme.web.messages`:
the same names in the same order, with their docstrings. A test of the report
fails while the two differ.
"""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType, NoneType, UnionType
from typing import (
    Any,
    Literal,
    NotRequired,
    Union,
    get_args,
    get_origin,
    get_type_hints,
    is_typeddict,
)

from kineme._files import atomic_write
from kineme.web import messages

TARGET = Path(__file__).parent / "src" / "messages.ts"
HEAD = "// Made from src/kineme/web/messages.py by make_messages.py; change it there.\n"
PLAIN = {
    str: "string",
    int: "number",
    float: "number",
    bool: "boolean",
    NoneType: "null",
    Any: "unknown",
}
ALTERNATIVES = {Literal, Union, UnionType}


def typescript(module: ModuleType) -> str:
    """The types of a module as TypeScript: aliases as ``type``, dictionaries as ``interface``."""
    aliases = {
        value: name for name, value in vars(module).items() if get_origin(value) in ALTERNATIVES
    }
    parts = [HEAD]
    for name, value in vars(module).items():
        if is_typeddict(value):
            parts.append(_interface(value, aliases))
        elif get_origin(value) in ALTERNATIVES:
            parts.append(f"export type {name} = {_alternatives(value, aliases)};\n")
    return "\n".join(parts)


def _interface(kind: Any, aliases: dict[Any, str]) -> str:
    lines = [_comment(kind.__doc__ or ""), f"export interface {kind.__name__} {{"]
    for name, hint in get_type_hints(kind, include_extras=True).items():
        needed = get_origin(hint) is not NotRequired
        bare = hint if needed else get_args(hint)[0]
        lines.append(f"  {name}{'' if needed else '?'}: {_type(bare, aliases)};")
    return "\n".join([*lines, "}\n"])


def _type(hint: Any, aliases: dict[Any, str]) -> str:
    """A type as TypeScript has it; TypeError for a kind that messages have not used so far."""
    kind, inner = get_origin(hint), get_args(hint)
    if kind in ALTERNATIVES:
        return aliases.get(hint) or _alternatives(hint, aliases)
    if hint in PLAIN:
        return PLAIN[hint]
    if is_typeddict(hint):
        return str(hint.__name__)
    if kind is list:
        item = _type(inner[0], aliases)
        return f"({item})[]" if " | " in item else f"{item}[]"
    if kind is tuple:
        return f"[{', '.join(_type(member, aliases) for member in inner)}]"
    if kind is dict:
        return f"Record<{_type(inner[0], aliases)}, {_type(inner[1], aliases)}>"
    raise TypeError(f"no TypeScript type is known for {hint!r}: add it here")


def _alternatives(hint: Any, aliases: dict[Any, str]) -> str:
    if get_origin(hint) is Literal:
        return " | ".join(f'"{member}"' for member in get_args(hint))
    return " | ".join(_type(member, aliases) for member in get_args(hint))


def _comment(text: str) -> str:
    """A docstring as a JSDoc comment, its markup as Markdown."""
    text = re.sub(r":\w+:`~?([\w.]+)`", r"`\1`", text.replace("``", "`"))
    lines = [line.strip() for line in text.strip().splitlines()]
    if len(lines) == 1:
        return f"/** {lines[0]} */"
    return "\n".join(["/**", *(f" * {line}".rstrip() for line in lines), " */"])


if __name__ == "__main__":
    with atomic_write(TARGET) as draft:
        draft.write_text(typescript(messages), encoding="utf-8")
