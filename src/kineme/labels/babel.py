"""BABEL annotations in JSON: one level, in seconds, with the length of the recording.

A file is an object of recordings by number, like BABEL's ``train.json``; a single recording
is read, too. Writing stores ``frame_ann`` with one label per segment (text as ``raw_label``,
``proc_label`` and only member of ``act_cat``) and an empty ``seq_ann``, without frame rate and
scores.

BABEL's labels may overlap (``walk`` and ``wave``). The shared span becomes a separate
segment ``walk + wave``, with a warning. Without ``frame_ann``, ``seq_ann`` labels the whole
recording.

Source: Punnakkal et al., BABEL: Bodies, Action and Behavior with English
Labels, CVPR 2021; https://github.com/abhinanda-punnakkal/BABEL.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from kineme._util.checks import format_count
from kineme._util.files import atomic_write
from kineme._util.json import load_json
from kineme.errors import ReadError
from kineme.labels.delimited import read_first_bytes
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, format_text
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

AT_ONCE = 4
"""Largest number of labels of one frame; more indicate a damaged file."""


def write(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write an object with one recording, number 0."""
    labels = [
        {
            "raw_label": format_text(row),
            "proc_label": format_text(row),
            "act_cat": [format_text(row)],
            "start_t": row.start_s,
            "end_t": row.stop_s,
            "seg_id": str(number),
        }
        for number, row in enumerate(rows)
    ]
    recording = {
        "babel_sid": 0,
        "dur": segmentation.n_frames / segmentation.fps,
        "feat_p": (segmentation.provenance.get("input") or {}).get("path") or "",
        "frame_ann": {"labels": labels},
        "seq_ann": None,
    }
    with atomic_write(path) as draft:
        draft.write_text(json.dumps({"0": recording}, indent=2) + "\n", encoding="utf-8")


def read(path: Path) -> Labels:
    """Read the labels of the only recording in a file."""
    content = load_json(path)
    if isinstance(content, dict) and "dur" not in content:
        if len(content) > 1:
            raise ReadError(
                path, f"has {len(content)} recordings: save the one you need to its own file"
            )
        content = next(iter(content.values()), None)
    if not isinstance(content, dict) or "dur" not in content:
        raise ReadError(path, 'is not a BABEL annotation: it has no "dur"')
    return convert_labels(content, path)


def convert_labels(recording: Mapping[str, Any], path: Path) -> Labels:
    """Convert the parsed JSON of one BABEL recording to labels."""
    length = _parse_seconds(recording, "dur", path)
    annotation = recording.get("frame_ann") or recording.get("seq_ann")
    one_span = not recording.get("frame_ann")
    labels = annotation.get("labels") if isinstance(annotation, dict) else None
    if not isinstance(labels, list) or not all(isinstance(label, dict) for label in labels):
        raise ReadError(path, "has no labels: neither frame_ann nor seq_ann holds a list of them")
    spans = [
        Span(
            0.0 if one_span else _parse_seconds(label, "start_t", path),
            length if one_span else _parse_seconds(label, "end_t", path),
            str(label.get("proc_label") or label.get("raw_label") or ""),
        )
        for label in labels
    ]
    disjoint, shared = _split_overlaps(spans, path)
    note = f"overlapping labels joined with the texts of several: {format_count(shared, 'segment')}"
    return Labels(disjoint, "seconds", fps=None, length=length, notes=(note,) if shared else ())


def _parse_seconds(holder: Mapping[str, Any], name: str, path: Path) -> float:
    value: Any = holder.get(name)
    if type(value) not in (int, float) or not 0 <= value < 1e15:
        raise ReadError(path, f"{name} must be seconds, not {value!r:.60}")
    return float(value)


def _split_overlaps(spans: Sequence[Span], path: Path) -> tuple[list[Span], int]:
    """Split overlapping spans into spans with all texts; return also how many have several."""
    valid = [span for span in spans if span.start < span.stop]
    # Keep empty and reversed spans: they are rejected or dropped later.
    result = [span for span in spans if not span.start < span.stop]
    waiting = sorted(valid, key=lambda span: span.start)[::-1]
    active: list[Span] = []
    shared = 0
    # The set of active labels is constant between successive times.
    for start, stop in pairwise(sorted({time for span in valid for time in span[:2]})):
        active = [span for span in active if span.stop > start]
        # The list is sorted backwards: the earliest span is last.
        while waiting and waiting[-1].start <= start:
            active.append(waiting.pop())
        if len(active) > AT_ONCE:
            raise ReadError(path, f"has more than {AT_ONCE} labels at once, at {start} s")
        if active:
            texts = dict.fromkeys(span.text for span in active if span.text)
            result.append(Span(start, stop, " + ".join(texts)))
            shared += len(texts) > 1
    return result, shared


def _recognises(path: Path) -> bool:
    start = read_first_bytes(path)
    return any(word in start for word in (b'"seq_ann"', b'"frame_ann"', b'"seg_id"'))


FORMAT = LabelFormat(
    name="babel",
    help="BABEL, one level",
    suffixes=(".json",),
    holds="level",
    read=read,
    write=write,
    recognises=_recognises,
)
