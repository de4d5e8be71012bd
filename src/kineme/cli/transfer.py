"""``kineme transfer``: label the primitives of recordings from a knowledge base."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme.cli.files import Batch, Files, Recursive, check_writable
from kineme.cli.help import INPUT, METHOD, OUTPUT, TABLES, option
from kineme.cli.options import BODY, SEGMENTING, Json, Quiet, add_options
from kineme.cli.segment import PrintedLevel, load_or_find_segments, print_segments
from kineme.cli.terminal import Failures
from kineme.formats import read_motion
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions

if TYPE_CHECKING:
    from kineme.methods import Progress
    from kineme.recordings import Motion
    from kineme.segments.segmentation import Segmentation
    from kineme.transfer import KnowledgeBase


@add_options(BODY | SEGMENTING)
def transfer(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    knowledge: Annotated[
        list[Path],
        option(
            INPUT,
            "Knowledge base that `kineme label` made, .npz; may be repeated.",
            metavar="FILE",
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
        option(
            OUTPUT,
            f"Segment table or labels: {TABLES}. For several recordings, a folder, or a "
            "path with {name} in it.",
            "--output",
            "-o",
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
    failures = Failures()
    from kineme.transfer import KnowledgeBase

    bases = []
    for path in knowledge:
        with failures.catch_errors(path):
            bases.append(KnowledgeBase.load(path))
    failures.exit()
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
                result = _label_segments(motion, segment_options, base, options, stage)
            if table is not None:
                from kineme.labels import write_segments

                write_segments(result, table)
            print_segments(result, motion, level, [table], json=json, quiet=quiet)
    batch.exit()


def _label_segments(
    motion: Motion,
    segment_options: SegmentOptions,
    base: KnowledgeBase,
    options: dict[str, Any],
    stage: Progress,
) -> Segmentation:
    """Segment a recording and return its segments with labels."""
    from kineme.transfer import transfer_features, transfer_labels

    segments = load_or_find_segments(motion, None, segment_options, stage)
    stage("labels")
    features = transfer_features(motion, effectors=segment_options.effectors)
    return transfer_labels(segments, features, base, **options)
