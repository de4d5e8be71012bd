"""Measure which movements a library covers, and write the best loops of each cluster.

Loops of all recordings are ranked by the same cost as those of one recording. Near duplicates of a
better loop are left out: their poses (head, hands and feet relative to the pelvis) are within
`NEAR_M` at some phase of the cycle, and durations differ by at most `NEAR_SHARE`.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Literal, NamedTuple, Unpack, get_args

import numpy as np

from kineme._util.arrays import Floats, interpolate_frames
from kineme._util.checks import is_one_of, warn
from kineme.clips.options import ClipOptions, resolve_options
from kineme.clips.quality import PHASES, LoopQuality
from kineme.clips.shaping import RankedLoop, find_planted_feet, measure_loops
from kineme.clips.tags import DIRECTIONS, measure_travel
from kineme.errors import KinemeError, ParameterError
from kineme.features import compute_body_frame, end_effectors
from kineme.library.open_library import OpenTables
from kineme.library.storage.layout import BODIES
from kineme.recordings import Motion
from kineme.recordings.operations import cut
from kineme.segments.table import COLUMNS, Segment

Per = Literal["cluster", "direction", "recording"]
"""Groups from which the best loops are chosen: clusters, or directions or recordings in them."""
NEAR_M = 0.03
"""RMS distance of five points in metres below which two loops are the same movement."""
NEAR_SHARE = 0.1
"""Largest difference in duration of two such loops, as a fraction of the longer one."""


class Coverage(NamedTuple):
    """Activities of one cluster in one direction of travel.

    Attributes
    ----------
    cluster : int
        -1 for activities in no cluster.
    label, direction : str
        The name of the cluster; one of `kineme.clips.tags.DIRECTIONS`.
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


def measure_coverage(tables: OpenTables) -> list[Coverage]:
    """Return the coverage of each cluster in each direction; reads all recordings of bodies."""
    facts_by_group: defaultdict[tuple[int, str], list[tuple[float, float, float, bool, bool]]]
    facts_by_group, labels = defaultdict(list), dict[int, str]()
    for motion, rows in _read_bodies(tables):
        travel = measure_travel(motion)
        for row in rows if travel is not None else ():
            if travel is None or row.level != "activity" or row.kind == "transition":
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
                direction,
                len(facts),
                round(sum(seconds), 2),
                round(min(speeds), 2),
                round(max(speeds), 2),
                round(max(0.0, *turns), 1),
                round(max(0.0, *(-turn for turn in turns)), 1),
                sum(starts),
                sum(stops),
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
    repeated = _list_repeated(tables)
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
        apart = (
            np.sqrt(((np.roll(self.poses, k, axis=0) - other.poses) ** 2).sum(axis=-1).mean())
            for k in range(PHASES)
        )
        return bool(min(apart) < NEAR_M)


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
            recording, wanted[place], row.cluster, tags[0], quality, row.duration_s, sampled
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


def _list_repeated(tables: OpenTables) -> set[int]:
    """Return the clusters with primitives."""
    segments = tables.columns("segments")
    primitives = (segments["level"] == "primitive") & (segments["kind"] != "transition")
    return set(segments["cluster"][primitives].tolist())


def _read_bodies(tables: OpenTables) -> Iterator[tuple[Motion, list[Segment]]]:
    """Yield recordings of bodies with their edited segments; warn if a file cannot be read."""
    recordings, segments = tables.recordings, tables.columns("segments")
    for name, kind in zip(recordings["recording"], recordings["vocabulary"], strict=True):
        if kind != BODIES or name not in tables.rows:
            continue
        try:
            motion = tables.read(name)
        except KinemeError as error:  # missing file: go on with the others
            warn(f"{name} left out: {error}")
            continue
        first, stop = tables.rows[name]
        columns = [segments[column][first:stop].tolist() for column in COLUMNS]
        rows = [Segment(**dict(zip(COLUMNS, values, strict=True))) for values in
                zip(*columns, strict=True)]  # fmt: skip
        if isinstance(motion, Motion) and rows[-1].stop_frame <= motion.n_frames:
            yield motion, rows
