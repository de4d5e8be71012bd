"""``kineme label``: add labelled primitives of recordings to a knowledge base."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme._util.checks import format_count
from kineme.cli.files import Batch, Files, Recursive
from kineme.cli.help import INPUT, OUTPUT, option
from kineme.cli.options import BODY, SEGMENTING, Quiet, add_options
from kineme.cli.segment import load_or_find_segments
from kineme.cli.terminal import Failures
from kineme.formats import read_motion
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions

if TYPE_CHECKING:
    from kineme.methods import Progress
    from kineme.recordings import Motion
    from kineme.transfer import KnowledgeBase


@add_options(BODY | SEGMENTING)
def label(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    labels: Annotated[
        Path,
        option(
            INPUT,
            "Labels: a segment table, or a label file of another program; for several "
            "recordings, a folder or a path with {name} in it.",
            metavar="TABLE",
        ),
    ],
    knowledge: Annotated[
        Path,
        option(OUTPUT, "Knowledge base to add to, .npz; created if missing.", metavar="FILE"),
    ],
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Add labelled primitives to a knowledge base.

    Primitives are single movements, such as a step or a jump. A knowledge base is a file of named
    primitives, from which `kineme transfer` labels other recordings. If the labels name whole
    activities only, the recording is segmented into primitives first. Earlier entries of a
    recording are replaced.
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    tables = batch.tables("--labels", labels, read_options.person or "")
    failures = Failures()
    from kineme.transfer import KnowledgeBase

    bases = []
    with failures.catch_errors(knowledge):
        bases += [KnowledgeBase.load(knowledge)] if knowledge.exists() else []
    failures.exit()
    added: dict[Path, KnowledgeBase] = {}
    for path, table in zip(batch.paths, tables, strict=True):
        with batch.catch_errors(path), batch.progress(path) as stage:
            stage("reading")
            motion = read_motion(path, **vars(read_options))
            added[path] = _label_primitives(motion, table, segment_options, stage)
    with failures.catch_errors(knowledge):
        if added:
            merged = KnowledgeBase.merged(*bases, *added.values())
            merged.save(knowledge)
            if not quiet:
                _show(knowledge, added, len(merged))
    batch.exit()
    failures.exit()


def _label_primitives(
    motion: Motion, labels: Path | None, options: SegmentOptions, stage: Progress
) -> KnowledgeBase:
    """Return a knowledge base of the labelled primitives of a recording."""
    from kineme.transfer import KnowledgeBase, name_primitives

    table = load_or_find_segments(motion, labels, options, stage)
    if not len(table.primitives):
        table = name_primitives(load_or_find_segments(motion, None, options, stage), table)
    return KnowledgeBase.from_recording(motion, table, effectors=options.effectors)


def _show(knowledge: Path, added: dict[Path, KnowledgeBase], total: int) -> None:
    """Print what each recording added."""
    for path, base in added.items():
        counts = ", ".join(f"{name} {count}" for name, count in base.counts().items())
        typer.echo(
            f"{knowledge}: {counts} from {path.name}; {format_count(total, 'primitive')} in all"
        )
