"""Segments in JSON, schema ``kineme.segments/2``, and in Parquet with the same schema.

One object:

    {
      "schema": "kineme.segments/2",
      "n_frames": 1200,            frames of the source file, at least 1
      "fps": 120.0,                frames per second of the source file
      "provenance": {...},         as in Segmentation
      "timings": {"graph": 0.02},  seconds per stage
      "annotation": {...},         edits by people, if any
      "hierarchy": {               if there are several details: all, ascending
        "detail": 1.0,             that of "segments"
        "levels": [                each with its table by columns, except that of "segments"
          {"detail": 0.5, "columns": {"level": ["activity"], "kind": ["activity"], ...}},
          {"detail": 1.0}
        ]
      },
      "segments": [                one object per row, ordered by level, then time
        {"level": "activity", "kind": "activity", "start_frame": 0, "stop_frame": 600,
         "start_s": 0.0, "stop_s": 5.0, "cluster": -1, "activity": 0, "label": "",
         "confidence": null, "action": -1, "border_confidence": null}
      ]
    }

The columns are those of `kineme.segments.table`; unknown numbers are ``null``. Readers must ignore
unknown names; the number in the schema increases with changes that old readers would misread.

A Parquet file holds the table's columns without an index; everything but "segments" is JSON in its
metadata under the key ``kineme.segments``.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from kineme._util.checks import require_extra
from kineme._util.files import atomic_write
from kineme._util.json import decode_json
from kineme.errors import ReadError
from kineme.formats.channels.parquet import open_parquet, read_parquet_columns
from kineme.formats.files import load
from kineme.labels.delimited import read_first_bytes, read_last_bytes
from kineme.labels.registry import LabelFormat
from kineme.segments.annotation import Annotation
from kineme.segments.editing.annotating import assign_comments, set_comments_by_row
from kineme.segments.hierarchy import Hierarchy
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, COMMENT, Segment, SegmentTable, find_lacking, sort_rows

SCHEMA = "kineme.segments/2"
INDEPENDENT = tuple(name for name, column in COLUMNS.items() if not column.derived)
"""Columns stored for tables at other details; the rest is derived from these."""
KEY = b"kineme.segments"


def write(_: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write everything to a JSON file."""
    with atomic_write(path) as draft:
        draft.write_text(dumps(segmentation), encoding="utf-8")


def dumps(segmentation: Segmentation) -> str:
    """Return the JSON text: an indented head, and one line per segment."""
    content = make_head(segmentation)
    levels = content.get("hierarchy", {}).pop("levels", [])
    # Levels and rows are inserted before the closing braces, one per line.
    head = json.dumps(content, indent=2).removesuffix("\n}")
    if levels:
        lines = ",\n".join(f"      {json.dumps(level)}" for level in levels)
        head = head.removesuffix("\n  }") + f',\n    "levels": [\n{lines}\n    ]\n  }}'
    rows = ",\n".join(f"    {json.dumps(row)}" for row in _make_rows(segmentation.table))
    return f'{head},\n  "segments": [\n{rows}\n  ]\n}}\n'


def as_object(segmentation: Segmentation) -> dict[str, Any]:
    """Return the content of the JSON text as Python objects."""
    return make_head(segmentation) | {"segments": [*_make_rows(segmentation.table)]}


def read(path: Path) -> Segmentation:
    """Read a segmentation from a JSON file."""
    return loads(path.read_bytes(), path)


def loads(content: bytes, path: Path) -> Segmentation:
    """Parse a segmentation from JSON; ``path`` is used in errors."""
    data = parse(content.decode("utf-8-sig"), path)
    rows = data.get("segments")
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise ReadError(path, '"segments" must be a list of objects')
    for number, row in enumerate(rows):
        missing = find_lacking(row)
        if missing:
            raise ReadError(path, f"segment {number} has no {missing[0]!r}")
    # Missing cells get the default of their column.
    columns = {
        name: _replace_null([row.get(name, column.default) for row in rows], name)
        for name, column in COLUMNS.items()
    }
    return join_head(columns, data, path)


def make_head(segmentation: Segmentation) -> dict[str, Any]:
    """Return everything but the table for JSON."""
    head = {
        "schema": SCHEMA,
        "n_frames": segmentation.n_frames,
        "fps": segmentation.fps,
        "provenance": segmentation.provenance,
        "timings": segmentation.timings,
    }
    if annotation := segmentation.annotation.to_json():
        head["annotation"] = annotation
    if segmentation.hierarchy is not None:
        head["hierarchy"] = _make_levels(segmentation.hierarchy)
    return head


def parse(text: str, path: Path) -> dict[str, Any]:
    """Parse a JSON object; raise ReadError if this version cannot read its schema."""
    data = decode_json(text, path)
    schema = data.get("schema") if isinstance(data, dict) else None
    if not isinstance(data, dict) or not str(schema).startswith("kineme.segments/"):
        raise ReadError(path, 'is not a segment table: it has no "schema": "kineme.segments/..."')
    if schema != SCHEMA:
        raise ReadError(
            path,
            f"has schema {schema!r:.40}, but this version of kineme reads {SCHEMA!r}: upgrade it",
        )
    return data


