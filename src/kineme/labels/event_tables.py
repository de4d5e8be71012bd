"""Event tables of BIDS (with sidecar) and BORIS.

*BIDS* (``events.tsv``): both levels, clusters and confidences. ``onset``, ``duration`` (seconds)
and ``trial_type`` are standard columns; ``level``, ``cluster``, ``confidence``, ``start_frame``,
``stop_frame``, ``action`` and ``border_confidence`` are described in the sidecar. The sidecar also
holds ``SamplingFrequency`` and ``RecordingDuration`` as in Motion-BIDS, and a digest of the cuts.
Missing values are ``n/a``. Existing descriptions in a sidecar are kept.

Reading requires only ``onset``, ``duration`` and ``trial_type``, and uses the seconds.

*BORIS* (CSV or TSV): a START and a STOP row per segment, both levels. Written as "tabular events":
``Time`` in seconds and ``Image index`` (first frame for START, one past the last for STOP, from 0),
frame rate and length of the recording in every row, the level as ``Behavioral category``. Scores
are not stored.

Reads tabular events of old and new versions (header line below a preamble or on top; START and STOP
in ``Behavior type`` or ``Status``) and aggregated events (``Start (s)``, ``Stop (s)``). POINT
events have no duration and are left out with a warning. Rows of several subjects must not overlap.
An observation is a recording, see `kineme.labels.collections`.

Sources: https://bids-specification.readthedocs.io, "Events"; BORIS user guide, "Export events".
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from operator import itemgetter
from pathlib import Path
from typing import Any

from kineme._util.files import atomic_write
from kineme._util.json import load_json
from kineme.errors import ReadError, WriteError
from kineme.formats.listing import is_boris_table
from kineme.labels.delimited import (
    CUTS_KEY,
    digest_cuts,
    find_differences,
    format_source,
    open_new_text,
    parse_integer,
    parse_level,
    parse_number,
    read_columns,
    read_first_bytes,
    read_rows,
    write_rows,
)
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, format_text, require_one_recording
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

NEEDED = ("onset", "duration", "trial_type")
COLUMNS = {
    "trial_type": {"Description": "Name of the segment; transition between two activities"},
    "level": {
        "Description": "Level of the segment",
        "Levels": {
            "activity": "One kind of movement, or a transition between two",
            "primitive": "One repetition inside an activity",
        },
    },
    "cluster": {"Description": "Equal numbers are equal movements; n/a: in no cluster"},
    "confidence": {"Description": "Probability that its cluster is right"},
    "start_frame": {"Description": "First frame, counted from 0"},
    "stop_frame": {"Description": "One past the last frame"},
    "action": {"Description": "Cluster of the activity that contains it; n/a: in no cluster"},
    "border_confidence": {"Description": "Probability that its start is right"},
}
MISSING = "n/a"
BORIS_COLUMNS = (
    "Observation id",
    "Observation date",
    "Description",
    "Observation type",
    "Source",
    "Time offset (s)",
    "Media duration (s)",
    "FPS (frame/s)",
    "Subject",
    "Behavior",
    "Behavioral category",
    "Behavior type",
    "Time",
    "Media file name",
    "Image index",
    "Image file path",
    "Comment",
)
RATES = ("FPS (frame/s)", "FPS")
LENGTHS = ("Media duration (s)", "Observation duration", "Total length")
Cells = dict[str, str]


def write_bids(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write the events to ``path`` and the sidecar beside it."""
    sidecar_path = name_sidecar(path)
    facts = {
        "SamplingFrequency": segmentation.fps,
        "RecordingDuration": segmentation.n_frames / segmentation.fps,
    }
    cuts = ((row.level, row.start_frame, row.stop_frame) for row in rows)
    digest = {CUTS_KEY: digest_cuts(cuts)}
    sidecar = {**COLUMNS, **_read_sidecar_to_keep(sidecar_path), **facts, **digest}
    with atomic_write(sidecar_path) as side_draft, open_new_text(path) as file:
        side_draft.write_text(json.dumps(sidecar, indent=2) + "\n", encoding="utf-8")
        write_rows(file, ["onset", "duration", *COLUMNS], map(_format_cells, rows), delimiter="\t")


