"""Convert the people that a pose estimator found in the frames of a video to a motion.

A keypoint with a confidence below its format's limit counts as not seen, as do all keypoints of a
person not found in a frame. Keypoints in an image are measured in pixels with y down; the larger
side of the body is scaled to a person's height; if they are fractions of the image's sides, the
image is assumed to be square, with a warning. Most of these files have no frame rate: ``fps`` is
required.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter, itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme._util.checks import format_count
from kineme.formats.files import FileContent
from kineme.formats.keypoints.people import select_person
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.recordings import Motion

MAX_FRAMES_RATIO = 20
"""Maximum number of frames per frame with a person; above it the numbers are wrong."""

SMALLEST_PIXEL = 4
"""Coordinates in an image below this are no pixels, but fractions of its width and height."""


@dataclass(frozen=True)
class Person:
    """A person found in a frame."""

    frame: int  # number with any start
    points: Sequence[Sequence[float]] | Floats  # (keypoints, 2 or 3)
    confidence: Sequence[float] | Floats  # (keypoints,)
    who: str | None = None  # name or number in the file


def video_to_motion(
    content: FileContent,
    options: ReadOptions,
    program: str,
    names: Sequence[str],
    people: Sequence[Person],
    *,
    limit: float,
    fps: float | None = None,
    frames: Sequence[int] = (),
    unit: str | float | None = "pixel",
    up: str | None = "-y",
    notes: Sequence[str] = (),
) -> Motion:
    """Return the motion of one person among those that a program found in a video, in any order.

    ``names`` are those of the keypoints, ``limit`` is the confidence from which one counts as seen,
    ``fps`` the rate stated in the file, and ``frames`` the numbers of all frames, also of those
    without people. Unit and axis are those of `Points`. Raise ReadError if the person or the frame
    rate is unknown.
    """
    fps = content.choose_rate(options.fps, fps)
    if not fps:
        raise content.error(
            "keypoints have no frame rate: give that of the video with fps= (--fps)"
        )
    if not people:
        raise content.error("no person found in any frame")
    people = sorted(people, key=attrgetter("frame"))
    rows_frames, n_frames = _number_frames(content, frames, [person.frame for person in people])
    # Three coordinates and the confidence, 8 bytes each.
    size = 8 * 4 * len(names) * max(n_frames, len(people))
    content.require_memory(size, f"{len(names)} keypoints in {n_frames} frames")
    points, confidence = _stack_people(content, people, len(names))
    limit = limit if options.confidence is None else options.confidence
    # Not `<`, so that NaN counts as not seen.
    is_unsure = ~(confidence >= limit)
    points[is_unsure] = np.nan
    points[~np.isfinite(points).all(axis=2)] = np.nan
    detected = [person.who for person in people]
    rows, name, all_people, remarks = select_person(
        content.path, rows_frames, points, detected, options.person
    )
    positions = np.full((n_frames, len(names), 3), np.nan)
    positions[rows_frames[rows]] = points[rows]
    if n_unsure := int(is_unsure[rows].sum()):
        remarks.append(f"{format_count(n_unsure, 'position')} below confidence {limit:g} not used")
    remarks += notes
    if unit == "pixel" and not options.unit and is_relative(points):
        content.warn(
            "keypoints are relative to an image of unknown size, assumed square: "
            "otherwise multiply x and z by width / height"
        )
    if unit == "pixel" and np.nanmax(np.abs(points[..., 2]), initial=0.0) == 0:
        remarks.append("two-dimensional: z is 0, and image rows count downwards")
    provenance = content.provenance(program, remarks).of_person(name, all_people)
    named_points = Points(names, positions, fps, options.unit or unit, options.up or up)
    return to_motion(named_points, provenance)


def is_relative(points: Floats) -> bool:
    """Return whether points in an image are fractions of its width and height, not pixels."""
    sizes = np.abs(points[..., :2]).max(axis=-1)
    # Most of them: single keypoints may be at the corner, or far outside of the image.
    return bool(np.nanquantile(sizes, 0.9) < SMALLEST_PIXEL)


def name_people(entries: Sequence[Mapping[str, Any]], *keys: str) -> list[str | None]:
    """Return the person of each entry by the first of the keys that all entries have, or None."""
    key = next((key for key in keys if all(each.get(key) is not None for each in entries)), None)
    return [_to_name(each[key]) if key else None for each in entries]


def _to_name(number: Any) -> str | None:
    """Return the name of a person; AlphaPose writes [1.0] for 1, OpenPose [-1] for None."""
    if isinstance(number, list) and len(number) == 1:
        number = number[0]
    if number in (-1, []):
        return None
    is_whole = isinstance(number, float) and number.is_integer()
    return str(int(number) if is_whole else number)[:40]


def parse_json(content: FileContent) -> Any:
    """Return the content of a JSON file; raise ReadError if it is invalid."""
    try:
        return json.loads(content.text)
    except json.JSONDecodeError as error:
        reason = f"is not a complete JSON file: {error.msg[0].lower()}{error.msg[1:]}"
        raise content.error(reason, error.lineno) from None
    except (RecursionError, ValueError) as error:
        raise content.error(f"is not a complete JSON file: {str(error).split(';')[0]}") from None


def order_by_number(frames: Mapping[Any, Any]) -> list[tuple[int, Any]]:
    """Return the frames of a JSON object ordered by their numeric keys; empty for other keys."""
    if not all(isinstance(key, str) and key.isdecimal() and len(key) < 19 for key in frames):
        return []
    return sorted(((int(key), frame) for key, frame in frames.items()), key=itemgetter(0))


def split_groups(content: FileContent, values: Any, width: int) -> Floats:
    """Return a flat list of numbers, as OpenPose and COCO store, as (keypoints, width)."""
    try:
        flat = np.asarray(values, np.float64).ravel()
    except (ValueError, TypeError, OverflowError):
        raise content.error("keypoints are not a list of numbers") from None
    if len(flat) % width:
        raise content.error(f"{len(flat)} numbers for keypoints of {width} each")
    return flat.reshape(-1, width)


def to_frame_numbers(content: FileContent, frames: Floats | Ints) -> NDArray[np.int64]:
    """Return frame numbers as integers; raise ReadError if they are not."""
    if not np.isfinite(frames).all() or np.abs(frames).max(initial=0) > 2**53:
        raise content.error("the frame numbers are not whole numbers")
    return np.rint(frames).astype(np.int64)


def _number_frames(
    content: FileContent, video_frames: Sequence[int], people_frames: list[int]
) -> tuple[NDArray[np.intp], int]:
    """Return the frame of each detected person, counted from 0, and the number of frames.

    ``video_frames`` includes frames without people, if the file lists them.
    """
    numbers = {*people_frames, *video_frames}
    first, last = min(numbers), max(numbers)
    if last - first >= MAX_FRAMES_RATIO * (len(numbers) + 1):
        raise content.error(
            f"the numbers of {len(numbers)} frames run from {first} to {last}: these cannot "
            "be frame numbers"
        )
    return np.array([frame - first for frame in people_frames], np.intp), last - first + 1


def _stack_people(content: FileContent, people: Sequence[Person], k: int) -> tuple[Floats, Floats]:
    """Return (people, keypoints, 3) and (people, keypoints); a missing z is 0."""
    points, confidence = [], []
    for person in people:
        try:
            pose = np.asarray(person.points, np.float64)
            scores = np.asarray(person.confidence, np.float64)
        except (ValueError, TypeError, OverflowError):
            raise content.error(
                f"frame {person.frame} has keypoints that are not numeric"
            ) from None
        if pose.ndim != 2 or pose.shape[1] not in (2, 3) or not k == len(pose) == scores.size:
            raise content.error(
                f"frame {person.frame} has keypoints of shape {pose.shape}, where {k} are expected"
            )
        # Two-dimensional keypoints get a third coordinate of 0.
        points.append(np.pad(pose, ((0, 0), (0, 3 - pose.shape[1]))))
        confidence.append(scores.ravel())
    return np.stack(points), np.stack(confidence)