def join_head(columns: dict[str, Any], head: dict[str, Any], path: Path) -> Segmentation:
    """Return the segmentation of a table and a head from `make_head`."""
    n_frames, fps = head.get("n_frames"), head.get("fps")
    if type(n_frames) is not int:
        raise ReadError(path, f'"n_frames" must be a whole number, not {n_frames!r:.40}')
    if not isinstance(fps, int | float) or not 0 < fps < 1e9:
        raise ReadError(path, f'"fps" must be a positive number, not {fps!r:.40}')
    notes = {name: head.get(name, {}) for name in ("provenance", "timings")}
    for name, value in notes.items():
        if not isinstance(value, dict):
            raise ReadError(path, f'"{name}" must be an object, not {value!r:.40}')
    segmentation = Segmentation.from_columns(
        columns,
        n_frames=n_frames,
        fps=fps,
        provenance=notes["provenance"],
        timings=notes["timings"],
        annotation=Annotation.from_json(head.get("annotation", {})),
    )
    if "hierarchy" not in head:
        return segmentation
    try:
        return replace(segmentation, hierarchy=_parse_hierarchy(head["hierarchy"], segmentation))
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise ReadError(path, f'"hierarchy" is not valid: {error}') from error


def _make_levels(hierarchy: Hierarchy) -> dict[str, Any]:
    """Return a hierarchy for JSON."""
    levels: list[dict[str, Any]] = []
    for detail, table in zip(hierarchy.details, hierarchy.tables, strict=True):
        levels.append({"detail": detail})
        if detail != hierarchy.detail:
            columns = table.columns()
            levels[-1]["columns"] = {name: _list_values(columns[name]) for name in INDEPENDENT}
    return {"detail": hierarchy.detail, "levels": levels}


def _parse_hierarchy(data: dict[str, Any], found: Segmentation) -> Hierarchy:
    """Return the hierarchy from the output of `_make_levels`."""
    tables = {}
    for level in data["levels"]:
        columns = level.get("columns")
        if columns is None:
            tables[level["detail"]] = found.table
            continue
        columns = {name: _replace_null(values, name) for name, values in columns.items()}
        tables[level["detail"]] = Segmentation.from_columns(
            columns, n_frames=found.n_frames, fps=found.fps
        ).table
    return Hierarchy(tuple(tables), tuple(tables.values()), data["detail"])


def _replace_null(values: list[Any], name: str) -> list[Any]:
    """Replace None by nan in a column of numbers."""
    if COLUMNS[name].type is not float:
        return values
    return [math.nan if value is None else value for value in values]


def _make_rows(table: SegmentTable) -> Iterator[dict[str, Any]]:
    """Yield one object per row."""
    columns = [_list_values(column) for column in table.columns().values()]
    return (dict(zip(COLUMNS, cells, strict=True)) for cells in zip(*columns, strict=True))


def _list_values(column: NDArray[Any]) -> list[Any]:
    """Return the cells of a column with None for nan."""
    values: list[Any] = column.tolist()
    if column.dtype.kind != "f":
        return values
    return [None if value != value else value for value in values]  # noqa: PLR0124 (nan)


FORMAT = LabelFormat(
    name="json",
    help="Everything in one file",
    suffixes=(".json",),
    holds="all",
    read=read,
    write=write,
    recognises=lambda path: b'"kineme.segments/' in read_first_bytes(path),
)


def write_parquet(_: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write everything to a Parquet file."""
    with require_extra("pyarrow", "tables"):
        import pyarrow as pa
        from pyarrow import parquet
    columns: dict[str, Any] = {**segmentation.table.columns()}
    columns |= segmentation.more_columns()
    if any(comments := assign_comments(segmentation)):
        columns[COMMENT] = comments
    table = pa.table(columns)
    table = table.replace_schema_metadata({KEY: json.dumps(make_head(segmentation)).encode()})
    with atomic_write(path) as draft:
        parquet.write_table(table, draft)


def read_parquet(path: Path) -> Segmentation:
    """Read a segmentation from a Parquet file."""
    content = load(path)
    file = open_parquet(content)
    metadata = file.schema_arrow.metadata or {}
    names = file.schema_arrow.names
    if KEY not in metadata or find_lacking(names):
        raise ReadError(path, "is a Parquet file, but not a segment table written by kineme")
    head = parse(metadata[KEY].decode(errors="replace"), path)
    present = [name for name in COLUMNS if name in names]
    table = read_parquet_columns(content, file, present)
    columns = {name: table.column(name).to_numpy() for name in present}
    segmentation = join_head(columns, head, path)
    if COMMENT not in names:
        return segmentation
    comments = read_parquet_columns(content, file, [COMMENT]).column(COMMENT).to_pylist()
    texts = [str(comments[row] or "") for row in sort_rows(columns)]
    return set_comments_by_row(segmentation, texts)


PARQUET = LabelFormat(
    name="parquet",
    help="Everything, for pandas and others",
    suffixes=(".parquet",),
    holds="all",
    read=read_parquet,
    write=write_parquet,
    recognises=lambda path: KEY in read_last_bytes(path),
)