def read_bids(path: Path) -> Labels:
    """Read events with the facts in their sidecar, if there is one."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = read_rows(file, path, [NEEDED])
        spans, cuts, rates = [], [], []
        for line, cells in rows:
            span = _parse_span(cells, path, line)
            spans.append(span)
            rates.append((span.stop, _parse_rate(cells, span.stop)))
            cuts.append((span.level, cells.get("start_frame"), cells.get("stop_frame")))
    sidecar_path = name_sidecar(path)
    sidecar = _read_sidecar(sidecar_path)
    rate = _parse_positive(sidecar, "SamplingFrequency", sidecar_path)
    length = _parse_positive(sidecar, "RecordingDuration", sidecar_path)
    row_rate = max(rates, default=(0.0, None), key=itemgetter(0))[1]
    notes = find_differences(
        path, sidecar_path, sidecar, digest_cuts(cuts), head_rate=rate, row_rate=row_rate
    )
    return Labels(spans, "seconds", rate, length, notes)


def name_sidecar(path: Path) -> Path:
    """Return the path of a sidecar: ``walk_events.json`` for ``walk_events.tsv``."""
    return path.with_suffix(".json")


def _format_cells(row: Segment) -> list[Any]:
    """Return the cells of a row in the order ``onset``, ``duration``, then `COLUMNS`."""
    cluster, action = (MISSING if each < 0 else each for each in (row.cluster, row.action))
    confidence, border = (
        MISSING if math.isnan(each) else each for each in (row.confidence, row.border_confidence)
    )
    time = [row.start_s, row.stop_s - row.start_s]
    frames = [row.start_frame, row.stop_frame]
    return [*time, format_text(row), row.level, cluster, confidence, *frames, action, border]


def _parse_span(cells: dict[str, str], path: Path, line: int) -> Span:
    """Return the event of a row; ``n/a`` stands for missing values."""
    onset = parse_number(cells["onset"], "onset", path, line)
    duration = cells["duration"]
    length = 0.0 if duration == MISSING else parse_number(duration, "duration", path, line)
    text = cells["trial_type"] if cells["trial_type"] != MISSING else ""
    span = Span(onset, onset + length, text, parse_level(cells.get("level")))
    if (cluster := cells.get("cluster", MISSING)) not in (MISSING, ""):
        span = span._replace(cluster=parse_integer(cluster, "cluster", path, line))
    if (confidence := cells.get("confidence", MISSING)) not in (MISSING, ""):
        span = span._replace(confidence=parse_number(confidence, "confidence", path, line))
    return span


def _parse_rate(cells: dict[str, str], stop_s: float) -> float | None:
    """Return the frame rate computed from the stop of a row, or None."""
    text = cells.get("stop_frame", MISSING)
    # Longer numbers exceed the integers that a float represents exactly.
    valid = text.isdecimal() and len(text) < 16 and 0 < stop_s < math.inf
    return int(text) / stop_s if valid else None


def _parse_positive(sidecar: dict[str, Any], name: str, path: Path) -> float | None:
    value: float | None = sidecar.get(name)
    if value is not None and (type(value) not in (int, float) or not 0 < value < 1e15):
        raise ReadError(path, f"{name} must be a positive number, not {value!r:.60}")
    return value


def _read_sidecar_to_keep(path: Path) -> dict[str, Any]:
    """Return the sidecar, whose other names are kept; WriteError if it is another file."""
    try:
        found = _read_sidecar(path)
    except ReadError as error:
        raise WriteError(path, f"would be overwritten as the sidecar: it {error.reason}") from error
    if "schema" in found:
        raise WriteError(
            path,
            "would be overwritten as the sidecar, but it is a segment table: choose another name",
        )
    return found


def _read_sidecar(path: Path) -> dict[str, Any]:
    if not path.is_file():
        return {}
    found = load_json(path)
    if not isinstance(found, dict):
        raise ReadError(path, "a sidecar must be a JSON object")
    return found


BIDS = LabelFormat(
    name="bids",
    help="BIDS events with their sidecar",
    suffixes=(".tsv",),
    holds="levels",
    read=read_bids,
    write=write_bids,
    recognises=lambda path: set(NEEDED) <= read_columns(path),
    several=True,
)


def write_boris(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write two rows per segment in time order."""
    media = format_source(segmentation)
    facts = {
        "Observation id": Path(media).stem,
        "Observation type": "Media file(s)",
        "Source": media,
        "Time offset (s)": 0.0,
        "Media duration (s)": segmentation.n_frames / segmentation.fps,
        "FPS (frame/s)": segmentation.fps,
        "Subject": "No focal subject",
        "Media file name": media,
    }
    events = [
        {
            "Behavior": format_text(row),
            "Behavioral category": row.level,
            "Behavior type": kind,
            "Time": time,
            "Image index": frame,
        }
        for row in rows
        for kind, time, frame in (
            ("START", row.start_s, row.start_frame),
            ("STOP", row.stop_s, row.stop_frame),
        )
    ]
    # STOP comes before START at the same frame.
    events.sort(key=lambda event: (event["Image index"], event["Behavior type"] == "START"))
    with open_new_text(path) as file:
        lines = ({**facts, **event} for event in events)
        write_rows(
            file, BORIS_COLUMNS, ([line.get(name, "") for name in BORIS_COLUMNS] for line in lines)
        )


