"""Segments as clips: a folder with a motion file each, and a manifest of them.

A clip is a BVH; a CSV of joint positions where the motion has no rotations
(see :mod:`kineme.formats.tables.tables`). Clips are called ``RECORDING_NUMBER_TEXT``, with the text of
:mod:`kineme.labels.spans` and ``_`` for what file systems dislike.

``manifest.csv`` has a row per clip:

============================ =====================================================
``file``, ``source``         the clip, the recording it was cut from
``start_frame``, ...         ``stop_frame``, ``start_s``, ``stop_s``: where in it
``level``, ``kind``          as in the segment table
``cluster``, ``label``       as in the segment table
``turn_deg``, ``x_m``,       of loops only: what carries one round to the next, a
``z_m``                      turn about the vertical axis, then a shift
============================ =====================================================

The folder appears whole or not at all, and nothing that was there is touched.
"""

from __future__ import annotations

import csv
import secrets
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import degrees
from os import PathLike
from pathlib import Path

from kineme.clips.loops import loop
from kineme.errors import MotionError, ParameterError, WriteError
from kineme.formats import write
from kineme.labels.spans import text_of
from kineme.recordings.motion import Motion
from kineme.recordings.operations import cut
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

MANIFEST = "manifest.csv"
SPANS = ("start_frame", "stop_frame", "start_s", "stop_s", "level", "kind", "cluster", "label")
CARRY = ("turn_deg", "x_m", "z_m")


def split(
    motion: Motion,
    segmentation: Segmentation,
    folder: str | PathLike[str],
    *,
    level: Level = "activity",
    cluster: int | None = None,
    loops: bool = False,
) -> list[Path]:
    """Write each segment as a clip of its own; the paths of the clips.

    Parameters
    ----------
    motion : the recording that was segmented
    segmentation : its segments, of as many frames
    folder : to be made; one that is there must be empty
    level, cluster : the segments to take; without a cluster all, transitions too
    loops : blend the ends of each clip (see :mod:`kineme.clips.loops`)

    Raises
    ------
    MotionError : the segments are of another recording
    ParameterError : no segment is of that level and cluster
    WriteError : the folder is not empty, or cannot be written
    """
    if segmentation.n_frames != motion.n_frames:
        raise MotionError(
            f"the segments are of a recording of {segmentation.n_frames} frames, "
            f"this one has {motion.n_frames}"
        )
    rows = [row for row in segmentation.level(level) if cluster in (None, row.cluster)]
    if not rows:
        found = sorted({row.cluster for row in segmentation.level(level)} - {-1})
        raise ParameterError(f"no {level} is in cluster {cluster}; there are {found}")
    target = Path(folder)
    names = [_name(motion, number, row) for number, row in enumerate(rows)]
    with _new_folder(target) as draft:
        carries = [
            _write_clip(cut(motion, row.start_frame, row.stop_frame), draft / name, loops=loops)
            for row, name in zip(rows, names, strict=True)
        ]
        _write_manifest(draft / MANIFEST, motion, rows, names, carries)
    return [target / name for name in names]


def _name(motion: Motion, number: int, row: Segment) -> str:
    source = Path(motion.provenance.path or "motion").stem
    suffix = ".csv" if motion.rotations is None else ".bvh"
    return f"{_plain(source)}_{number:04d}_{_plain(text_of(row))}{suffix}"


def _plain(text: str) -> str:
    """Letters, digits and ``_`` and ``-``; short enough for any file system."""
    kept = "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in text)
    return kept.encode(errors="replace")[:80].decode(errors="ignore")


@contextmanager
def _new_folder(target: Path) -> Iterator[Path]:
    """A folder beside ``target`` that takes its place when the block ends without an error."""
    if target.exists() and not (target.is_dir() and not any(target.iterdir())):
        raise WriteError(target, "is there already: name a new folder, or empty this one")
    draft = target.parent / f".{secrets.token_hex(6)}"
    try:
        draft.mkdir()
    except OSError as error:
        reason = f"cannot be made: {target.parent}: {error.strerror or error}"
        raise WriteError(target, reason) from error
    try:
        yield draft
        if target.is_dir():
            target.rmdir()
        draft.rename(target)
    except OSError as error:
        raise WriteError(target, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _write_clip(clip: Motion, path: Path, *, loops: bool) -> tuple[float, ...]:
    """Leave a clip at ``path``; what carries a loop on, else nothing."""
    numbers: tuple[float, ...] = ()
    if loops:
        clip, carry = loop(clip)
        numbers = (degrees(carry.turn), carry.x, carry.z)
    write(clip, path)
    return numbers


def _write_manifest(
    path: Path,
    motion: Motion,
    rows: Sequence[Segment],
    names: Sequence[str],
    carries: Sequence[tuple[float, ...]],
) -> None:
    source = str(motion.provenance.path or "").encode(errors="backslashreplace").decode()
    with path.open("w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(["file", "source", *SPANS, *(CARRY if carries[0] else ())])
        for row, name, carry in zip(rows, names, carries, strict=True):
            lines.writerow([name, source, *(getattr(row, span) for span in SPANS), *carry])
