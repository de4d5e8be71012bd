"""Segments as clips: a folder with a file each, and lists of them.

A clip of a motion is a BVH, or of another format that is asked for; a CSV of joint positions
where it has no rotations (see `kineme.formats.tables`). Of a format that holds several motions,
such as GLB, there is one file for each recording, with its clips as animations; given the path of
such a file instead of a folder, all clips go there, into a copy of the file that they came from
where that is of the same format, and the lists beside it, as ``clips.manifest.csv`` for
``clips.glb``. A clip of signals
is rows of their own file (see `kineme.formats.channels.writing`). Files are called
``RECORDING_NUMBER_TEXT`` (see `kineme.clips.names`), with the text of `kineme.labels.spans`.

``manifest.csv`` has a row per clip, in the order of the segments; ``manifest.json`` says more of
it (see `kineme.clips.manifest`):

============================ =====================================================
``file``, ``source``         the clip, the recording it was cut from
``start_frame``, ...         ``stop_frame``, ``start_s``, ``stop_s``: where in it
``level``, ``kind``          as in the segment table
``cluster``, ``label``       as in the segment table
``tags``                     direction, turn, start and stop (see `kineme.clips.tags`)
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
from typing import Any, Unpack, get_args

from kineme._util.checks import is_number, is_one_of
from kineme._util.files import atomic_folder, atomic_write
from kineme.clips.companions import Companions
from kineme.clips.manifest import (
    MANIFEST,
    MANIFEST_JSON,
    Clip,
    name_manifests,
    write_manifests,
)
from kineme.clips.names import fill_template, make_clip_name, make_file_name, make_unique_name
from kineme.clips.options import Chosen, ClipOptions, resolve_options
from kineme.clips.shaping import RankedLoop, ShapedClip, shape_clips
from kineme.errors import MotionError, ParameterError, WriteError
from kineme.features import mirror as mirrored
from kineme.formats import write
from kineme.formats.channels.writing import make_rows
from kineme.formats.registry import Format, find_writer
from kineme.labels.spans import format_text
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

Source = (
    tuple[Motion | Signals, Sequence[Segment]]
    | tuple[Motion | Signals, Sequence[Segment], Sequence[RankedLoop]]
)
"""A recording, its segments, and those of them that become loops, where they are ranked already."""


def split(
    recording: Motion | Signals,
    segmentation: Segmentation,
    folder: str | PathLike[str],
    *,
    level: Level = "activity",
    cluster: int | None = None,
    **options: Unpack[ClipOptions],
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

    Other Parameters
    ----------------
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
    fps : float, optional
        Frames per second of the clips, whose borders go to whole frames; of motions only.
    name : str, optional
        Template of names, such as ``{take}_{label}_{n:02}`` (see `kineme.clips.names.FIELDS`).
    target : {"unreal", "unity", "blender", "godot"}, optional
        Format, root motion, closing and names as that program wants them, unless given.
    sheet : str or PathLike, optional
        A picture to write: a strip of small figures for each clip.
    motion_matching : str or PathLike, optional
        A database to write, ``.npz`` or ``.bin`` (see `kineme.clips.motion_matching`).

    Raises
    ------
    MotionError
        The segments are of another recording.
    ParameterError
        No segment is of that level and cluster, loops or a format of signals, no format of
        that suffix, the best of what is no loop, or names that clash.
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
    return split_all([(recording, segmentation)], folder, level=level, cluster=cluster, **options)


def split_all(
    found: Sequence[tuple[Motion | Signals, Segmentation]],
    folder: str | PathLike[str],
    *,
    level: Level = "activity",
    cluster: int | None = None,
    **options: Unpack[ClipOptions],
) -> list[Path]:
    """Write the segments of several recordings as `split` does, such as of all takes of a file."""
    if not is_one_of(level, get_args(Level)):
        raise ParameterError(f"level must be {' or '.join(get_args(Level))}, not {level!r:.60}")
    if cluster is not None and not is_number(cluster):
        raise ParameterError(f"a cluster is a number, not {cluster!r:.60}")
    clips: list[Source] = []
    for recording, segmentation in found:
        if segmentation.n_frames != recording.n_frames:
            raise MotionError(
                f"the segments are of a recording of {segmentation.n_frames} frames, "
                f"this one has {recording.n_frames}"
            )
        rows = [row for row in segmentation.level(level) if cluster in (None, row.cluster)]
        clips.append((recording, rows))
    if not any(rows for _, rows, *_ in clips):
        there = {row.cluster for _, segmentation in found for row in segmentation.level(level)}
        raise ParameterError(
            f"no {level} is in cluster {cluster}; there are {sorted(there - {-1})}"
        )
    return write_clips(clips, folder, **options)


def write_clips(
    clips: Iterable[Source],
    folder: str | PathLike[str],
    *,
    together: bool = False,
    **options: Unpack[ClipOptions],
) -> list[Path]:
    """Write segments of several recordings as clips in one folder; for each clip its file.

    They are gone through once, so that one recording at a time needs memory. The rest is as for
    `split`. Loops are ranked among those of their recording, unless they are ranked ``together``.
    """
    target, chosen = Path(folder), resolve_options(options)
    one_file = find_writer(target.suffix.lower()) if target.suffix else None
    if one_file is not None and one_file.write_animations is not None and not target.is_dir():
        return _write_one_file(clips, target, one_file, chosen)
    entries: list[Clip] = []
    write_all = None if chosen.format is None else chosen.format.write_animations
    companions = Companions(chosen.given)
    with atomic_folder(target) as draft:
        first, files, names = 0, set[str](), set[str]()
        # Numbers go on over the recordings, so that names stay unique in the folder.
        for recording, rows, *ranked in clips:
            run = _Run(recording, first, draft, chosen, names)
            first += len(rows)
            if isinstance(recording, Signals):
                _refuse_poses(chosen)
                entries += _write_rows(run, recording, rows)
                continue
            made = _make_clips(run, recording, rows, companions, *ranked)
            if write_all is not None:
                file = make_unique_name(run.stem, run.first, files)
                files.add(file.casefold())
                path = draft / f"{file}.{chosen.suffix}"
                entries += _write_animations(run, made, path, write_all)
            else:
                suffix = chosen.suffix or ("csv" if recording.rotations is None else "bvh")
                entries += _write_files(run, made, suffix)
        write_manifests(
            entries,
            draft / MANIFEST,
            draft / MANIFEST_JSON,
            loops=chosen.shape.loops,
            animations=write_all is not None,
            together=together,
        )
        companions.write()
    return [target / clip.file for clip in entries]


def _write_one_file(
    clips: Iterable[Source], target: Path, found: Format, chosen: Chosen
) -> list[Path]:
    """Leave all clips in one file, a copy of their own where it is of that format.

    They are of one recording, or of takes in one file.
    """
    given = chosen.given.get("format")
    if given is not None and f".{given}" != target.suffix.lower():
        raise ParameterError(f"format is {given!r:.60}, but the file is {target.name!r:.60}")
    sources = list(clips)
    first = sources[0][0]
    if len({recording.provenance.path for recording, *_ in sources}) > 1:
        raise ParameterError(f"{target.name} holds clips of one recording: give a folder")
    source, lists = Path(first.provenance.path or ""), name_manifests(target)
    if source.name and source.exists() and target.exists() and source.samefile(target):
        raise ParameterError(f"{target} would take the place of its recording: give another name")
    if target.exists() and not lists[1].exists():
        raise WriteError(target, "is there already, without a manifest: give another name")
    number, names = 0, set[str]()
    entries, animations = list[Clip](), dict[str, Motion]()
    companions = Companions(chosen.given)
    for recording, rows, *ranked in sources:
        if isinstance(recording, Signals):
            raise ParameterError(f"signals are no animations of {target.name}: give a folder")
        run = _Run(recording, number, target.parent, chosen, names, of_takes=len(sources) > 1)
        number += len(rows)
        made = _make_clips(run, recording, rows, companions, *ranked)
        entries += _add_animations(run, made, target.name, animations)
    if not animations:
        raise ParameterError(f"there is no clip to write to {target.name}")
    with atomic_write(lists[0]) as table, atomic_write(lists[1]) as list_of_all:
        loops = chosen.shape.loops
        write_manifests(entries, table, list_of_all, loops=loops, animations=True)
        if found.copy_animations is not None and found.name == first.provenance.format:
            found.copy_animations(animations, source, target)
        elif found.write_animations is not None:
            found.write_animations(animations, target)
    companions.write()
    return [target] * len(entries)


def _make_clips(
    run: _Run,
    recording: Motion,
    rows: Sequence[Segment],
    companions: Companions,
    ranked: Sequence[RankedLoop] | None = None,
) -> Iterator[ShapedClip]:
    """Yield the clips of a recording, which companions are told of."""
    shape = run.chosen.shape
    motion = mirrored(recording) if shape.mirror else recording
    made = shape_clips(motion, rows, shape, ranked)
    return companions.follow(motion, rows, made, run.clip_name)


def _refuse_poses(chosen: Chosen) -> None:
    """ParameterError where signals are to be treated as bodies."""
    shape = chosen.shape
    if shape.loops:
        raise ParameterError("signals have no pose to blend: leave out loops (--loop)")
    if shape.changes:
        raise ParameterError(
            "signals have no pose: leave out root_motion, straight and mirror "
            "(--root-motion, --straight, --mirror)"
        )
    if chosen.suffix is not None or shape.fps is not None:
        raise ParameterError("signals are rows of their file: leave out format, target and fps")
    if chosen.given.get("sheet") is not None or chosen.given.get("motion_matching") is not None:
        raise ParameterError("signals have no pose: leave out sheet and motion_matching")


@dataclass(frozen=True)
class _Run:
    """Clips of one recording, numbered from ``first`` in their folder.

    ``names`` are those that are taken, in small letters. Clips of takes are called after these.
    """

    recording: Motion | Signals
    first: int
    folder: Path
    chosen: Chosen
    names: set[str]
    of_takes: bool = False

    @property
    def stem(self) -> str:
        return self.take if self.of_takes else Path(self.source or "recording").stem

    @property
    def take(self) -> str:
        return self.recording.provenance.take or Path(self.source or "recording").stem

    def named(
        self, index: int, segment: Segment, tags: Sequence[str] = (), *, loop: bool = False
    ) -> tuple[str, str]:
        """Return the name of a clip and that of its file, of a segment among those given."""
        number, text = self.first + index, format_text(segment)
        template = self.chosen.name
        if template is None:
            return make_clip_name(self.stem, number, text), make_file_name(self.stem, number, text)
        fields = {
            "name": Path(self.source or "recording").stem,
            "take": self.take,
            "label": text,
            "n": number,
            "cluster": segment.cluster,
            "level": segment.level,
            "direction": tags[0] if tags else "",
            "loop": "loop" if loop else "",
        }
        return fill_template(template, fields)

    def clip_name(self, made: ShapedClip) -> str:
        """Return the name of a clip."""
        return self.named(made.index, made.segment, made.tags, loop=made.carry is not None)[0]

    def clip(
        self, index: int, segment: Segment, suffix: str, file: str | None = None, **fields: Any
    ) -> Clip:
        """Return what the lists say of it; the other fields are those of `Clip`.

        It has a file of its own where none is given. ParameterError where its name is taken.
        """
        tags, is_loop = fields.get("tags", ()), fields.get("carry") is not None
        name, own = self.named(index, segment, tags, loop=is_loop)
        for key in {name.casefold(), f"{own.casefold()}{suffix}"} if self.chosen.name else ():
            if key in self.names:
                raise ParameterError(f"two clips would be called {name}: put {{n}} in their name")
            self.names.add(key)
        return Clip(
            name=name,
            file=file or f"{own}{suffix}",
            source=self.source.encode(errors="backslashreplace").decode(),
            segment=segment,
            **fields,
        )

    def shaped_clip(self, made: ShapedClip, file: str | None = None, suffix: str = "") -> Clip:
        """Return the same of a motion that was made of it."""
        return self.clip(
            made.index,
            made.segment,
            suffix,
            file,
            fps=made.motion.fps,
            n_frames=made.motion.n_frames,
            carry=made.carry,
            quality=made.quality,
            rank=made.rank,
            root=made.root,
            planted=made.planted,
            poses=made.poses,
            changes=self.chosen.shape.changes,
            tags=made.tags,
        )

    @property
    def source(self) -> str:
        return str(self.recording.provenance.path or "")


def _write_rows(run: _Run, signals: Signals, rows: Sequence[Segment]) -> Iterator[Clip]:
    """Leave each clip in a file of its own: rows of the recording's."""
    shortest = min((row.stop_frame - row.start_frame for row in rows), default=None)
    file_rows = make_rows(signals, shortest=shortest)
    for index, row in enumerate(rows):
        n_frames = row.stop_frame - row.start_frame
        clip = run.clip(index, row, file_rows.suffix, n_frames=n_frames, fps=signals.fps)
        file_rows.write(run.folder / clip.file, row.start_frame, row.stop_frame)
        yield clip


def _write_files(run: _Run, made: Iterable[ShapedClip], suffix: str) -> Iterator[Clip]:
    """Leave each clip in a file of its own."""
    for each in made:
        clip = run.shaped_clip(each, suffix=f".{suffix}")
        write(each.motion, run.folder / clip.file)
        yield clip


def _write_animations(
    run: _Run,
    made: Iterable[ShapedClip],
    path: Path,
    write_all: Callable[[Mapping[str, Motion], Path], object],
) -> list[Clip]:
    """Leave all clips in one file."""
    animations: dict[str, Motion] = {}
    clips = _add_animations(run, made, path.name, animations)
    if animations:
        write_all(animations, path)
    return clips


def _add_animations(
    run: _Run, made: Iterable[ShapedClip], file: str, animations: dict[str, Motion]
) -> list[Clip]:
    """Add clips to the animations of a file; return what the lists say of them."""
    clips = []
    for each in made:
        clip = run.shaped_clip(each, file)
        clips.append(replace(clip, animation=clip.name))
        animations[clip.name] = each.motion
    return clips
