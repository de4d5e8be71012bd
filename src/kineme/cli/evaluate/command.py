"""The options of ``kineme evaluate``, and which of its three kinds of run they ask for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from kineme.cli.messages import Failures
from kineme.cli.options.reading import Quiet
from kineme.errors import WriteError
from kineme.methods.presets import DEFAULT

BENCHMARK = "cmu86"
BENCH = "Benchmark"
FOLDER = "A folder of recordings"
OWN = "One result"
Mapped = Literal["recording", "folder"]


def evaluate(
    what: Annotated[
        str,
        typer.Argument(
            metavar="cmu86|FOLDER|SEGMENTS",
            help="The benchmark; a folder of recordings; or a result: a segment table, a table of "
            "intervals, or a .txt with one label per frame.",
        ),
    ],
    against: Annotated[
        Path | None,
        typer.Option(
            metavar="LABELS",
            help="The truth: a table with start_s, stop_s, label; a .txt with one label per "
            "frame; a segment table; annotations.json or mocap.txt.",
            rich_help_panel=OWN,
        ),
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE|FOLDER",
            help="What people say of the recordings: a table with recording, start_s, stop_s, "
            "label; or a folder with a label file for each.",
            rich_help_panel=FOLDER,
        ),
    ] = None,
    mapping: Annotated[
        Mapped,
        typer.Option(
            help="Whether clusters stand for classes of one recording, or for the same in all, "
            "over which they are joined before.",
            rich_help_panel=FOLDER,
        ),
    ] = "recording",
    clusters: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            help="With --mapping folder: join the clusters of signals into so many; found out by "
            "default.",
            rich_help_panel=FOLDER,
        ),
    ] = None,
    columns: Annotated[
        str | None,
        typer.Option(
            metavar="NAME,NAME,…",
            help="Take these columns as signals, in place of joints; * and ? are wildcards.",
            rich_help_panel=FOLDER,
        ),
    ] = None,
    without_columns: Annotated[
        str | None,
        typer.Option(
            metavar="NAME,NAME,…",
            help="Leave these columns of signals out, such as 'emg*'.",
            rich_help_panel=FOLDER,
        ),
    ] = None,
    constants: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="A constant of the methods that is to be another, such as min_action=2; several "
            "numbers with commas between them.",
            rich_help_panel=FOLDER,
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON.", rich_help_panel=FOLDER)
    ] = False,
    fps: Annotated[
        float | None,
        typer.Option(help="Frames per second of .txt files.", rich_help_panel=OWN),
    ] = None,
    recording: Annotated[
        Path | None,
        typer.Option(
            help="The recording, for the variances within clusters; by default the one the "
            "segment table names.",
            rich_help_panel=OWN,
        ),
    ] = None,
    preset: Annotated[
        list[str] | None, typer.Option(help="A preset to run.", rich_help_panel=BENCH)
    ] = None,
    method: Annotated[
        list[str] | None,
        typer.Option(
            "--method",
            "--methods",
            metavar="NAME,NAME,…",
            help="Presets to run, such as kineme,haca,uniform. All by default; of a folder, the "
            "default preset.",
        ),
    ] = None,
    trial: Annotated[
        list[str] | None,
        typer.Option(
            help="A trial, such as 86_01; by default all at hand. With own files the trial to "
            "take from the benchmark's annotations.",
        ),
    ] = None,
    data: Annotated[
        Path | None,
        typer.Option(
            help="Folder of the recordings and annotations; by default KINEME_DATA, else what "
            "`kineme data cmu 86` fetched.",
            rich_help_panel=BENCH,
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Folder for a picture per trial.", rich_help_panel=BENCH),
    ] = None,
    figures: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Folder for the figures and tables of the paper, made anew.",
            rich_help_panel=BENCH,
        ),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="All scores: .json or .csv.")
    ] = None,
    quiet: Quiet = False,
) -> None:
    """Measure segmentations: by the published protocols, and by fair ones."""
    failures = Failures()
    with failures.caught(what):
        _check_output(output)
        names = [*(preset or ()), *_listed(*(method or ()))]
        if what != BENCHMARK and Path(what).is_dir():
            if labels is None:
                raise typer.BadParameter("--labels FILE or FOLDER is needed for a folder")
            if clusters is not None and mapping != "folder":
                raise typer.BadParameter("--clusters N is of --mapping folder")
            from kineme.cli.evaluate.folder import run_folder
            from kineme.evaluation.recordings import Reading

            scored = run_folder(
                Path(what),
                labels,
                names or [DEFAULT],
                mapping=mapping,
                n_clusters=clusters,
                reading=Reading(_listed(columns), _listed(without_columns)),
                constants=dict(map(_constant, constants or ())),
                output=output,
                as_json=as_json,
                quiet=quiet,
            )
            raise typer.Exit(0 if scored else 1)
        if what != BENCHMARK:
            if against is None:
                raise typer.BadParameter(f"--against LABELS is needed, or {BENCHMARK} to run it")
            from kineme.cli.evaluate.result import score_file

            records = score_file(Path(what), against, fps, recording, trial, quiet=quiet)
        else:
            if against is not None:
                raise typer.BadParameter(f"{BENCHMARK} brings its own truth: leave out --against")
            from kineme.cli.evaluate.benchmark import run_benchmark

            records = run_benchmark(names, trial, data, plot, figures, quiet=quiet)
        if output is not None:
            from kineme.evaluation.tables import write_records

            write_records(records, output)
    failures.exit()


def _constant(text: str) -> tuple[str, Any]:
    """A constant's name and value: a number, several, a word, or none."""
    name, equals, value = text.partition("=")
    if not equals:
        raise typer.BadParameter(f"--set takes NAME=VALUE, not {text!r:.60}")
    values = [_value(each.strip()) for each in value.split(",")]
    return name.strip().replace("-", "_"), values[0] if len(values) == 1 else tuple(values)


def _value(text: str) -> float | bool | str | None:
    words = {"none": None, "true": True, "false": False}
    if text.lower() in words:
        return words[text.lower()]
    try:
        return float(text)
    except ValueError:
        return text


def _listed(*texts: str | None) -> tuple[str, ...]:
    """The names in texts with commas between them."""
    names = (name.strip() for text in texts if text for name in text.split(","))
    return tuple(name for name in names if name)


def _check_output(output: Path | None) -> None:
    """WriteError before the work for what could not be written after it."""
    if output is None:
        return
    from kineme.evaluation.tables import OUTPUTS

    if output.suffix.lower() not in OUTPUTS:
        raise WriteError(output, f"scores are written as {' or '.join(OUTPUTS)}")
    if not output.parent.is_dir():
        raise WriteError(output, f"the folder {output.parent} does not exist")
