"""Segments as clips: a folder with a file each, and a manifest of them.

A clip of a motion is a BVH, or of another format that is asked for; a CSV of joint positions
where it has no rotations (see `kineme.formats.tables`). Of a format that holds several motions,
such as GLB, there is one file for each recording, with its clips as animations. A clip of signals
is rows of their own file (see `kineme.formats.channels.writing`). Clips are called
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
``animation``                of files with several clips only: the name of the clip
============================ =====================================================

The folder appears whole or not at all, and nothing that was there is touched.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
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
from kineme.formats.registry import Format, supported_formats, writer_of
from kineme.labels.spans import text_of
from kineme.recordings import Motion, Signals
from kineme.recordings.operations import cut
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

MANIFEST = "manifest.csv"
SPANS = ("start_frame", "stop_frame", "start_s", "stop_s", "level", "kind", "cluster", "label")
CARRY = ("turn_deg", "x_m", "z_m")
ANIMATION = "animation"

Clips = Sequence[tuple[str, Segment]]
"""Names without a suffix, and the segments."""

Lines = list[tuple[str, tuple[object, ...]]]
"""For each clip its file, and what the manifest says of it besides the segment."""


def split(
    recording: Motion | Signals,
    segmentation: Segmentation,
    folder: str | PathLike[str],
    *,
    level: Level = "activity",
    cluster: int | None = None,
    loops: bool = False,
    format: str | None = None,  # noqa: A002 (as in read_segments)
) -> list[Path]:
    """Write each segment as a clip of its own; for each clip the path of its file.

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
    format : str, optional
        The suffix of a format that motions are written in, such as "bvh", "amc" or "glb".

    Raises
    ------
    MotionError
        The segments are of another recording.
    ParameterError
        No segment is of that level and cluster, loops or a format of signals, or no format of
        that suffix.
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
    return write_clips([(recording, rows)], folder, loops=loops, format=format)


def write_clips(
    clips: Iterable[tuple[Motion | Signals, Sequence[Segment]]],
    folder: str | PathLike[str],
    *,
    loops: bool = False,
    format: str | None = None,  # noqa: A002
) -> list[Path]:
    """Write segments of several recordings as clips in one folder; for each clip its file.

    Parameters
    ----------
    clips : iterable of (Motion or Signals, sequence of Segment)
        Gone through once, so that one recording at a time needs memory.
    folder : str or PathLike
        To be made; one that is there must be empty.
    loops : bool, optional
        Blend the ends of each clip; motions only.
    format : str, optional
        As for `split`.

    Raises
    ------
    ParameterError
        Loops or a format of signals, or no format of that suffix.
    WriteError
        The folder is not empty, or cannot be written.
    """
    target, chosen = Path(folder), _format(format)
    lines: list[list[object]] = []
    with atomic_folder(target) as draft:
        for recording, rows in clips:
            path = str(recording.provenance.path or "")
            stem = _plain(Path(path or "recording").stem)
            source = path.encode(errors="backslashreplace").decode()
            named = [
                (f"{stem}_{number:04d}_{_plain(text_of(row))}", row)
                for number, row in enumerate(rows, len(lines))
            ]
            if isinstance(recording, Signals):
                if loops:
                    raise ParameterError("signals have no pose to blend: leave out loops (--loop)")
                if format is not None:
                    raise ParameterError("signals are rows of their file: leave out format")
                written = _write_rows(recording, named, draft)
            elif chosen is None or chosen.write_animations is None:
                suffix = format or ("csv" if recording.rotations is None else "bvh")
                written = _write_files(recording, named, draft, suffix, loops=loops)
            else:
                file = draft / f"{stem}.{format}"
                if file.exists():  # another recording of this name
                    file = draft / f"{stem}_{len(lines):04d}.{format}"
                written = _write_animations(recording, named, file, chosen, loops=loops)
            for row, (name, more) in zip(rows, written, strict=True):
                lines.append([name, source, *(getattr(row, span) for span in SPANS), *more])
        several = chosen is not None and chosen.write_animations is not None
        columns = [*(CARRY if loops else ()), *((ANIMATION,) if several else ())]
        _write_manifest(draft / MANIFEST, columns, lines)
    return [target / str(name) for name, *_ in lines]


def _format(suffix: str | None) -> Format | None:
    """The format of a suffix; ParameterError where no motions are written in it."""
    if suffix is None:
        return None
    found = writer_of(f".{suffix}")
    if found is None:
        suffixes = sorted(s for each in supported_formats() if each.write for s in each.suffixes)
        names = ", ".join(name.removeprefix(".") for name in suffixes)
        raise ParameterError(f"format is {suffix!r:.60}: motions are written as {names}")
    return found


def _write_rows(signals: Signals, clips: Clips, folder: Path) -> Lines:
    """Leave each clip in a file of its own: rows of the recording's."""
    shortest = min((row.stop_frame - row.start_frame for _, row in clips), default=None)
    file_rows = rows_of(signals, shortest=shortest)
    written: Lines = []
    for name, row in clips:
        file_rows.write(folder / f"{name}{file_rows.suffix}", row.start_frame, row.stop_frame)
        written.append((f"{name}{file_rows.suffix}", ()))
    return written


def _write_files(motion: Motion, clips: Clips, folder: Path, suffix: str, *, loops: bool) -> Lines:
    """Leave each clip in a file of its own."""
    written: Lines = []
    for name, row in clips:
        clip, carry = _clip(motion, row, loops=loops)
        write(clip, folder / f"{name}.{suffix}")
        written.append((f"{name}.{suffix}", carry))
    return written


def _write_animations(
    motion: Motion, clips: Clips, path: Path, chosen: Format, *, loops: bool
) -> Lines:
    """Leave all clips in one file."""
    animations: dict[str, Motion] = {}
    written: Lines = []
    for name, row in clips:
        animations[name], carry = _clip(motion, row, loops=loops)
        written.append((path.name, (*carry, name)))
    if chosen.write_animations is not None and animations:
        chosen.write_animations(animations, path)
    return written


def _clip(motion: Motion, row: Segment, *, loops: bool) -> tuple[Motion, tuple[float, ...]]:
    """A segment as a motion; of a loop also what carries one round to the next."""
    clip = cut(motion, row.start_frame, row.stop_frame)
    if not loops:
        return clip, ()
    clip, carry = loop(clip)
    return clip, (degrees(carry.turn), carry.x, carry.z)


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
