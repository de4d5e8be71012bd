"""Segments as clips: a folder with a file each, and a manifest of them.

A clip of a motion is a BVH; a CSV of joint positions where it has no rotations
(see `kineme.formats.tables`). A clip of signals is rows of their own file
(see `kineme.formats.channels.writing`). Clips are called
``RECORDING_NUMBER_TEXT``, with the text of
`kineme.labels.spans` and ``_`` for what file systems dislike.

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
from collections.abc import Callable, Iterable, Sequence
from math import degrees
from os import PathLike
from pathlib import Path
from typing import get_args

from kineme._checks import check_flag, is_number, is_one_of
from kineme._files import atomic_folder
from kineme.clips.loops import loop
from kineme.errors import MotionError, ParameterError
from kineme.formats import write
from kineme.formats.channels.writing import rows_of
from kineme.formats.delimited import as_text
from kineme.labels.spans import text_of
from kineme.recordings import Motion, Signals
from kineme.recordings.operations import cut
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

MANIFEST = "manifest.csv"
SPANS = ("start_frame", "stop_frame", "start_s", "stop_s", "level", "kind", "cluster", "label")
CARRY = ("turn_deg", "x_m", "z_m")

Write = Callable[[Segment, Path], tuple[float, ...]]
"""Leaves the clip of a segment in a file; gives what carries a loop on, else nothing."""


def split(
    recording: Motion | Signals,
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
    recording : Motion or Signals
        What was segmented.
    segmentation : Segmentation
        Its segments, of as many frames.
    folder : str or PathLike
        To be made; one that is there must be empty.
    level : {"activity", "primitive"}, optional
        The segments to take; without a cluster all, transitions too.
    cluster : int, optional
        See `level`.
    loops : bool, optional
        Blend the ends of each clip (see `kineme.clips.loops`); motions only.

    Raises
    ------
    MotionError
        The segments are of another recording.
    ParameterError
        No segment is of that level and cluster, or loops of signals.
    WriteError
        The folder is not empty, or cannot be written.

    Examples
    --------
    >>> import kineme
    >>> from kineme.clips.split import split
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> motion = kineme.read(bundled_recording())
    >>> truth = kineme.read_segments(bundled_truth(), fps=motion.fps, n_frames=motion.n_frames)
    >>> [path.name for path in split(motion, truth, "clips")[:2]]
    ['exercises_0000_walk.bvh', 'exercises_0001_transition.bvh']
    """
    if segmentation.n_frames != recording.n_frames:
        raise MotionError(
            f"the segments are of a recording of {segmentation.n_frames} frames, "
            f"this one has {recording.n_frames}"
        )
    if not is_one_of(level, get_args(Level)):
        raise ParameterError(f"level must be {' or '.join(get_args(Level))}, not {level!r:.60}")
    if cluster is not None and not is_number(cluster):
        raise ParameterError(f"a cluster is a number, not {cluster!r:.60}")
    check_flag(loops, "loops")
    rows = [row for row in segmentation.level(level) if cluster in (None, row.cluster)]
    if not rows:
        found = sorted({row.cluster for row in segmentation.level(level)} - {-1})
        raise ParameterError(f"no {level} is in cluster {cluster}; there are {found}")
    return write_clips([(recording, rows)], folder, loops=loops)


def write_clips(
    clips: Iterable[tuple[Motion | Signals, Sequence[Segment]]],
    folder: str | PathLike[str],
    *,
    loops: bool = False,
) -> list[Path]:
    """Write segments of several recordings as clips in one folder; the paths of the clips.

    Parameters
    ----------
    clips : iterable of (Motion or Signals, sequence of Segment)
        Gone through once, so that one recording at a time needs memory.
    folder : str or PathLike
        To be made; one that is there must be empty.
    loops : bool, optional
        Blend the ends of each clip; motions only.

    Raises
    ------
    ParameterError
        Loops of signals.
    WriteError
        The folder is not empty, or cannot be written.
    """
    target = Path(folder)
    lines: list[list[object]] = []
    with atomic_folder(target) as draft:
        for recording, rows in clips:
            shortest = min((row.stop_frame - row.start_frame for row in rows), default=None)
            suffix, write_clip = _writer(recording, shortest, loops=loops)
            path = str(recording.provenance.path or "")
            stem = _plain(Path(path or "recording").stem)
            source = path.encode(errors="backslashreplace").decode()
            for row in rows:
                name = f"{stem}_{len(lines):04d}_{_plain(text_of(row))}{suffix}"
                carry = write_clip(row, draft / name)
                lines.append([name, source, *(getattr(row, span) for span in SPANS), *carry])
        _write_manifest(draft / MANIFEST, CARRY if loops else (), lines)
    return [target / str(name) for name, *_ in lines]


def _writer(recording: Motion | Signals, shortest: int | None, *, loops: bool) -> tuple[str, Write]:
    """The suffix of clips, and what writes one."""
    if isinstance(recording, Signals):
        if loops:
            raise ParameterError("signals have no pose to blend: leave out loops (--loop)")
        file_rows = rows_of(recording, shortest=shortest)

        def write_rows(row: Segment, path: Path) -> tuple[float, ...]:
            file_rows.write(path, row.start_frame, row.stop_frame)
            return ()

        return file_rows.suffix, write_rows

    def write_motion(row: Segment, path: Path) -> tuple[float, ...]:
        clip = cut(recording, row.start_frame, row.stop_frame)
        if not loops:
            write(clip, path)
            return ()
        clip, carry = loop(clip)
        write(clip, path)
        return degrees(carry.turn), carry.x, carry.z

    return ".csv" if recording.rotations is None else ".bvh", write_motion


def _plain(text: str) -> str:
    """Letters, digits and ``_`` and ``-``; short enough for any file system."""
    kept = "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in text)
    return kept.encode(errors="replace")[:80].decode(errors="ignore")


def _write_manifest(path: Path, more: Sequence[str], lines: Sequence[Sequence[object]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["file", "source", *SPANS, *more])
        for line in lines:
            table.writerow([as_text(cell) if isinstance(cell, str) else cell for cell in line])
