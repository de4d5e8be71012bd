"""Write segments as clips: a folder with one file each, and manifests.

Clips of a motion are BVH files by default, or CSV files of joint positions without rotations (see
`kineme.formats.tables`). For formats that hold several motions, such as GLB, there is one file per
recording with its clips as animations. If the path of such a file is given instead of a folder, all
clips go into it, or into a copy of the source file if that has the same format. The manifests are
then beside it, such as ``clips.manifest.csv`` for ``clips.glb``. Clips of signals are rows of their
source file (see `kineme.formats.channels.writing`). Files are named ``RECORDING_NUMBER_TEXT`` (see
`kineme.clips.options`), with the text of `kineme.labels.spans`.

``manifest.csv`` has one row per clip, in the order of the segments; ``manifest.json`` has more
details (see `kineme.clips.manifest`):

============================ =====================================================
``file``, ``source``         the clip, the recording it was cut from
``start_frame``, ...         ``stop_frame``, ``start_s``, ``stop_s``: where in it
``level``, ``kind``          as in the segment table
``cluster``, ``label``       as in the segment table
``tags``                     direction, turn, start and stop (see `kineme.clips.root_motion`)
``rank``, ``cost``           for loops: rank in the cluster, 1 for the best, and the
                             cost it is sorted by (see `kineme.clips.loops`)
``turn_deg``, ``x_m``,       for loops: motion from one round to the next, a turn
``z_m``                      about the vertical axis, then a shift
``animation``                for files with several clips: the name of the clip
``source_take``              for recordings with takes: the take it was cut from
============================ =====================================================

The folder is written atomically, and existing files are never changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Unpack, get_args

from kineme._util.checks import is_number, is_one_of, join_names
from kineme._util.files import atomic_folder, atomic_write
from kineme.clips.manifest import (
    MANIFEST,
    MANIFEST_JSON,
    Clip,
    Companions,
    name_manifests,
    write_manifests,
)
from kineme.clips.options import (
    Chosen,
    ClipOptions,
    fill_template,
    make_clip_name,
    make_file_name,
    make_unique_name,
    resolve_options,
)
from kineme.clips.shaping import ClipDetails, RankedLoop, shape_clips
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
"""A recording, its segments, and optionally those that become loops, already ranked."""


def split(
    recording: Motion | Signals,
    segmentation: Segmentation,
    folder: str | PathLike[str],
    *,
    level: Level = "activity",
    cluster: int | None = None,
    **options: Unpack[ClipOptions],
) -> list[Path]:
    """Write each segment as a clip and return the path of each clip's file.

    Parameters
    ----------
    recording : Motion or Signals
        The segmented recording.
    segmentation : Segmentation
        Its segments.
    folder : str or PathLike
        New or empty folder. A path with the suffix of a format that holds several motions, such as
        ``clips.glb``, becomes one file with all clips as animations.
    level : {"activity", "primitive"}, optional
        Level of the segments to write.
    cluster : int, optional
        Only segments of this cluster; by default all, including transitions.

    Other Parameters
    ----------------
    loops : bool, optional
        Turn clips other than transitions into loops (see `kineme.clips.loops`); motions only.
    format : str, optional
        Suffix of a format that writes motions, such as "bvh", "amc" or "glb".
    best : int, optional
        Write only so many loops of each cluster, the best ones (see `kineme.clips.loops`), and
        no transitions.
    root_motion : {"keep", "extract", "in-place"}, optional
        Keep root motion; move it to a root bone, which is added if missing; or remove it, with
        each clip at the origin facing +z (see `kineme.clips.root_motion`). It is in the manifest.
    straight : bool, optional
        Remove turning, so that the body moves straight ahead.
    mirror : bool, optional
        Exchange left and right.
    close : bool, optional
        Repeat the first frame of each loop at its end, as game engines expect.
    fps : float, optional
        Frames per second of the clips; borders are rounded to whole frames. Motions only.
    name : str, optional
        Template of names, such as ``{take}_{label}_{n:02}`` (see `kineme.clips.options.FIELDS`).
    target : {"unreal", "unity", "blender", "godot"}, optional
        Program that sets defaults for format, root motion, closing and names.
    sheet : str or PathLike, optional
        Picture to write, with a strip of small figures for each clip.
    motion_matching : str or PathLike, optional
        Database to write, ``.npz`` or ``.bin`` (see `kineme.clips.motion_matching`).

    Raises
    ------
    MotionError
        The segments belong to another recording.
    ParameterError
        No segment with this level and cluster, loops or a format for signals, unknown format,
        ``best`` without loops, or duplicate names.
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
    inputs: Sequence[tuple[Motion | Signals, Segmentation]],
    folder: str | PathLike[str],
    *,
    level: Level = "activity",
    cluster: int | None = None,
    **options: Unpack[ClipOptions],
) -> list[Path]:
    """Write the segments of several recordings like `split`, for example all takes of a file."""
    if not is_one_of(level, get_args(Level)):
        raise ParameterError(f"level must be {' or '.join(get_args(Level))}, not {level!r:.60}")
    if cluster is not None and not is_number(cluster):
        raise ParameterError(f"a cluster is a number, not {cluster!r:.60}")
    clips: list[Source] = []
    for recording, segmentation in inputs:
        if segmentation.n_frames != recording.n_frames:
            raise MotionError(
                f"the segments have {segmentation.n_frames} frames, but the recording has "
                f"{recording.n_frames}"
            )
        rows = [row for row in segmentation.level(level) if cluster in (None, row.cluster)]
        clips.append((recording, rows))
    if not any(rows for _, rows, *_ in clips):
        clusters = {row.cluster for _, segmentation in inputs for row in segmentation.level(level)}
        raise ParameterError(
            f"no {level} is in cluster {cluster}; there are "
            f"{join_names([*map(str, sorted(clusters - {-1}))]) or 'none'}"
        )
    return write_clips(clips, folder, **options)


