"""What holds of every segmentation: levels tile the recording, primitives lie in activities."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, TypedDict

import numpy as np

from kineme._util.checks import is_number
from kineme._util.json import convert_json, fault_of
from kineme.errors import ParameterError
from kineme.segments.table import Level, SegmentTable

FASTEST, LONGEST = 1e9, 1e11
"""Frames per second and seconds, below which every label format can tell them."""


class Input(TypedDict, total=False):
    """File that a recording was read from."""

    path: str | None
    format: str | None
    sha256: str | None


class LabelFile(TypedDict, total=False):
    """File that labels were read from, and repetitions of each activity where it has some."""

    path: str | None
    format: str | None
    counts: list[int | None]


class Provenance(TypedDict, total=False):
    """What is read again of a provenance, as the package writes it; people may add to it."""

    input: Input | None
    labels: LabelFile
    preset: str | None
    parameters: dict[str, Any]
    notes: list[str]
    gaps: list[tuple[int, int]]


def check_recording(n_frames: int, fps: float) -> None:
    """ParameterError where no recording has this length or rate."""
    if not (is_number(n_frames) and n_frames >= 1):
        raise ParameterError(f"a recording has at least 1 frame, not {n_frames!r:.60}")
    if not (is_number(fps) and 0 < fps < FASTEST):
        raise ParameterError(f"the frame rate must be a positive number, not {fps!r:.60}")
    if not n_frames / fps < LONGEST:
        raise ParameterError(f"no recording lasts {n_frames / fps:.3g} s, as this would")


def check_tiles(rows: SegmentTable, level: Level, n_frames: int) -> None:
    """ParameterError where the segments of a level do not follow each other from start to end."""
    if not len(rows) and level == "primitive":
        return
    if not len(rows) or rows.start_frame[0] != 0 or rows.stop_frame[-1] != n_frames:
        raise ParameterError(f"the {level} level must cover frames 0 to {n_frames}")
    # The first of these, if any.
    for row in np.flatnonzero(rows.stop_frame[:-1] != rows.start_frame[1:])[:1].tolist():
        raise ParameterError(
            f"one {level} stops at frame {rows.stop_frame[row]}, the next starts at "
            f"{rows.start_frame[row + 1]}: segments of a level must touch and not overlap"
        )
    if (rows.stop_frame <= rows.start_frame).any():
        empty = rows[int(np.argmax(rows.stop_frame <= rows.start_frame))]
        raise ParameterError(f"the {level} at frame {empty.start_frame} has no frames")


def check_parents(activities: SegmentTable, primitives: SegmentTable) -> None:
    """ParameterError where a primitive does not lie in the activity that it names."""
    if (activities.activity != np.arange(len(activities))).any():
        raise ParameterError("column 'activity' of the activity level must count 0, 1, 2, ...")
    # The activity of each primitive: the last that begins at or before it.
    enclosing = np.searchsorted(activities.start_frame, primitives.start_frame, "right") - 1
    outside = primitives.stop_frame > activities.stop_frame[enclosing]
    if outside.any():
        row = primitives[int(np.argmax(outside))]
        raise ParameterError(
            f"the primitive of frames {row.start_frame} to {row.stop_frame} crosses the border "
            f"of an activity at {activities.stop_frame[enclosing[np.argmax(outside)]]}"
        )
    wrong = primitives.activity != enclosing
    if wrong.any():
        row = primitives[int(np.argmax(wrong))]
        raise ParameterError(
            f"the primitive at frame {row.start_frame} names activity {row.activity}, "
            f"but lies in activity {enclosing[np.argmax(wrong)]}"
        )


def plain_json(value: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A copy made of what JSON has: dicts, lists, texts, finite numbers, booleans, None."""
    try:
        copy: dict[str, Any] = json.loads(json.dumps(dict(value), allow_nan=False))
    except (TypeError, ValueError, RecursionError) as error:
        raise ParameterError(f"{name} cannot be written as JSON: {error}") from error
    if fault := fault_of(copy):  # which nobody could read again
        raise ParameterError(f"{name} {fault}")
    return copy


def as_provenance(value: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy of plain JSON; an input that is a text is the path of one.

    ParameterError where something that the package writes there is of another shape.
    """
    provenance = plain_json(value, "provenance")
    if isinstance(provenance.get("input"), str):
        provenance["input"] = {"path": provenance["input"]}
    try:
        convert_json(provenance, Provenance)
    except ValueError as error:
        raise ParameterError(f"the provenance is not as kineme writes it: {error}") from error
    return provenance
