"""Export from a library: tables, SQL queries, clips of hits, pictures of clusters."""

from __future__ import annotations

import re
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kineme._util.checks import format_count, require_extra
from kineme._util.files import atomic_write
from kineme.errors import KinemeError, ParameterError, WriteError
from kineme.labels.delimited import write_rows
from kineme.library.open_library import Cluster, OpenTables, list_clusters, tabulate_clusters
from kineme.library.searching import Hit
from kineme.library.storage.layout import EXTRA, import_arrow
from kineme.library.storage.tables import DESCRIBED
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import to_samples
from kineme.segments.table import Segment

if TYPE_CHECKING:
    from kineme.plot.sheets import Strip

CLUSTERS = "clusters"
"""Name of the table that is computed from the others on request."""
MOST_STRIPS = 12
"""Largest number of strips in the picture of all clusters."""
ALL = "clusters.png"


def get_table(tables: OpenTables, name: str) -> Any:
    """Return one of `DESCRIBED` or ``clusters`` with edits applied, as a pyarrow.Table."""
    if name == CLUSTERS:
        return tabulate_clusters(list_clusters(tables))
    if name not in DESCRIBED:
        raise ParameterError(
            f"no table {name!r:.40}; there are {', '.join((*DESCRIBED, CLUSTERS))}"
        )
    return tables.table(name)


def run_query(tables: OpenTables, sql: str) -> Any:
    """Return the result of an SQL query over all tables of a library, as a pyarrow.Table."""
    with require_extra("duckdb", EXTRA):
        import duckdb
    if not isinstance(sql, str):
        raise ParameterError(f"a query must be a text of SQL, not {sql!r:.60}")
    with duckdb.connect() as connection:
        connection.execute("SET enable_external_access = false")
        for name in (*DESCRIBED, CLUSTERS):
            connection.register(name, get_table(tables, name))
        try:
            relation = connection.sql(sql)
            if relation is None:
                raise ParameterError("this query returns no rows: begin it with select")
            return relation.to_arrow_table()
        except duckdb.Error as error:
            raise ParameterError(" ".join(str(error).split())[:400]) from error


def write_table(table: Any, path: str | PathLike[str]) -> None:
    """Write a pyarrow.Table as Parquet, CSV or TSV by suffix; text files omit embeddings."""
    suffix = Path(path).suffix.lower()
    if suffix == ".parquet":
        _, parquet = import_arrow()
        with atomic_write(path) as draft:
            parquet.write_table(table, draft)
    elif suffix in (".csv", ".tsv"):
        names = [name for name in table.column_names if name != "embedding"]
        rows = zip(
            *(map(_format_cell, table.column(name).to_pylist()) for name in names), strict=True
        )
        with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
            write_rows(file, names, rows, delimiter="," if suffix == ".csv" else "\t")
    else:
        raise WriteError(path, "the suffix must be one of .parquet, .csv, .tsv")


def write_hits(tables: OpenTables, hits: Sequence[Hit], folder: str | PathLike[str]) -> list[Path]:
    """Write the hits of a search as clips, grouped by recording, to an empty folder."""
    from kineme.clips.split import write_clips

    by_recording: dict[str, list[Hit]] = {}
    for hit in hits:
        by_recording.setdefault(hit.recording, []).append(hit)
    recordings = ((tables.read(name), group) for name, group in by_recording.items())
    return write_clips(
        (
            (recording, [_as_segment(hit, recording) for hit in group])
            for recording, group in recordings
        ),
        folder,
    )


def _format_cell(value: object) -> object:
    """Return the cell of a text table: empty for None and nan."""
    return "" if value is None or value != value else value  # noqa: PLR0124 (nan)


def _as_segment(hit: Hit, recording: Motion | Signals) -> Segment:
    """Return a hit as a segment of its recording, at least one frame long."""
    fps = recording.fps
    start, stop = to_samples((hit.start_s, hit.stop_s), fps, recording.n_frames)
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


def write_pictures(tables: OpenTables, folder: Path) -> list[Path]:
    """Write a picture of each cluster, and one of the clusters with the most seconds.

    Clusters whose recording cannot be read are skipped. The overview is first in the result.
    """
    from kineme.plot.sheets import write_sheet

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WriteError(folder, f"cannot be created: {error.strerror or error}") from error
    strips: list[tuple[Cluster, Motion | Signals]] = []
    written = []
    for cluster in list_clusters(tables):
        try:
            recording = tables.read(cluster.example)
        except KinemeError:  # missing file: go on with the others
            continue
        recording = recording.seconds(cluster.start_s, cluster.stop_s)
        strips.append((cluster, recording))
        path = folder / f"{_make_file_name(cluster)}.png"
        write_sheet([_make_strip(cluster, recording)], path)
        written.append(path)
    if strips:
        write_sheet([_make_strip(*each) for each in strips[:MOST_STRIPS]], folder / ALL)
        written.insert(0, folder / ALL)
    return written


def _make_strip(cluster: Cluster, recording: Motion | Signals) -> Strip:
    """Return the strip of a recording with a title that describes its cluster."""
    from kineme.plot.sheets import Strip

    named = f"{cluster.cluster} {cluster.label}".strip()
    times = cluster.repetitions or cluster.activities
    n = cluster.recordings
    title = (
        f"{named}   {times} × {cluster.typical_s:.2f} s in {format_count(n, 'recording')}; "
        f"here {cluster.example}"
    )
    return Strip(title, recording, cluster.cluster)


def _make_file_name(cluster: Cluster) -> str:
    """Return a portable file name for a cluster, without suffix."""
    label = re.sub(r"[^\w-]+", "-", cluster.label).strip("-")[:40]
    return "-".join(filter(None, [f"cluster-{cluster.cluster}", label]))
