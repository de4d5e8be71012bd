"""Segments as clips: a folder with a file each, and lists of them.

A clip of a motion is a BVH, or of another format that is asked for; a CSV of joint positions
where it has no rotations (see `kineme.formats.tables`). Of a format that holds several motions,
such as GLB, there is one file for each recording, with its clips as animations; given the path of
such a file instead of a folder, all clips go there, into a copy of the file that they came from
where that is of the same format. A clip of signals
is rows of their own file (see `kineme.formats.channels.writing`). Files are called
``RECORDING_NUMBER_TEXT`` (see `kineme.clips.names`), with the text of `kineme.labels.spans`.

``manifest.csv`` has a row per clip, in the order of the segments; ``manifest.json`` says more of
it (see `kineme.clips.manifest`):

============================ =====================================================
``file``, ``source``         the clip, the recording it was cut from
``start_frame``, ...         ``stop_frame``, ``start_s``, ``stop_s``: where in it
``level``, ``kind``          as in the segment table
``cluster``, ``label``       as in the segment table
``rank``, ``cost``           of loops only: its place in its cluster, 1 the best, and
                             what it was placed by (see `kineme.clips.quality`)
``turn_deg``, ``x_m``,       of loops only: what carries one round to the next, a
``z_m``                      turn about the vertical axis, then a shift
``animation``                of files with several clips only: the name of the clip
============================ =====================================================

The folder appears whole or not at all, and nothing that was there is touched.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any, get_args

from kineme._util.checks import is_number, is_one_of
from kineme._util.files import atomic_folder
from kineme.clips import RootMotionMode
from kineme.clips.manifest import Clip, write_manifests
from kineme.clips.names import file_name, safe_name, unlike
from kineme.clips.shaping import Shape, ShapedClip, shape_clips
from kineme.errors import MotionError, ParameterError
from kineme.features import mirror as mirrored
from kineme.formats import write
from kineme.formats.channels.writing import rows_of
from kineme.formats.registry import Format, supported_formats, writer_of
from kineme.labels.spans import text_of
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment


def split(
    recording: Motion | Signals,
    segmentation: Segmentation,
    folder: str | PathLike[str],
    *,
    level: Level = "activity",
    cluster: int | None = None,
    loops: bool = False,
    format: str | None = None,  # noqa: A002 (as in read_segments)
    best: int | None = None,
    root_motion: RootMotionMode = "keep",
    straight: bool = False,
    mirror: bool = False,
    close: bool = False,
) -> list[Path]:
    """Write each segment as a clip of its own; for each clip the path of its file.

    Parameters
    ----------
    recording : Motion or Signals
        What was segmented.
    segmentation : Segmentation
        Its segments, of as many frames.
    folder : str or PathLike
        To be made; one that is there must be empty. A path that ends as a format that holds several
        motions, such as ``clips.glb``, is one file with all clips as its animations.
    level : {"activity", "primitive"}, optional
        The segments to take; without a cluster all, transitions too.
    cluster : int, optional
        See `level`.
    loops : bool, optional
        Blend the ends of each clip but transitions (see `kineme.clips.loops`); motions only.
    format : str, optional
        The suffix of a format that motions are written in, such as "bvh", "amc" or "glb".
    best : int, optional
        Of loops: so many of each cluster, the best ones (see `kineme.clips.quality`), and no
        transitions.
    root_motion : {"keep", "extract", "in-place"}, optional
        Keep it; move it to a root bone, which is added where there is none; or put each clip to
        the origin, facing +z, without it (see `kineme.clips.root_motion`). The manifest has it.
    straight : bool, optional
        Take the turn out, so that the body goes straight on.
    mirror : bool, optional
        Exchange left and right.
    close : bool, optional
        Repeat the first frame of each loop at its end, as engines want it.

    Raises
    ------
    MotionError
        The segments are of another recording.
    ParameterError
        No segment is of that level and cluster, loops or a format of signals, no format of
        that suffix, or the best of what is no loop.
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
    rows = [row for row in segmentation.level(level) if cluster in (None, row.cluster)]
    if not rows:
        found = sorted({row.cluster for row in segmentation.level(level)} - {-1})
        raise ParameterError(f"no {level} is in cluster {cluster}; there are {found}")
    return write_clips(
        [(recording, rows)],
        folder,
        loops=loops,
        format=format,
        best=best,
        root_motion=root_motion,
        straight=straight,
        mirror=mirror,
        close=close,
    )


