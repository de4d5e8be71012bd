"""``kineme label``: the labelled primitives of a recording into a knowledge base."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from kineme.cli.messages import Failures, progress
from kineme.cli.reading import Effectors, Quiet, effector_names


def label(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The recording.")],
    labels: Annotated[
        Path,
        typer.Option(
            metavar="TABLE",
            help="Its labels: a segment table, or a label file of another program.",
        ),
    ],
    knowledge: Annotated[
        Path, typer.Option(help="Knowledge base to add to, .npz; made if it is not there.")
    ],
    quiet: Quiet = False,
    effectors: Effectors = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Add the labelled primitives of a recording to a knowledge base.

    Where the labels name whole activities only, the recording is cut into primitives first.
    What the knowledge base held of this recording is replaced.
    """
    reading = reading or {}
    names = effector_names(effectors)
    failures = Failures()
    with failures.caught(file), progress(file.name, quiet=quiet) as stage:
        stage("reading")
        from kineme.formats import read
        from kineme.labels import read_segments
        from kineme.segmentation.segmenter import segment
        from kineme.transfer import KnowledgeBase, name_primitives

        known = [KnowledgeBase.load(knowledge)] if knowledge.exists() else []
        motion = read(file, **reading)
        table = read_segments(labels, fps=motion.fps, n_frames=motion.n_frames)
        if not len(table.primitives):
            table = name_primitives(segment(motion, effectors=names, progress=stage), table)
        added = KnowledgeBase.from_recording(motion, table, effectors=names)
        merged = KnowledgeBase.merged(*known, added)
        merged.save(knowledge)
        if not quiet:
            what = ", ".join(f"{name} {count}" for name, count in added.counts().items())
            typer.echo(f"{knowledge}: {what} from {file.name}; {len(merged)} primitives in all")
    failures.exit()