def read_boris(path: Path) -> Labels:
    """Read the state events of the only observation in a BORIS table."""
    return require_one_recording(read_observations(path), path)


def read_observations(path: Path) -> dict[str, Labels]:
    """Read the state events of a BORIS table by ``Observation id``, or by "" without one."""
    headers = [("Time", "Behavior"), ("Start (s)", "Stop (s)", "Behavior")]
    rows: dict[str, list[tuple[int, Cells]]] = {}
    with path.open(encoding="utf-8-sig", newline="") as file:
        for line, cells in read_rows(file, path, headers):
            rows.setdefault(cells.get("Observation id", ""), []).append((line, cells))
    return {name: _read_states(some, path) for name, some in rows.items()}


def _read_states(rows: list[tuple[int, Cells]], path: Path) -> Labels:
    """Return the state events of an observation."""
    spans = list(_pair_states(rows, path) if "Time" in rows[0][1] else _read_aggregated(rows, path))
    points = Counter(cells["Behavior"] for _, cells in rows if _parse_kind(cells) == "POINT")
    listed = ", ".join(f"{name} ({count})" for name, count in points.items())
    notes = (f"point events have no duration and are left out: {listed:.200}",) if points else ()
    return Labels(spans, "seconds", _parse_fact(rows, RATES), _parse_fact(rows, LENGTHS), notes)


def _pair_states(rows: list[tuple[int, Cells]], path: Path) -> Iterator[Span]:
    """Yield a span for each STOP with the preceding START of the same behavior."""
    starts: dict[tuple[str, ...], float] = {}
    for line, cells in rows:
        kind = _parse_kind(cells)
        if kind == "POINT":
            continue
        same = ("Subject", "Behavior", "Behavioral category")
        # Several subjects may have open states.
        key = tuple(cells.get(name, "") for name in same)
        time = parse_number(cells["Time"], "Time", path, line)
        if kind == "START" and key not in starts:
            starts[key] = time
        elif kind == "STOP" and key in starts:
            yield Span(
                starts.pop(key),
                time,
                cells["Behavior"],
                parse_level(cells.get("Behavioral category")),
            )
        else:
            reason = (
                f"{cells['Behavior']!r:.60} has a {kind!r:.20} where START and STOP must alternate"
            )
            raise ReadError(path, reason, line=line)
    if starts:
        raise ReadError(path, f"{next(iter(starts))[1]!r:.60} has a START without a STOP")


def _read_aggregated(rows: list[tuple[int, Cells]], path: Path) -> Iterator[Span]:
    for line, cells in rows:
        if _parse_kind(cells) == "POINT":
            continue
        start = parse_number(cells["Start (s)"], "Start (s)", path, line)
        stop = parse_number(cells["Stop (s)"], "Stop (s)", path, line)
        level = parse_level(cells.get("Behavioral category"))
        yield Span(start, stop, cells["Behavior"], level)


def _parse_kind(cells: Cells) -> str:
    return (cells.get("Behavior type") or cells.get("Status") or "").strip().upper()


def _parse_fact(rows: list[tuple[int, Cells]], names: Sequence[str]) -> float | None:
    """Return a fact about the recording from the first row, if it is a positive number."""
    for name in names:
        try:
            value = float(rows[0][1][name])
        except (KeyError, ValueError):
            continue
        if 0 < value < 1e15:
            return value
    return None


def is_boris(path: Path) -> bool:
    """Return whether a file begins like a table of BORIS."""
    return is_boris_table(read_first_bytes(path).decode(errors="replace"))


BORIS = LabelFormat(
    name="boris",
    help="BORIS events",
    suffixes=(".csv", ".tsv"),
    holds="levels",
    read=read_boris,
    write=write_boris,
    recognises=is_boris,
)