def write_clips(
    clips: Iterable[tuple[Motion | Signals, Sequence[Segment]]],
    folder: str | PathLike[str],
    *,
    loops: bool = False,
    format: str | None = None,  # noqa: A002
    best: int | None = None,
    root_motion: RootMotionMode = "keep",
    straight: bool = False,
    mirror: bool = False,
    close: bool = False,
) -> list[Path]:
    """Write segments of several recordings as clips in one folder; for each clip its file.

    They are gone through once, so that one recording at a time needs memory. The rest is as for
    `split`; loops are ranked among those of their recording.
    """
    target, chosen = Path(folder), _format(format)
    shape = Shape(loops, best, root_motion, straight, mirror, close)
    one_file = writer_of(target.suffix.lower()) if target.suffix else None
    if one_file is not None and one_file.write_animations is not None and not target.is_dir():
        return _write_one_file(clips, target, one_file, shape, format)
    entries: list[Clip] = []
    several = chosen is not None and chosen.write_animations is not None
    with atomic_folder(target) as draft:
        first, files = 0, set[str]()
        # Numbers go on over the recordings, so that names stay unique in the folder.
        for recording, rows in clips:
            run = _Run(recording, first, draft, shape.changes)
            first += len(rows)
            if isinstance(recording, Signals):
                _refuse_poses(shape, format)
                entries += _write_rows(run, recording, rows)
                continue
            motion = mirrored(recording) if mirror else recording
            made = shape_clips(motion, rows, shape)
            if chosen is not None and chosen.write_animations is not None:
                file = unlike(run.stem, run.first, files)
                files.add(file.casefold())
                path = draft / f"{file}.{format}"
                entries += _write_animations(run, made, path, chosen.write_animations)
            else:
                suffix = format or ("csv" if motion.rotations is None else "bvh")
                entries += _write_files(run, made, suffix)
        write_manifests(entries, draft, loops=loops, animations=several)
    return [target / clip.file for clip in entries]


def _write_one_file(
    clips: Iterable[tuple[Motion | Signals, Sequence[Segment]]],
    target: Path,
    chosen: Format,
    shape: Shape,
    suffix: str | None,
) -> list[Path]:
    """Leave all clips of a recording in one file, a copy of its own where it is of that format."""
    if suffix is not None and f".{suffix}" != target.suffix.lower():
        raise ParameterError(f"format is {suffix!r:.60}, but the file is {target.name!r:.60}")
    (recording, rows), *others = clips
    if others:
        raise ParameterError(f"{target.name} holds clips of one recording: give a folder")
    if isinstance(recording, Signals):
        raise ParameterError(f"signals are no animations of {target.name}: give a folder")
    run = _Run(recording, 0, target.parent, shape.changes)
    source = Path(run.source)
    if run.source and source.exists() and target.exists() and source.samefile(target):
        raise ParameterError(f"{target} would take the place of its recording: give another name")
    motion = mirrored(recording) if shape.mirror else recording
    made = list(shape_clips(motion, rows, shape))
    animations = {run.shaped_clip(each, target.name).name: each.motion for each in made}
    if not animations:
        raise ParameterError(f"there is no clip to write to {target.name}")
    if chosen.copy_animations is not None and chosen.name == recording.provenance.format:
        chosen.copy_animations(animations, source, target)
    elif chosen.write_animations is not None:
        chosen.write_animations(animations, target)
    return [target] * len(made)


