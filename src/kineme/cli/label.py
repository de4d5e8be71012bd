"""``kineme label``: the labelled primitives of recordings into a knowledge base."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme._util.checks import format_count
from kineme.cli.help import INPUT, OUTPUT, option
from kineme.cli.messages import Failures
from kineme.cli.options.inputs import Batch, Files, Recursive
from kineme.cli.options.reading import BODY, Quiet
from kineme.cli.options.request import SEGMENTING, Request, Stage, asks

if TYPE_CHECKING:
    from kineme.transfer import KnowledgeBase


@asks(BODY | SEGMENTING)
def label(
    files: Files,
    request: Request,
    labels: Annotated[
        Path,
        option(
            INPUT,
            "Their labels: a segment table, or a label file of another program; of several "
            "recordings a folder, or a path with {name} in it.",
            metavar="TABLE",
        ),
    ],
    knowledge: Annotated[
        Path,
        option(OUTPUT, "Knowledge base to add to, .npz; made if it is not there.", metavar="FILE"),
    ],
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Add labelled primitives to a knowledge base.

    Primitives are single movements, such as a step or a jump. A knowledge base is a file of them
    with their names, by which `kineme transfer` labels other recordings. Where the labels name
    whole activities only, the recording is cut into primitives first. What the knowledge base
    held of a recording is replaced.
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    tables = batch.tables("--labels", labels, request.person)
    failures = Failures()
    from kineme.transfer import KnowledgeBase

    bases = []
    with failures.caught(knowledge):
        bases += [KnowledgeBase.load(knowledge)] if knowledge.exists() else []
    failures.exit()
    added: dict[Path, KnowledgeBase] = {}
    for path, table in zip(batch.paths, tables, strict=True):
        with batch.caught(path), batch.progress(path) as stage:
            added[path] = _label_primitives(request, path, table, stage)
    with failures.caught(knowledge):
        if added:
            merged = KnowledgeBase.merged(*bases, *added.values())
            merged.save(knowledge)
            if not quiet:
                _show(knowledge, added, len(merged))
    batch.exit()
    failures.exit()


def _label_primitives(
    request: Request, path: Path, labels: Path | None, stage: Stage
) -> KnowledgeBase:
    """Return the primitives of a recording, called as its labels say."""
    from kineme.transfer import KnowledgeBase, name_primitives

    stage("reading")
    motion = request.read_motion(path)
    table = request.segments(motion, labels, stage)
    if not len(table.primitives):
        table = name_primitives(request.segment(motion, stage), table)
    return KnowledgeBase.from_recording(motion, table, effectors=request.effectors)


def _show(knowledge: Path, added: dict[Path, KnowledgeBase], total: int) -> None:
    """One line per recording: what it added."""
    for path, base in added.items():
        what = ", ".join(f"{name} {count}" for name, count in base.counts().items())
        typer.echo(
            f"{knowledge}: {what} from {path.name}; {format_count(total, 'primitive')} in all"
        )
