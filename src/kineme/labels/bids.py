"""BIDS ``events.tsv`` with its JSON sidecar: both levels, clusters and confidences.

Columns ``onset``, ``duration`` (seconds) and ``trial_type`` are those of the
standard; ``level``, ``cluster``, ``confidence``, ``start_frame``, ``stop_frame``, ``action`` and
``border_confidence`` are described in the sidecar, which also has ``SamplingFrequency`` and
``RecordingDuration`` as in Motion-BIDS, and a digest of the cuts. A missing
value is ``n/a``. What a sidecar already says about columns is kept.

Reading needs ``onset``, ``duration`` and ``trial_type`` only; seconds count.

Source: https://bids-specification.readthedocs.io, "Events".
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from operator import itemgetter
from pathlib import Path
from typing import Any

from kineme._util.files import atomic_write
from kineme._util.json import load_json
from kineme.errors import ReadError, WriteError
from kineme.labels.delimited import (
    CUTS_KEY,
    columns,
    digest_cuts,
    find_differences,
    integer,
    level_of,
    new_text,
    number,
    read_rows,
    write_rows,
)
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, text_of
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

NEEDED = ("onset", "duration", "trial_type")
COLUMNS = {
    "trial_type": {"Description": "Name of the segment; transition between two activities"},
    "level": {
        "Description": "Level of the segment",
        "Levels": {
            "activity": "Movement of one kind, or a transition between two",
            "primitive": "One repetition inside an activity",
        },
    },
    "cluster": {"Description": "Equal numbers are equal movements; n/a: in no cluster"},
    "confidence": {"Description": "How probable it is that what its kind claims is right"},
    "start_frame": {"Description": "First frame, counted from 0"},
    "stop_frame": {"Description": "One past the last frame"},
    "action": {"Description": "Cluster of the activity that it lies in; n/a: in no cluster"},
    "border_confidence": {"Description": "How probable it is that its start is right"},
}
MISSING = "n/a"


def write(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Leave the events at ``path`` and the sidecar beside them."""
    beside = sidecar_path(path)
    facts = {
        "SamplingFrequency": segmentation.fps,
        "RecordingDuration": segmentation.n_frames / segmentation.fps,
    }
    cuts = ((row.level, row.start_frame, row.stop_frame) for row in rows)
    digest = {CUTS_KEY: digest_cuts(cuts)}
    sidecar = {**COLUMNS, **_sidecar_to_keep(beside), **facts, **digest}
    with atomic_write(beside) as side_draft, new_text(path) as file:
        side_draft.write_text(json.dumps(sidecar, indent=2) + "\n", encoding="utf-8")
        write_rows(file, ["onset", "duration", *COLUMNS], map(_cells, rows), delimiter="\t")


def read(path: Path) -> Labels:
    """Return the events at ``path``, with what a sidecar beside them says."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = read_rows(file, path, [NEEDED], delimiter="\t")
        spans, cuts, rates = [], [], []
        for line, cells in rows:
            span = _span(cells, path, line)
            spans.append(span)
            rates.append((span.stop, _rate(cells, span.stop)))
            cuts.append((span.level, cells.get("start_frame"), cells.get("stop_frame")))
    beside = sidecar_path(path)
    sidecar = _parse(beside)
    facts = _facts(sidecar, beside)
    rate, length = facts["SamplingFrequency"], facts["RecordingDuration"]
    row_rate = max(rates, default=(0.0, None), key=itemgetter(0))[1]
    notes = find_differences(
        path, beside, sidecar, digest_cuts(cuts), head_rate=rate, row_rate=row_rate
    )
    return Labels(spans, "seconds", rate, length, notes)


def sidecar_path(path: Path) -> Path:
    """Where the description is kept: ``walk_events.tsv`` and ``walk_events.json``."""
    return path.with_suffix(".json")


def _cells(row: Segment) -> list[Any]:
    cluster, action = (MISSING if each < 0 else each for each in (row.cluster, row.action))
    confidence, border = (
        MISSING if math.isnan(each) else each for each in (row.confidence, row.border_confidence)
    )
    time = [row.start_s, row.stop_s - row.start_s]
    frames = [row.start_frame, row.stop_frame]
    return [*time, text_of(row), row.level, cluster, confidence, *frames, action, border]


def _span(cells: dict[str, str], path: Path, line: int) -> Span:
    onset = number(cells["onset"], "onset", path, line)
    duration = cells["duration"]
    length = 0.0 if duration == MISSING else number(duration, "duration", path, line)
    text = cells["trial_type"] if cells["trial_type"] != MISSING else ""
    cluster = cells.get("cluster", MISSING)
    confidence = cells.get("confidence", MISSING)
    return Span(
        onset,
        onset + length,
        text,
        level_of(cells.get("level")),
        -1 if cluster in (MISSING, "") else integer(cluster, "cluster", path, line),
        math.nan if confidence in (MISSING, "") else number(confidence, "confidence", path, line),
    )


def _rate(cells: dict[str, str], stop_s: float) -> float | None:
    """Return the frame rate that a row tells by its last frame and second, if it has both."""
    text = cells.get("stop_frame", MISSING)
    valid = text.isdecimal() and len(text) < 16 and 0 < stop_s < math.inf
    return int(text) / stop_s if valid else None


def _facts(sidecar: dict[str, Any], beside: Path) -> dict[str, float | None]:
    facts: dict[str, float | None] = {}
    for name in ("SamplingFrequency", "RecordingDuration"):
        value = sidecar.get(name)
        if value is not None and (type(value) not in (int, float) or not 0 < value < 1e15):
            raise ReadError(beside, f"{name} must be a positive number, not {value!r:.60}")
        facts[name] = value
    return facts


def _sidecar_to_keep(beside: Path) -> dict[str, Any]:
    try:
        found = _parse(beside)
    except ReadError as error:
        raise WriteError(beside, f"is in the way of the sidecar: {error.reason}") from error
    if "schema" in found:
        raise WriteError(beside, "is in the way: it is a segment table, and would be the sidecar")
    return found


def _parse(beside: Path) -> dict[str, Any]:
    if not beside.is_file():
        return {}
    found = load_json(beside)
    if not isinstance(found, dict):
        raise ReadError(beside, "a sidecar must be a JSON object")
    return found


FORMAT = LabelFormat(
    name="bids",
    help="BIDS events with their sidecar",
    suffixes=(".tsv",),
    holds="levels",
    read=read,
    write=write,
    recognises=lambda path: set(NEEDED) <= columns(path),
    several=True,
)