def _refuse_poses(shape: Shape, format: str | None) -> None:  # noqa: A002
    """ParameterError where signals are to be treated as bodies."""
    if shape.loops:
        raise ParameterError("signals have no pose to blend: leave out loops (--loop)")
    if shape.changes:
        raise ParameterError(
            "signals have no pose: leave out root_motion, straight and mirror "
            "(--root-motion, --straight, --mirror)"
        )
    if format is not None:
        raise ParameterError("signals are rows of their file: leave out format")


def _format(suffix: str | None) -> Format | None:
    """Return the format of a suffix; ParameterError where no motions are written in it."""
    if suffix is None:
        return None
    found = writer_of(f".{suffix}")
    if found is None:
        suffixes = sorted(s for each in supported_formats() if each.write for s in each.suffixes)
        names = ", ".join(name.removeprefix(".") for name in suffixes)
        raise ParameterError(f"format is {suffix!r:.60}: motions are written as {names}")
    return found


@dataclass(frozen=True)
class _Run:
    """Clips of one recording, numbered from ``first`` in their folder."""

    recording: Motion | Signals
    first: int
    folder: Path
    changes: tuple[str, ...]

    @property
    def stem(self) -> str:
        return Path(self.source or "recording").stem

    def file(self, index: int, segment: Segment, suffix: str) -> str:
        """Return the name of the file of one clip, the segment of that place among those given."""
        return f"{file_name(self.stem, self.first + index, text_of(segment))}{suffix}"

    def clip(self, index: int, segment: Segment, file: str, **fields: Any) -> Clip:
        """Return what the lists say of it; the other fields are those of `Clip`."""
        return Clip(
            name=safe_name(self.stem, self.first + index, text_of(segment)),
            file=file,
            source=self.source.encode(errors="backslashreplace").decode(),
            segment=segment,
            fps=self.recording.fps,
            **fields,
        )

    def shaped_clip(self, made: ShapedClip, file: str) -> Clip:
        """Return the same of a motion that was made of it."""
        return self.clip(
            made.index,
            made.segment,
            file,
            n_frames=made.motion.n_frames,
            carry=made.carry,
            quality=made.quality,
            rank=made.rank,
            root=made.root,
            planted=made.planted,
            poses=made.poses,
            changes=self.changes,
        )

    @property
    def source(self) -> str:
        return str(self.recording.provenance.path or "")


def _write_rows(run: _Run, signals: Signals, rows: Sequence[Segment]) -> Iterator[Clip]:
    """Leave each clip in a file of its own: rows of the recording's."""
    shortest = min((row.stop_frame - row.start_frame for row in rows), default=None)
    file_rows = rows_of(signals, shortest=shortest)
    for index, row in enumerate(rows):
        file = run.file(index, row, file_rows.suffix)
        file_rows.write(run.folder / file, row.start_frame, row.stop_frame)
        yield run.clip(index, row, file, n_frames=row.stop_frame - row.start_frame)


def _write_files(run: _Run, made: Iterable[ShapedClip], suffix: str) -> Iterator[Clip]:
    """Leave each clip in a file of its own."""
    for each in made:
        file = run.file(each.index, each.segment, f".{suffix}")
        write(each.motion, run.folder / file)
        yield run.shaped_clip(each, file)


def _write_animations(
    run: _Run,
    made: Iterable[ShapedClip],
    path: Path,
    write_all: Callable[[Mapping[str, Motion], Path], object],
) -> list[Clip]:
    """Leave all clips in one file."""
    clips, animations = list[Clip](), dict[str, Motion]()
    for each in made:
        clip = run.shaped_clip(each, path.name)
        clips.append(replace(clip, animation=clip.name))
        animations[clip.name] = each.motion
    if animations:
        write_all(animations, path)
    return clips
