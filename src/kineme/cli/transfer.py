"""Knowledge bases of named primitives: ``kineme label`` adds to one, ``transfer`` uses it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme._util.checks import format_count
from kineme.cli.files import Batch, Files, Recursive, check_writable
from kineme.cli.help import INPUT, METHOD, OUTPUT, TABLES, option, output_option
from kineme.cli.options import BODY, SEGMENTING, Json, Quiet, add_options
from kineme.cli.segment import PrintedLevel, load_or_find_segments, print_segments
from kineme.cli.terminal import exit_on_error
from kineme.formats import read_motion
from kineme.formats.options import ReadOptions
from kineme.labels import write_segments
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
        Path, option(OUTPUT, "Knowledge base to add to, .npz; created if missing.", metavar="FILE")
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
    from kineme.transfer import KnowledgeBase

    with exit_on_error(knowledge):
        bases = [KnowledgeBase.load(knowledge)] if knowledge.exists() else []
    added: dict[Path, KnowledgeBase] = {}
    for path, table in zip(batch.paths, tables, strict=True):
        with batch.catch_errors(path), batch.progress(path) as stage:
            stage("reading")
            motion = read_motion(path, **vars(read_options))
            added[path] = _build_knowledge_base(motion, table, segment_options, stage)
    with batch.catch_result_errors(knowledge):
        if added:
            merged = KnowledgeBase.merged(*bases, *added.values())
            merged.save(knowledge)
            if not quiet:
                _show(knowledge, added, len(merged))
    batch.exit()


def _build_knowledge_base(
    motion: Motion, labels: Path | None, options: SegmentOptions, stage: Progress
) -> KnowledgeBase:
    """Return a knowledge base of the labelled primitives of a recording.

    Labels of activities only are given to the primitives that segmentation finds in them.
    """
    from kineme.transfer import KnowledgeBase, name_primitives

    labelled = load_or_find_segments(motion, labels, options, stage)
    if not len(labelled.primitives):
        found = load_or_find_segments(motion, None, options, stage)
        labelled = name_primitives(found, labelled)
    return KnowledgeBase.from_recording(motion, labelled, effectors=options.effectors)


def _show(knowledge: Path, added: dict[Path, KnowledgeBase], total: int) -> None:
    """Print what each recording added."""
    for path, base in added.items():
        counts = ", ".join(f"{name} {count}" for name, count in base.counts().items())
        typer.echo(
            f"{knowledge}: {counts} from {path.name}; {format_count(total, 'primitive')} in all"
        )


@add_options(BODY | SEGMENTING)
def transfer(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    knowledge: Annotated[
        list[Path],
        option(
            INPUT, "Knowledge base that `kineme label` made, .npz; may be repeated.", metavar="FILE"
        ),
    ],
    threshold: Annotated[
        float | None,
        option(
            METHOD,
            "Largest distance to a known movement, 0 to 2; lower "
            "gives fewer but more reliable labels.",
            show_default="0.85",
        ),
    ] = None,
    spread: Annotated[
        bool,
        option(
            METHOD,
            "Give every primitive of a cluster the most frequent label of the cluster.",
            "--spread",
        ),
    ] = False,
    output: Annotated[
        Path | None,
        output_option(
            f"Segment table or labels: {TABLES}. For several recordings, a folder, or a "
            "path with {name} in it."
        ),
    ] = None,
    level: PrintedLevel = "primitive",
    recursive: Recursive = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Segment recordings and label them by a knowledge base.

    A knowledge base is a file of movements with names, which `kineme label` makes.
    """
    if threshold is not None and not 0 < threshold < float("inf"):
        raise typer.BadParameter(f"must be a number above 0, not {threshold}")
    batch = Batch(files, recursive=recursive, quiet=quiet)
    tables = batch.targets("--output", output, ".csv")
    from kineme.transfer import KnowledgeBase, transfer_features, transfer_labels

    bases = []
    for path in knowledge:
        with batch.catch_result_errors(path):
            bases.append(KnowledgeBase.load(path))
    if len(bases) < len(knowledge):
        batch.exit()
    base = KnowledgeBase.merged(*bases)
    options: dict[str, Any] = {"spread": spread}
    if threshold is not None:
        options["threshold"] = threshold
    for path, table in zip(batch.paths, tables, strict=True):
        with batch.catch_errors(path):
            check_writable(table)
            with batch.progress(path) as stage:
                stage("reading")
                motion = read_motion(path, **vars(read_options))
                segments = load_or_find_segments(motion, None, segment_options, stage)
                stage("labels")
                features = transfer_features(motion, effectors=segment_options.effectors)
                result = transfer_labels(segments, features, base, **options)
            if table is not None:
                write_segments(result, table)
            print_segments(result, motion, level, [table], json=json, quiet=quiet)
    batch.exit()
