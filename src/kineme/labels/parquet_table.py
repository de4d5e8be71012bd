"""Segments as Parquet: the table's columns as they are, no index.

Frame rate, provenance and timings are JSON in the file's metadata under the
key ``kineme.segments``, with the schema of `kineme.labels.json_table`.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from kineme._util.checks import require_extra
from kineme._util.files import atomic_write
from kineme.errors import ReadError
from kineme.formats.channels.parquet import parquet_columns, parquet_file
from kineme.formats.files import load
from kineme.labels.delimited import tail
from kineme.labels.json_table import head_of, join_head, parse
from kineme.labels.registry import LabelFormat
from kineme.segments.editing.annotating import assign_comments, from_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import (
    COLUMNS,
    COMMENT,
    Segment,
    lacking,
)

KEY = b"kineme.segments"


def write(_: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Leave everything at ``path``."""
    with require_extra("pyarrow", "tables"):
        import pyarrow as pa
        from pyarrow import parquet
    columns: dict[str, Any] = {**segmentation.table.columns()}
    columns |= segmentation.more_columns()
    if any(comments := assign_comments(segmentation)):
        columns[COMMENT] = comments
    table = pa.table(columns)
    table = table.replace_schema_metadata({KEY: json.dumps(head_of(segmentation)).encode()})
    with atomic_write(path) as draft:
        parquet.write_table(table, draft)


def read(path: Path) -> Segmentation:
    """Return the segmentation at ``path``."""
    content = load(path)
    file = parquet_file(content)
    metadata = file.schema_arrow.metadata or {}
    names = file.schema_arrow.names
    if KEY not in metadata or lacking(names):
        raise ReadError(path, "is a Parquet file, but not a segment table written by kineme")
    head = parse(metadata[KEY].decode(errors="replace"), path)
    present = [name for name in COLUMNS if name in names]
    table = parquet_columns(content, file, present)
    columns = {name: table.column(name).to_numpy() for name in present}
    found = join_head(columns, head, path)
    if COMMENT not in names:
        return found
    comments = parquet_columns(content, file, [COMMENT]).column(COMMENT).to_pylist()
    return from_rows(found, [str(text or "") for text in comments])


FORMAT = LabelFormat(
    name="parquet",
    help="Everything, for pandas and others",
    suffixes=(".parquet",),
    holds="all",
    read=read,
    write=write,
    recognises=lambda path: KEY in tail(path),
)
