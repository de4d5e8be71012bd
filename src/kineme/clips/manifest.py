"""Write what lies beside clips: manifests, a contact sheet and a motion matching database.

``manifest.csv`` has one row per clip. ``manifest.json`` follows the JSON Schema
``manifest.schema.json`` beside this module, which documents all names. Loops come first, grouped by
cluster and sorted by rank; other clips follow in time order. `kineme.clips.options` defines the
names of clips.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.files import PICTURES
from kineme._version import __version__
from kineme.clips.loops import Carry
from kineme.clips.motion_matching import SUFFIXES, Database
from kineme.clips.options import ClipOptions
from kineme.clips.shaping import ClipDetails
from kineme.errors import WriteError
from kineme.labels.delimited import write_rows
from kineme.recordings import Motion
from kineme.segments.table import Segment

SCHEMA = "kineme.clips/1"
MANIFEST, MANIFEST_JSON = "manifest.csv", "manifest.json"
SPANS = ("start_frame", "stop_frame", "start_s", "stop_s", "level", "kind", "cluster", "label")
RANKED = ("rank", "cost")
CARRY = ("turn_deg", "x_m", "z_m")
ANIMATION, TAGGED, SOURCE_TAKE = "animation", "tags", "source_take"
DIGITS = 6
"""Decimal places in JSON."""
SHOWN = 24
"""Largest number of frames of a clip in its strip."""


@dataclass(frozen=True)
class Clip:
    """Entry of one clip in the manifests."""

    name: str
    file: str
    source: str
    source_take: str | None
    details: ClipDetails
    changes: tuple[str, ...] = ()
    animation: str | None = None


def name_manifests(file: Path) -> tuple[Path, Path]:
    """Return the paths of both manifests for clips in a single file."""
    stem = file.with_suffix("").name
    return file.with_name(f"{stem}.{MANIFEST}"), file.with_name(f"{stem}.{MANIFEST_JSON}")


def write_manifests(
    clips: Sequence[Clip],
    table: Path,
    list_of_all: Path,
    *,
    loops: bool,
    animations: bool,
    together: bool = False,
) -> None:
    """Write both manifests; with ``together``, clusters are shared between recordings."""
    _write_csv(clips, table, loops=loops, animations=animations)
    # The stable sort keeps equal clips in time order.
    loops_first = sorted(clips, key=lambda clip: _make_sort_key(clip, together=together))
    head = f'{{\n"schema": "{SCHEMA}",\n"kineme": "{__version__}",\n"clips": ['
    body = ",".join(f"\n{_as_text(clip)}" for clip in loops_first)
    list_of_all.write_text(f"{head}{body}\n]\n}}\n", encoding="utf-8", newline="\n")


def _as_text(clip: Clip) -> str:
    """Return a clip as JSON with one line per name."""
    lines = (
        f" {json.dumps(name)}: {json.dumps(value, ensure_ascii=False, allow_nan=False)}"
        for name, value in _as_json(clip).items()
    )
    return "{\n" + ",\n".join(lines) + "\n}"


def _make_sort_key(clip: Clip, *, together: bool) -> tuple[bool, str, str, int, str, int]:
    """Return a sort key: loops by recording, take, cluster and rank, then other clips."""
    segment, rank = clip.details.segment, clip.details.rank
    if rank is None:
        return True, "", "", 0, "", 0
    source = ("", "") if together else (clip.source, clip.source_take or "")
    return False, *source, segment.cluster, segment.label, rank


def _as_json(clip: Clip) -> dict[str, Any]:
    """Return the entry of a clip in ``manifest.json``, described by its schema."""
    details = clip.details
    row, carry, quality, root = details.segment, details.carry, details.quality, details.root
    # A round ends one frame after its last pose; a closed loop has an extra frame.
    round_s = (details.n_frames - ("close" in clip.changes)) / details.fps
    content = {
        "name": clip.name,
        "file": clip.file,
        "take": clip.animation,
        "source": clip.source,
        "source_take": clip.source_take,
        "start_frame": row.start_frame,
        "stop_frame": row.stop_frame,
        "start_s": row.start_s,
        "stop_s": row.stop_s,
        "n_frames": details.n_frames,
        "fps": details.fps,
        "level": row.level,
        "kind": row.kind,
        "cluster": row.cluster,
        "label": row.label,
        "loop": carry is not None,
        "round_s": None if carry is None else round_s,
        "rank": details.rank,
        "quality": None if quality is None else {"cost": quality.cost, **asdict(quality)},
        "carry": None if carry is None else dict(zip(CARRY, _format_carry(carry), strict=True)),
        "root": None
        if root is None
        else {
            "speed_m_s": root.speed,
            "x_m_s": root.x,
            "z_m_s": root.z,
            "turn_deg_s": degrees(root.turn),
        },
        "planted": details.planted,
        "poses": details.poses,
        "changes": clip.changes,
        "tags": details.tags,
    }
    return {name: _round_numbers(value) for name, value in content.items()}


def _round_numbers(value: Any) -> Any:
    """Round all floats to `DIGITS` decimal places; replace nan and infinity by None."""
    if isinstance(value, Mapping):
        return {name: _round_numbers(each) for name, each in value.items()}
    if isinstance(value, tuple | list | np.ndarray):
        return [_round_numbers(each) for each in value]
    if isinstance(value, float):
        # Infinite and missing numbers are not valid JSON.
        return round(float(value), DIGITS) if math.isfinite(value) else None
    return int(value) if isinstance(value, np.integer) else value


def _format_carry(carry: Carry) -> tuple[float, float, float]:
    return degrees(carry.turn), carry.x, carry.z


def _write_csv(clips: Sequence[Clip], path: Path, *, loops: bool, animations: bool) -> None:
    # Only loops have ranks and carries.
    more = [*((*RANKED, *CARRY) if loops else ()), *((ANIMATION,) if animations else ())]
    takes = any(clip.source_take for clip in clips)
    more += [SOURCE_TAKE] if takes else []

    def make_cells(clip: Clip) -> list[object]:
        details, cells = clip.details, list[object]([clip.file, clip.source])
        cells += [getattr(details.segment, name) for name in SPANS]
        cells.append(", ".join(details.tags))
        if loops:
            quality, carry = details.quality, details.carry
            cells += ["", ""] if quality is None else [details.rank, quality.cost]
            cells += ["", "", ""] if carry is None else _format_carry(carry)
        cells += [clip.animation or ""] if animations else []
        return [*cells, clip.source_take or ""] if takes else cells

    with path.open("w", encoding="utf-8", newline="") as file:
        write_rows(file, ["file", "source", *SPANS, TAGGED, *more], map(make_cells, clips))


class Companions:
    """Contact sheet and motion matching database of clips, collected while these are made.

    Only the requested files are collected and written; clips pass unchanged.
    """

    def __init__(self, options: ClipOptions) -> None:
        self.sheet, self.matching = options.get("sheet"), options.get("motion_matching")
        # Check before any work is done.
        for target, suffixes in ((self.sheet, PICTURES), (self.matching, SUFFIXES)):
            if target is None:
                continue
            path = Path(target)
            if path.suffix.lower() not in suffixes:
                raise WriteError(path, f"the suffix must be one of {', '.join(suffixes)}")
            if not path.parent.is_dir():
                raise WriteError(path, f"there is no folder {path.parent}")
        self.strips: list[tuple[str, Motion, int]] = []  # title, a few frames, cluster
        self.database = Database()

    def collect(
        self,
        motion: Motion,
        rows: Sequence[Segment],
        clips: Iterable[tuple[ClipDetails, Motion]],
        get_name: Callable[[ClipDetails], str],
    ) -> Iterator[tuple[ClipDetails, Motion]]:
        """Yield the clips of a recording unchanged, and collect data from each."""
        ranges = []
        for details, clip in clips:
            name = get_name(details)
            if self.sheet is not None:
                title = "   ".join(filter(None, [name, ", ".join(details.tags)]))
                n = clip.n_frames
                at = np.linspace(0, n - 1, min(SHOWN, n)).round().astype(int)
                thinned = replace(clip, positions=clip.positions[at], rotations=None, gaps=())
                self.strips.append((title, thinned, details.segment.cluster))
            ranges.append((name, rows[details.index], details.tags))
            yield details, clip
        if self.matching is not None:
            self.database.add(motion, ranges)

    def write(self) -> None:
        """Write the database and the sheet, if requested."""
        if self.matching is not None:
            self.database.write(self.matching)
        if self.sheet is not None:
            from kineme.plot.strips import Strip, write_sheet  # matplotlib takes long to import

            write_sheet([Strip(*each) for each in self.strips], self.sheet)
