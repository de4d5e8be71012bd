"""``kineme split``: a recording in, a folder of clips out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme.cli.messages import Failures, progress
from kineme.cli.reading import Effectors, Quiet, effector_names
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT, PRESETS, resolve_preset
from kineme.segments.table import Level

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.methods.base import Preset
    from kineme.recordings.motion import Motion
    from kineme.segments.segmentation import Segmentation


def split(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A recording.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder to make; it must be new or empty.")
    ],
    level: Annotated[Level, typer.Option(help="Segments to take.")] = "activity",
    cluster: Annotated[
        int | None, typer.Option(help="Take those of this cluster only.", show_default=False)
    ] = None,
    loop: Annotated[
        bool, typer.Option("--loop", help="Blend the ends, so that each clip plays as a cycle.")
    ] = False,
    segments: Annotated[
        Path | None,
        typer.Option(help="Table or labels to cut by, instead of segmenting anew."),
    ] = None,
    preset: Annotated[str, typer.Option(help=f"{', '.join(PRESETS)}.")] = DEFAULT,
    quiet: Quiet = False,
    effectors: Effectors = None,
    overrides: dict[str, Any] | None = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Write each segment of a recording as a motion file, and a manifest of them.

    BVH, or CSV of joint positions where there are no rotations.
    """
    try:
        chosen = resolve_preset(preset, **(overrides or {}))
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    reading = reading or {}
    failures = Failures()
    with failures.caught(file):
        motion, cuts = _cuts(
            file, reading, chosen, effector_names(effectors), segments, quiet=quiet
        )
        from kineme.clips.split import split as write_clips

        clips = write_clips(motion, cuts, output, level=level, cluster=cluster, loops=loop)
        if not quiet:
            typer.echo(f"{len(clips)} clips in {output}")
    failures.exit()


def _cuts(
    file: Path,
    reading: dict[str, Any],
    preset: Preset,
    names: Names | None,
    table: Path | None,
    *,
    quiet: bool,
) -> tuple[Motion, Segmentation]:
    """The recording and its segments, from the table if there is one."""
    with progress(file.name, quiet=quiet) as stage:
        stage("reading")
        from kineme.formats import read

        motion = read(file, **reading)
        if table is not None:
            from kineme.labels import read_segments

            return motion, read_segments(table, fps=motion.fps, n_frames=motion.n_frames)
        from kineme.segmentation.segmenter import segment_and_found

        return motion, segment_and_found(motion, preset, effectors=names, progress=stage)[0]
