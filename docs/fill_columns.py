"""The columns of the segment table in ``segments.md``, and its JSON Schema, from the table itself.

    python docs/fill_columns.py

Between the comments ``<!-- columns -->`` and ``<!-- /columns -->`` of the page stands a row for
each column; ``segments.schema.json`` beside it is written anew.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from kineme.labels.json_table import INDEPENDENT, SCHEMA
from kineme.segments.table import COLUMNS, Column, lacking

PAGE = Path(__file__).resolve().parent / "segments.md"
PLACE = PAGE.with_suffix(".schema.json")
MARK = re.compile(r"(<!-- columns -->\n).*?(<!-- /columns -->)", re.DOTALL)
WIDTH = 100
TYPES = {str: "text", int: "whole number", float: "number"}
ABOUT = (
    "The segments of a recording. The confidence of a row is the probability that what its kind "
    "claims is right: of an activity its cluster, of a primitive the number of repetitions of its "
    "activity; transitions and events have none. The border_confidence is the probability that it "
    "starts where it says. With the published presets, and for labels from a knowledge base, the "
    "confidence is a share and no probability."
)
"""The head of the schema."""


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


def json_schema() -> dict[str, Any]:
    """The JSON Schema of such a file, its columns as the table declares them."""
    columns = {name: _schema_of(column) for name, column in COLUMNS.items()}
    text, number, names = {"type": "string"}, {"type": "number"}, {"type": ["string", "null"]}
    provenance = {
        "kineme": text,
        "preset": text,
        "parameters": {"type": "object"},
        "input": _object({"path": names, "format": names, "sha256": names}),
        "notes": {"type": "array", "items": text},
    }
    positive = {"type": "number", "exclusiveMinimum": 0}
    needed = [name for name in INDEPENDENT if COLUMNS[name].default is None] + ["cluster"]
    lists = {"type": "object", "required": needed, "additionalProperties": {"type": "array"}}
    level = _object({"detail": positive, "columns": lists}, required=["detail"])
    levels = {"type": "array", "minItems": 1, "items": level}
    head = {
        "schema": {"const": SCHEMA},
        "n_frames": {"type": "integer", "minimum": 1},
        "fps": positive,
        "provenance": _object(provenance),
        "timings": {"type": "object", "additionalProperties": number},
    }
    of, count = {"enum": [*COLUMNS["level"].allowed]}, {"type": "integer", "minimum": 0}
    span = {"type": "array", "prefixItems": [of, count, count], "minItems": 3}
    comment = {"type": "array", "prefixItems": [of, count, text], "minItems": 3}
    annotation = {
        "checked": {"type": "array", "items": span},
        "by_hand": {"type": "array", "items": span},
        "comments": {"type": "array", "items": comment},
        "cluster_names": {"type": "object", "additionalProperties": text},
        "corrections": count,
        "excluded": {"type": "array", "items": count},
    }
    rows = {"type": "array", "minItems": 1, "items": _object(columns, required=lacking(()))}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": SCHEMA,
        "description": ABOUT,
        **_object(
            {
                **head,
                "annotation": _object(annotation),
                "hierarchy": _object(
                    {"detail": positive, "levels": levels}, required=["detail", "levels"]
                ),
                "segments": rows,
            },
            required=[*head, "segments"],
        ),
    }


def _object(properties: dict[str, Any], *, required: Sequence[str] = ()) -> dict[str, Any]:
    need = {"required": [*required]} if required else {}
    return {"type": "object", **need, "properties": properties}


def _schema_of(column: Column) -> dict[str, Any]:
    """The schema of a cell."""
    kinds: dict[Any, str] = {str: "string", int: "integer", float: "number"}
    kind: str | list[str] = kinds[column.type]
    if column.type is float and column.default is not None:  # null where nothing is known
        kind = [kinds[float], "null"]
    cell: dict[str, Any] = {"enum": [*column.allowed]} if column.allowed else {"type": kind}
    if column.least is not None:
        cell["minimum"] = column.least
    unit = {"unit": column.unit} if column.unit else {}
    return {"description": column.meaning, **cell, **unit}


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
    PLACE.write_text(schema(), encoding="utf-8")


if __name__ == "__main__":
    main()
