"""The columns of the segment table in ``segments.md``, and its JSON Schema, from the table itself.

    python docs/fill_columns.py

Between the comments ``<!-- columns -->`` and ``<!-- /columns -->`` of the page stands a row for
each column; ``segments.schema.json`` beside it is written anew.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from kineme.labels.json_table import json_schema
from kineme.segments.table import COLUMNS

PAGE = Path(__file__).resolve().parent / "segments.md"
SCHEMA = PAGE.with_suffix(".schema.json")
MARK = re.compile(r"(<!-- columns -->\n).*?(<!-- /columns -->)", re.DOTALL)
WIDTH = 100
TYPES = {str: "text", int: "whole number", float: "number"}


def filled(text: str) -> str:
    """The page with the table of columns."""
    return MARK.sub(lambda mark: f"{mark[1]}\n{rows()}\n\n{mark[2]}", text)


def rows() -> str:
    """The table, a row for each column."""
    lines = ["| column | type | meaning |", "|---|---|---|"]
    for name, column in COLUMNS.items():
        unit = f", {column.unit}" if column.unit else ""
        lines.append(f"| `{name}` | {TYPES[column.type]}{unit} | {column.meaning} |")
    return "\n".join(lines)


def schema() -> str:
    """The JSON Schema as a text."""
    return laid_out(json_schema()) + "\n"


def laid_out(value: Any, indent: int = 0, key: str = "") -> str:
    """JSON with every object and list on one line that fits there."""
    flat = key + json.dumps(value)
    if len(flat) + indent < WIDTH or not isinstance(value, dict | list):
        return flat
    inner = indent + 2
    if isinstance(value, dict):
        parts = [laid_out(part, inner, f"{json.dumps(name)}: ") for name, part in value.items()]
        first, last = "{}"
    else:
        parts = [laid_out(part, inner) for part in value]
        first, last = "[]"
    lines = ",\n".join(f"{' ' * inner}{part}" for part in parts)
    return f"{key}{first}\n{lines}\n{' ' * indent}{last}"


def main() -> None:
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    SCHEMA.write_text(schema(), encoding="utf-8")


if __name__ == "__main__":
    main()
