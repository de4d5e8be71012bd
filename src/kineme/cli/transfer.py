"""``kineme transfer``: labels from a knowledge base for the primitives of recordings."""

from __future__ import annotations

from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme.cli.messages import Failures, progress
from kineme.cli.reading import Effectors, Json, Quiet, effector_names
from kineme.cli.targets import check_writable, targets
from kineme.segments.table import Level

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.segments.segmentation import Segmentation
    from kineme.transfer import KnowledgeBase


def transfer(
    files: Annotated[list[Path], typer.Argument(metavar="FILES", help="The recordings.")],
    knowledge: Annotated[
        list[Path],
        typer.Option(help="Knowledge base that `kineme label` made, .npz; may be given again."),
    ],
    threshold: Annotated[
        float | None,
        typer.Option(
            help="Largest cost of a match, body sizes; lower gives fewer labels, more of them "
            "right.",
            show_default="0.12",
        ),
    ] = None,
    spread: Annotated[
        bool, typer.Option("--spread", help="A cluster takes the label most of its members got.")
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Segment table: .csv, .json or .parquet; a folder; or a name with {name} in it.",
        ),
    ] = None,
    level: Annotated[Level, typer.Option(help="Rows to print.")] = "primitive",
    json: Json = False,
    quiet: Quiet = False,
    effectors: Effectors = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Cut recordings, and label what is like the primitives of a knowledge base."""
    if threshold is not None and not 0 < threshold < float("inf"):
        raise typer.BadParameter(f"must be a number above 0, not {threshold}")
    reading = reading or {}
    names = effector_names(effectors)
    tables = targets("--output", output, files, ".csv")
    failures = Failures()
    from kineme.transfer import KnowledgeBase

    bases = []
    for path in knowledge:
        with failures.caught(path):
            bases.append(KnowledgeBase.load(path))
    failures.exit()
    base = KnowledgeBase.merged(*bases)
    options: dict[str, Any] = {"spread": spread}
    if threshold is not None:
        options["threshold"] = threshold
    for path, table in zip(files, tables, strict=True):
        with failures.caught(path):
            check_writable(table, None)
            result = run(path, reading, base, names, options, quiet=quiet)
            if table is not None:
                from kineme.labels import write_segments

                write_segments(result, table)
            if json:
                from kineme.labels.json_table import as_object

                typer.echo(dumps(as_object(result)))
            elif not quiet:
                from kineme.cli.tables import show_segments

                show_segments(result, level, written=[table])
    failures.exit()


def run(
    path: Path,
    reading: dict[str, Any],
    base: KnowledgeBase,
    effectors: Names | None,
    options: dict[str, Any],
    *,
    quiet: bool,
) -> Segmentation:
    """The segments of a file, labelled."""
    with progress(path.name, quiet=quiet) as stage:
        stage("reading")
        from kineme.formats import read
        from kineme.segmentation.segmenter import segment
        from kineme.transfer import transfer_features, transfer_labels

        motion = read(path, **reading)
        found = segment(motion, effectors=effectors, progress=stage)
        stage("labels")
        features = transfer_features(motion, effectors=effectors)
        return transfer_labels(found, features, base, **options)
