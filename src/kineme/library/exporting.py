"""Export from a library: tables, SQL queries, clips of hits, best loops, coverage and pictures.

Loops of all recordings are ranked by the same cost as those of one recording. Near duplicates of a
better loop are left out: their poses (head, hands and feet relative to the pelvis) are within
`NEAR_M` at some phase of the cycle, and durations differ by at most `NEAR_SHARE`.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Unpack, get_args

import numpy as np

from kineme._util.arrays import Floats, interpolate_frames
from kineme._util.checks import format_count, is_one_of, require_extra, warn
from kineme._util.files import atomic_write
from kineme.clips.loops import PHASES, LoopQuality
from kineme.clips.options import ClipOptions, resolve_options
from kineme.clips.root_motion import DIRECTIONS, measure_travel
from kineme.clips.shaping import RankedLoop, find_planted_feet, measure_loops
from kineme.errors import KinemeError, ParameterError, WriteError
from kineme.features import compute_body_frame, end_effectors
from kineme.labels.delimited import write_rows
from kineme.library.finding import Hit
from kineme.library.open_library import Cluster, OpenTables, list_clusters, tabulate_clusters
from kineme.library.storage.layout import BODIES, EXTRA, import_arrow
from kineme.library.storage.tables import DESCRIBED
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import to_samples
from kineme.recordings.operations import cut
from kineme.segments.table import COLUMNS, Segment, SegmentTable

if TYPE_CHECKING:
    from kineme.plot.strips import Strip

Per = Literal["cluster", "direction", "recording"]
"""Groups from which the best loops are chosen: clusters, or directions or recordings in them."""
NEAR_M = 0.03
"""RMS distance of five points in metres below which two loops are the same movement."""
NEAR_SHARE = 0.1
"""Largest difference in duration of two such loops, as a fraction of the longer one."""
CLUSTERS = "clusters"
"""Name of the table that is computed from the others on request."""
MOST_STRIPS = 12
"""Largest number of strips in the picture of all clusters."""
ALL = "clusters.png"
TABLE_SUFFIXES = (".parquet", ".csv", ".tsv")
"""Suffixes of exported tables."""


class Coverage(NamedTuple):
    """Activities of one cluster in one direction of travel.

    Attributes
    ----------
    cluster : int
        -1 for activities in no cluster.
    label, direction : str
        The name of the cluster; one of `kineme.clips.root_motion.DIRECTIONS`.
    clips : int
        Activities.
    seconds : float
        Total duration.
    slowest_m_s, fastest_m_s : float
        Lowest and highest mean speed over the floor.
    left_deg, right_deg : float
        Largest turn to either side, 0 if there is none.
    starts, stops : int
        Number of clips in which the body starts from standing, or stops.
    """

    cluster: int
    label: str
    direction: str
    clips: int
    seconds: float
    slowest_m_s: float
    fastest_m_s: float
    left_deg: float
    right_deg: float
    starts: int
    stops: int


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
                raise ParameterError("this statement is not a query: begin it with select")
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
        raise WriteError(path, f"the suffix must be one of {', '.join(TABLE_SUFFIXES)}")


def _format_cell(value: object) -> object:
    """Return the cell of a text table: empty for None and nan."""
    return "" if value is None or value != value else value  # noqa: PLR0124 (nan)


def write_hits(tables: OpenTables, hits: Sequence[Hit], folder: str | PathLike[str]) -> list[Path]:
    """Write the hits of a search as clips, grouped by recording, to an empty folder."""
    from kineme.clips.split import Source, write_clips

    by_recording: dict[str, list[Hit]] = {}
    for hit in hits:
        by_recording.setdefault(hit.recording, []).append(hit)

    def sources() -> Iterator[Source]:
        for name, group in by_recording.items():
            recording = tables.read(name)
            yield recording, [_as_segment(hit, recording) for hit in group]

    return write_clips(sources(), folder)


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
    from kineme.plot.strips import write_sheet

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
        label = re.sub(r"[^\w-]+", "-", cluster.label).strip("-")[:40]  # portable
        name = "-".join(filter(None, [f"cluster-{cluster.cluster}", label]))
        path = folder / f"{name}.png"
        write_sheet([_make_strip(cluster, recording)], path)
        written.append(path)
    if strips:
        write_sheet([_make_strip(*each) for each in strips[:MOST_STRIPS]], folder / ALL)
        written.insert(0, folder / ALL)
    return written


def _make_strip(cluster: Cluster, recording: Motion | Signals) -> Strip:
    """Return the strip of a recording with a title that describes its cluster."""
    from kineme.plot.strips import Strip

    named = f"{cluster.cluster} {cluster.label}".strip()
    times = cluster.repetitions or cluster.activities
    n = cluster.recordings
    title = (
        f"{named}   {times} × {cluster.typical_s:.2f} s in {format_count(n, 'recording')}; "
        f"here {cluster.example}"
    )
    return Strip(title, recording, cluster.cluster)


def measure_coverage(tables: OpenTables) -> list[Coverage]:
    """Return the coverage of each cluster in each direction; reads all recordings of bodies."""
    facts_by_group: defaultdict[tuple[int, str], list[tuple[float, float, float, bool, bool]]]
    facts_by_group, labels = defaultdict(list), dict[int, str]()
    for motion, rows in _read_bodies(tables):
        travel = measure_travel(motion)
        if travel is None:
            continue
        for row in rows:
            if row.level != "activity" or row.kind == "transition":
                continue
            span, labels[row.cluster] = (row.start_frame, row.stop_frame), row.label
            tags, speed = travel.tags(*span), float(np.hypot(*travel.velocity(*span)))
            fact = row.duration_s, speed, travel.turn(*span), "start" in tags, "stop" in tags
            facts_by_group[row.cluster, tags[0]].append(fact)  # the first tag is the direction
    coverages = []
    for (cluster, direction), facts in facts_by_group.items():
        seconds, speeds, turns, starts, stops = zip(*facts, strict=True)
        coverages.append(
            Coverage(
                cluster,
                labels[cluster],
                direction=direction,
                clips=len(facts),
                seconds=round(sum(seconds), 2),
                slowest_m_s=round(min(speeds), 2),
                fastest_m_s=round(max(speeds), 2),
                left_deg=round(max(0.0, *turns), 1),
                right_deg=round(max(0.0, *(-turn for turn in turns)), 1),
                starts=sum(starts),
                stops=sum(stops),
            )
        )
    directions: list[str] = [*DIRECTIONS]
    return sorted(coverages, key=lambda each: (each.cluster, directions.index(each.direction)))


def write_best_loops(
    tables: OpenTables,
    folder: str | PathLike[str],
    *,
    per: Per = "cluster",
    **options: Unpack[ClipOptions],
) -> list[Path]:
    """Write the best loops of each group; see `Library.loops`."""
    from kineme.clips.split import Source, write_clips

    options["loops"] = True
    best = resolve_options(options).shape.best
    if not is_one_of(per, get_args(Per)):
        raise ParameterError(f"per is {per!r:.60}: choose from {', '.join(get_args(Per))}")
    groups: defaultdict[tuple[int, str], list[_Candidate]] = defaultdict(list)
    segments = tables.columns("segments")
    primitives = (segments["level"] == "primitive") & (segments["kind"] != "transition")
    repeated = set(segments["cluster"][primitives].tolist())
    for motion, rows in _read_bodies(tables):
        wanted = [
            index
            for index, row in enumerate(rows)
            if row.kind != "transition"
            and row.cluster >= 0
            # Whole activities serve only for clusters without repetitions.
            and (row.level == "primitive") == (row.cluster in repeated)
        ]
        name = motion.provenance.path or ""
        for each in _list_candidates(motion, rows, wanted, name):
            part = {"cluster": "", "recording": name, "direction": each.direction}[per]
            groups[each.cluster, part].append(each)
    chosen: defaultdict[str, list[RankedLoop]] = defaultdict(list)
    for candidates in groups.values():
        for rank, each in enumerate(_choose_best(candidates, best), 1):
            chosen[each.recording].append(RankedLoop(each.index, rank, each.quality))
    if not chosen:
        raise ParameterError("no recording of this library has a loop")

    def sources() -> Iterator[Source]:
        for motion, rows in _read_bodies(tables):
            if loops := chosen.get(motion.provenance.path or ""):
                yield motion, rows, loops

    return write_clips(sources(), folder, together=per != "recording", **options)


@dataclass(frozen=True)
class _Candidate:
    """A possible loop: its row in the recording, and its poses at `PHASES`."""

    recording: str
    index: int
    cluster: int
    direction: str
    quality: LoopQuality
    seconds: float
    poses: Floats | None

    def is_near_duplicate(self, other: _Candidate) -> bool:
        """Return whether both are nearly equal, whatever phase they begin at."""
        if self.poses is None or other.poses is None:
            return False
        if abs(self.seconds - other.seconds) > NEAR_SHARE * max(self.seconds, other.seconds):
            return False
        distances = (
            np.sqrt(((np.roll(self.poses, k, axis=0) - other.poses) ** 2).sum(axis=-1).mean())
            for k in range(PHASES)
        )
        return bool(min(distances) < NEAR_M)


def _list_candidates(
    motion: Motion, rows: Sequence[Segment], wanted: Sequence[int], recording: str
) -> Iterator[_Candidate]:
    """Yield the wanted rows of a recording that can become loops."""
    own, travel = [rows[index] for index in wanted], measure_travel(motion)
    qualities = measure_loops(motion, own, find_planted_feet(motion)) if own else {}
    for place, quality in qualities.items():
        row = own[place]
        clip = cut(motion, row.start_frame, row.stop_frame)
        try:
            poses = compute_body_frame(clip, end_effectors(clip).indices)
            # The last phase is one step before the first one of the next cycle.
            at = np.linspace(0, clip.n_frames - 1, PHASES, endpoint=False)
            sampled = interpolate_frames(poses, at)
        except KinemeError:  # not a human body: duplicates cannot be recognised
            sampled = None
        tags = travel.tags(row.start_frame, row.stop_frame) if travel else ("",)
        yield _Candidate(
            recording,
            wanted[place],
            cluster=row.cluster,
            direction=tags[0],
            quality=quality,
            seconds=row.duration_s,
            poses=sampled,
        )


def _choose_best(candidates: Sequence[_Candidate], most: int | None) -> list[_Candidate]:
    """Return the best candidates without near duplicates."""
    chosen: list[_Candidate] = []
    for each in sorted(candidates, key=lambda each: each.quality.cost):
        if len(chosen) == most:
            break
        if not any(each.is_near_duplicate(other) for other in chosen):
            chosen.append(each)
    return chosen


def _read_bodies(tables: OpenTables) -> Iterator[tuple[Motion, list[Segment]]]:
    """Yield recordings of bodies with their edited segments; warn if a file cannot be read."""
    recordings, segments = tables.recordings, tables.columns("segments")
    for name, kind in zip(recordings["recording"], recordings["vocabulary"], strict=True):
        if kind != BODIES:
            continue
        try:
            motion = tables.read(name)
        except KinemeError as error:  # missing file: go on with the others
            warn(f"{name} left out: {error}")
            continue
        own = tables.rows[name]
        rows = [*SegmentTable(**{column: segments[column][own] for column in COLUMNS})]
        if isinstance(motion, Motion) and rows[-1].stop_frame <= motion.n_frames:
            yield motion, rows
