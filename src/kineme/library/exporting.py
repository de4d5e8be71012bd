"""What is taken out of a library: tables, answers to questions in SQL, clips of what was found."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from kineme._files import atomic_write
from kineme.errors import MissingDependencyError, ParameterError, WriteError
from kineme.labels.delimited import write_rows
from kineme.library.clusters import cluster_table, clusters_of
from kineme.library.opened import OpenTables
from kineme.library.searching import Hit
from kineme.library.storage.layout import EXTRA, arrow
from kineme.library.storage.tables import DESCRIBED
from kineme.recordings import Motion, Signals
from kineme.segments.table import Segment

CLUSTERS = "clusters"
"""The table that is made of the others when it is asked for."""


def table_called(tables: OpenTables, name: str) -> Any:
    """One of the tables of a library, edits applied, a pyarrow.Table.

    Parameters
    ----------
    tables : OpenTables
    name : str
        One of `kineme.library.storage.tables.DESCRIBED`, or ``clusters``.

    Raises
    ------
    ParameterError
        There is no such table.
    """
    if name == CLUSTERS:
        return cluster_table(clusters_of(tables))
    if name not in DESCRIBED:
        raise ParameterError(
            f"no table {name!r:.40}; there are {', '.join((*DESCRIBED, CLUSTERS))}"
        )
    return tables.table(name)


def answer(tables: OpenTables, sql: str) -> Any:
    """The answer to a question in SQL over all tables of a library, a pyarrow.Table.

    Parameters
    ----------
    tables : OpenTables
    sql : str
        For DuckDB.

    Raises
    ------
    ParameterError
        DuckDB cannot make sense of it.
    MissingDependencyError
        duckdb is not installed.
    """
    try:
        import duckdb
    except ImportError as error:
        raise MissingDependencyError("duckdb", EXTRA) from error
    if not isinstance(sql, str):
        raise ParameterError(f"a question is a text of SQL, not {sql!r:.60}")
    with duckdb.connect() as connection:
        connection.execute("SET enable_external_access = false")
        for name in (*DESCRIBED, CLUSTERS):
            connection.register(name, table_called(tables, name))
        try:
            found = connection.sql(sql)
            if found is None:
                raise ParameterError("this asks for no rows: begin it with select")
            return found.to_arrow_table()
        except duckdb.Error as error:
            raise ParameterError(" ".join(str(error).split())[:400]) from error


def write_table(table: Any, path: str | PathLike[str]) -> None:
    """Write a pyarrow.Table as Parquet, CSV or TSV, by the suffix; text files without embeddings.

    Raises
    ------
    WriteError
        Another suffix, or a place that cannot be written.
    """
    suffix = Path(path).suffix.lower()
    if suffix == ".parquet":
        _, parquet = arrow()
        with atomic_write(path) as draft:
            parquet.write_table(table, draft)
    elif suffix in (".csv", ".tsv"):
        names = [name for name in table.column_names if name != "embedding"]
        rows = zip(*(map(_cell, table.column(name).to_pylist()) for name in names), strict=True)
        with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
            write_rows(file, names, rows, delimiter="," if suffix == ".csv" else "\t")
    else:
        raise WriteError(path, "the suffix must be one of .parquet, .csv, .tsv")


def write_hits(tables: OpenTables, hits: Sequence[Hit], folder: str | PathLike[str]) -> list[Path]:
    """Write what a search found as clips, those of one recording together.

    Parameters
    ----------
    tables : OpenTables
        Of the library that was searched.
    hits : sequence of Hit
    folder : path-like
        To be made; one that is there must be empty.

    Returns
    -------
    list of Path
    """
    from kineme.clips.split import write_clips

    by_recording: dict[str, list[Hit]] = {}
    for hit in hits:
        by_recording.setdefault(hit.recording, []).append(hit)
    wanted = ((tables.read(name), own) for name, own in by_recording.items())
    return write_clips(
        ((seen, [_as_segment(hit, seen) for hit in own]) for seen, own in wanted), folder
    )


def _cell(value: object) -> object:
    """What stands in a table of text: nothing where nothing is known."""
    return "" if value is None or value != value else value  # noqa: PLR0124 (nan)


def _as_segment(hit: Hit, recording: Motion | Signals) -> Segment:
    """A hit in frames of its recording, one at least."""
    fps, n = recording.fps, recording.n_frames
    start = min(round(hit.start_s * fps), n - 1)
    stop = min(max(round(hit.stop_s * fps), start + 1), n)
    return Segment(
        level="primitive",
        kind="primitive",
        start_frame=start,
        stop_frame=stop,
        start_s=start / fps,
        stop_s=stop / fps,
        cluster=hit.cluster,
        activity=-1,
        label=hit.label,
        action=hit.cluster,
    )
