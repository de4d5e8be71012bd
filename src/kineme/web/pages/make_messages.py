"""Generate TypeScript types of the messages and of the server's paths.

    python src/kineme/web/pages/make_messages.py

writes ``src/messages.ts`` from `kineme.web.messages`, `kineme.web.requests`,
`kineme.web.annotator_messages`, `kineme.web.library_messages` and `kineme.web.live_messages`, with
the same names and the first paragraphs of docstrings. Generators that start from JSON Schema lose
the names of ``Level`` and ``Edit`` and need another node package; this one reads
``msgspec.inspect``. ``src/studio/server/paths.ts`` has the paths of `kineme.studio`. A test fails
if the generated files are out of date.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from types import ModuleType, UnionType
from typing import Any, Literal, get_origin

from msgspec import NODEFAULT, Struct, inspect
from starlette.routing import Route

from kineme._util.files import atomic_write
from kineme.segments.table import COLUMNS, Kind, Level
from kineme.studio.library import LibraryApi
from kineme.studio.routes import Api
from kineme.web import annotator_messages, library_messages, live_messages, messages, requests

SOURCES = Path(__file__).parent / "src"
HEAD = "// Made from kineme/web (messages, requests) by make_messages.py; change them there.\n"
REQUIRED_DEFAULTS = {str: "activity", int: 0, float: 0.0}
"""Values of required columns in an empty row."""
BARE_ROW = {
    name: REQUIRED_DEFAULTS[column.type] if column.default is None else column.default
    for name, column in COLUMNS.items()
}
"""An empty row: column defaults, or `REQUIRED_DEFAULTS`."""
PLAIN_TYPES: dict[Any, str] = {
    inspect.StrType: "string",
    inspect.IntType: "number",
    inspect.FloatType: "number",
    inspect.BoolType: "boolean",
    inspect.NoneType: "null",
    inspect.AnyType: "unknown",
}
"""TypeScript names of types without parameters."""


def format_typescript(named: dict[str, Any]) -> str:
    """Return a module with these types: unions and literals as ``type``, structs as ``interface``.

    ``named`` are the types by name, in the order they are to have.
    """
    aliases = {name: inspect.type_info(kind) for name, kind in named.items() if _is_alias(kind)}
    return "\n".join(
        [
            HEAD,
            *(
                f"export type {name} = {_format_alternatives(aliases[name], aliases)};\n"
                if name in aliases
                else _format_interface(kind, aliases)
                for name, kind in named.items()
            ),
        ]
    )


def list_types(*modules: ModuleType) -> dict[str, Any]:
    """Return the message types and unions in these modules, by name, without base classes."""
    return {
        name: kind
        for module in modules
        for name, kind in vars(module).items()
        if isinstance(kind, UnionType) or _is_message(kind)
    }


def _is_alias(kind: Any) -> bool:
    return isinstance(kind, UnionType) or get_origin(kind) is Literal


def _is_message(kind: Any) -> bool:
    return _is_struct(kind) and bool(kind.__struct_fields__ or not kind.__subclasses__())


def _is_struct(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, Struct)


def _format_interface(kind: Any, aliases: dict[str, inspect.Type]) -> str:
    info: Any = inspect.type_info(kind)
    lines = [_format_comment(kind.__doc__ or ""), f"export interface {kind.__name__} {{"]
    if _is_struct(kind) and info.tag is not None:
        lines.append(f'  {info.tag_field}: "{info.tag}";')
    for field in info.fields:
        text = _format_type(field.type, aliases)
        # Dataclasses are sent with all fields except unset ones, which have no default here.
        may_lack = not field.required and (_is_struct(kind) or field.default is NODEFAULT)
        null = " | null" if kind is messages.Segment and _is_nan(BARE_ROW.get(field.name)) else ""
        lines.append(f"  {field.encode_name}{'?' if may_lack else ''}: {text}{null};")
    return "\n".join([*lines, "}\n"])


def _is_nan(value: Any) -> bool:
    return isinstance(value, float) and math.isnan(value)  # null in JSON


def _format_bare_row() -> str:
    """Return an empty row as a TypeScript constant."""
    cells = "".join(
        f"  {name}: {json.dumps(None if _is_nan(value) else value)},\n"
        for name, value in BARE_ROW.items()
    )
    return (
        "/** A row of which nothing is known. */\n"
        f"export const bareSegment: Segment = {{\n{cells}}};\n"
    )


def _format_type(info: Any, aliases: dict[str, inspect.Type]) -> str:
    """Return a type as TypeScript; TypeError for kinds that no message has used so far."""
    for name, known in aliases.items():
        if info == known:
            return name
    plain = next((text for kind, text in PLAIN_TYPES.items() if isinstance(info, kind)), None)
    if plain is not None:
        return plain
    if isinstance(info, inspect.StructType | inspect.DataclassType):
        return info.cls.__name__
    if isinstance(info, inspect.LiteralType | inspect.UnionType):
        return _format_alternatives(info, aliases)
    return _format_container(info, aliases)


def _format_container(info: Any, aliases: dict[str, inspect.Type]) -> str:
    if isinstance(info, inspect.ListType | inspect.VarTupleType):
        item = _format_type(info.item_type, aliases)
        return f"({item})[]" if " | " in item else f"{item}[]"
    if isinstance(info, inspect.TupleType):
        return f"[{', '.join(_format_type(member, aliases) for member in info.item_types)}]"
    if isinstance(info, inspect.DictType):
        key, value = _format_type(info.key_type, aliases), _format_type(info.value_type, aliases)
        return f"Record<{key}, {value}>"
    raise TypeError(f"no TypeScript type is known for {info!r}: add it here")


def _format_alternatives(info: Any, aliases: dict[str, inspect.Type]) -> str:
    if isinstance(info, inspect.LiteralType):
        return " | ".join(f'"{value}"' for value in info.values)
    return " | ".join(_format_type(member, aliases) for member in info.types)


def _format_comment(text: str) -> str:
    """Return the first paragraph of a docstring as a JSDoc comment with Markdown."""
    first = text.strip().split("\n\n")[0]
    first = re.sub(r":\w+:`~?([\w.]+)`", r"`\1`", first.replace("``", "`"))
    lines = [line.strip() for line in first.splitlines()]
    if len(lines) == 1:
        return f"/** {lines[0]} */"
    return "\n".join(["/**", *(f" * {line}" for line in lines), " */"])


def format_messages() -> str:
    """Return the content of ``messages.ts``."""
    table_types = {"Level": Level, "Kind": Kind, "Segment": messages.Segment}
    types = list_types(messages, requests, annotator_messages, library_messages, live_messages)
    return f"{format_typescript(table_types | types)}\n{_format_bare_row()}"


def format_paths() -> str:
    """Return the content of ``studio/server/paths.ts``."""
    unused: Any = None  # routes can be listed without a server
    routes = [*Api(unused, unused).routes(), *LibraryApi(unused, unused).routes()]
    return (
        "// Made from the routes of kineme/studio by make_messages.py; change them there.\n\n"
        "/** Paths of GET requests; names in braces are filled in. */\n"
        f"export type GetPath ={_format_path_union(routes, 'GET')};\n\n"
        "/** Paths of POST requests. */\n"
        f"export type PostPath ={_format_path_union(routes, 'POST')};\n"
    )


def _format_path_union(routes: list[Route], method: str) -> str:
    paths = sorted(route.path for route in routes if method in (route.methods or ()))
    # Without the catch-all route.
    return "".join(f'\n  | "{path}"' for path in paths if ":" not in path)


def make_files() -> dict[Path, str]:
    """Return the generated files and their content."""
    return {
        SOURCES / "messages.ts": format_messages(),
        SOURCES / "studio" / "server" / "paths.ts": format_paths(),
    }


if __name__ == "__main__":
    for target, text in make_files().items():
        with atomic_write(target) as draft:
            draft.write_text(text, encoding="utf-8")