def write_clips(
    clips: Iterable[Source],
    folder: str | PathLike[str],
    *,
    together: bool = False,
    **options: Unpack[ClipOptions],
) -> list[Path]:
    """Write segments of several recordings as clips to one folder; return the file of each clip.

    ``clips`` is iterated once, so that only one recording is in memory. Other arguments are those
    of `split`. Loops are ranked within their recording, or ``together``.
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
        # Numbers continue over recordings, so that names are unique in the folder.
        for recording, rows, *ranked in clips:
            namer = _ClipNamer(recording, first, draft, chosen, names)
            first += len(rows)
            if isinstance(recording, Signals):
                _refuse_poses(chosen)
                entries += _write_rows(namer, recording, rows)
                continue
            shaped = _make_clips(namer, recording, rows, companions, *ranked)
            if write_all is not None:
                file = make_unique_name(namer.stem, namer.first, files)
                files.add(file.casefold())
                path, animations = draft / f"{file}.{chosen.suffix}", dict[str, Motion]()
                entries += _add_animations(namer, shaped, path.name, animations)
                if animations:
                    write_all(animations, path)
            else:
                suffix = chosen.suffix or ("csv" if recording.rotations is None else "bvh")
                entries += _write_files(namer, shaped, suffix)
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
    clips: Iterable[Source], target: Path, target_format: Format, chosen: Chosen
) -> list[Path]:
    """Write all clips to one file, or to a copy of their source file if it has this format.

    They must come from one recording, or from takes in one file.
    """
    suffix = chosen.given.get("format")
    if suffix is not None and f".{suffix}" != target.suffix.lower():
        raise ParameterError(f"format is {suffix!r:.60}, but the file is {target.name!r:.60}")
    sources = list(clips)
    first = sources[0][0]
    if len({recording.provenance.path for recording, *_ in sources}) > 1:
        raise ParameterError(f"{target.name} holds clips of one recording: give a folder")
    source, lists = Path(first.provenance.path or ""), name_manifests(target)
    if source.name and source.exists() and target.exists() and source.samefile(target):
        raise ParameterError(f"{target} would overwrite its recording: give another name")
    if target.exists() and not lists[1].exists():
        raise WriteError(target, "exists already without a manifest: give another name")
    number, names = 0, set[str]()
    entries, animations = list[Clip](), dict[str, Motion]()
    companions = Companions(chosen.given)
    for recording, rows, *ranked in sources:
        if isinstance(recording, Signals):
            raise ParameterError(
                f"signals cannot be written as animations to {target.name}: give a folder"
            )
        namer = _ClipNamer(
            recording, number, target.parent, chosen, names, of_takes=len(sources) > 1
        )
        number += len(rows)
        shaped = _make_clips(namer, recording, rows, companions, *ranked)
        entries += _add_animations(namer, shaped, target.name, animations)
    if not animations:
        raise ParameterError(f"there is no clip to write to {target.name}")
    with atomic_write(lists[0]) as table, atomic_write(lists[1]) as list_of_all:
        loops = chosen.shape.loops
        write_manifests(entries, table, list_of_all, loops=loops, animations=True)
        if (
            target_format.copy_animations is not None
            and target_format.name == first.provenance.format
        ):
            target_format.copy_animations(animations, source, target)
        elif target_format.write_animations is not None:
            target_format.write_animations(animations, target)
    companions.write()
    return [target] * len(entries)


def _make_clips(
    namer: _ClipNamer,
    recording: Motion,
    rows: Sequence[Segment],
    companions: Companions,
    ranked: Sequence[RankedLoop] | None = None,
) -> Iterator[tuple[ClipDetails, Motion]]:
    """Yield the clips of a recording, passing them through the companions."""
    shape = namer.chosen.shape
    motion = mirrored(recording) if shape.mirror else recording
    shaped = shape_clips(motion, rows, shape, ranked)
    return companions.collect(motion, rows, shaped, lambda clip: namer.choose_names(clip)[0])


def _refuse_poses(chosen: Chosen) -> None:
    """Raise ParameterError if options for bodies are given for signals."""
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
class _ClipNamer:
    """Names the clips of one recording, numbered from ``first`` on.

    ``names`` holds the used names in lower case. With ``of_takes``, names start with the take.
    """

    recording: Motion | Signals
    first: int
    folder: Path
    chosen: Chosen
    names: set[str]
    of_takes: bool = False

    @property
    def stem(self) -> str:
        return self.take if self.of_takes else self.name

    @property
    def name(self) -> str:
        return Path(self.source or "recording").stem

    @property
    def take(self) -> str:
        return self.recording.provenance.take or self.name

    def choose_names(self, clip: ClipDetails) -> tuple[str, str]:
        """Return the names of a clip and of its file."""
        segment, number, text = clip.segment, self.first + clip.index, format_text(clip.segment)
        template = self.chosen.name
        if template is None:
            return make_clip_name(self.stem, number, text), make_file_name(self.stem, number, text)
        fields = {
            "name": self.name,
            "take": self.take,
            "label": text,
            "n": number,
            "cluster": segment.cluster,
            "level": segment.level,
            "direction": clip.tags[0] if clip.tags else "",
            "loop": "loop" if clip.carry is not None else "",
        }
        return fill_template(template, fields)

    def make_entry(self, clip: ClipDetails, suffix: str, file: str | None = None) -> Clip:
        """Return the manifest entry of a clip in a file of its own, or an animation of ``file``.

        Raise ParameterError for a duplicate name.
        """
        name, own = self.choose_names(clip)
        for key in {name.casefold(), f"{own.casefold()}{suffix}"} if self.chosen.name else ():
            if key in self.names:
                raise ParameterError(
                    f"two clips would have the name {name}: put {{n}} in their name"
                )
            self.names.add(key)
        return Clip(
            name,
            file or f"{own}{suffix}",
            source=self.source.encode(errors="backslashreplace").decode(),
            source_take=self.recording.provenance.take,
            details=clip,
            changes=self.chosen.shape.changes,
            animation=None if file is None else name,
        )

    @property
    def source(self) -> str:
        return str(self.recording.provenance.path or "")


def _write_rows(namer: _ClipNamer, signals: Signals, rows: Sequence[Segment]) -> Iterator[Clip]:
    """Write each clip as rows of the recording's file to its own file."""
    shortest = min((row.stop_frame - row.start_frame for row in rows), default=None)
    file_rows = make_rows(signals, shortest=shortest)
    for index, row in enumerate(rows):
        clip = ClipDetails(index, row, row.stop_frame - row.start_frame, signals.fps)
        entry = namer.make_entry(clip, file_rows.suffix)
        file_rows.write(namer.folder / entry.file, row.start_frame, row.stop_frame)
        yield entry


def _write_files(
    namer: _ClipNamer, clips: Iterable[tuple[ClipDetails, Motion]], suffix: str
) -> Iterator[Clip]:
    """Write each clip to its own file."""
    for details, clip in clips:
        entry = namer.make_entry(details, f".{suffix}")
        write(clip, namer.folder / entry.file)
        yield entry


def _add_animations(
    namer: _ClipNamer,
    clips: Iterable[tuple[ClipDetails, Motion]],
    file: str,
    animations: dict[str, Motion],
) -> list[Clip]:
    """Add clips to the animations of a file; return their manifest entries."""
    entries = []
    for details, clip in clips:
        entries.append(namer.make_entry(details, "", file))
        animations[entries[-1].name] = clip
    return entries
