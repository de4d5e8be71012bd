"""``kineme evaluate``: score methods on the benchmark or a folder, or a single result.

With one ``--labels``, a folder compares methods on recordings that people labelled; with several,
it measures the agreement of people. A result is compared with the truth, both from files.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from kineme.cli.files import check_suffix
from kineme.cli.help import METHOD, OUTPUT, option, output_option
from kineme.cli.options import SET, Constants, Quiet, parse_constants, split_names
from kineme.cli.terminal import exit_on_error
from kineme.errors import KinemeError, ReadError, WriteError
from kineme.formats.options import ReadOptions
from kineme.methods.presets import DEFAULT

BENCHMARK = "cmu86"
BENCH = "Benchmark"
FOLDER = "A folder of recordings"
RESULT = "One result"


def evaluate(
    what: Annotated[
        str,
        typer.Argument(
            metavar="cmu86|FOLDER|SEGMENTS",
            help="The published benchmark (needs the package kineme-reproduction), a folder of "
            "recordings, or one result: a segment table, a table of intervals, or a .txt "
            "with one label per frame.",
        ),
    ],
    against: Annotated[
        Path | None,
        option(
            RESULT,
            "The truth: a table with start_s, stop_s, label; a .txt with one label per "
            "frame; or a segment table.",
            metavar="LABELS",
        ),
    ] = None,
    labels: Annotated[
        list[Path] | None,
        option(
            FOLDER,
            "Labels of the recordings: a table with recording, start_s, stop_s, "
            "label; or a folder of label files. Repeat to measure agreement.",
            metavar="FILE|FOLDER",
        ),
    ] = None,
    mapping: Annotated[
        Literal["recording", "folder"],
        option(
            FOLDER,
            "Match clusters with labels separately in each recording, or once for the "
            "whole folder after joining its clusters.",
        ),
    ] = "recording",
    clusters: Annotated[
        int | None,
        option(
            FOLDER,
            "With --mapping folder: number of clusters of signals; inferred by default.",
            metavar="N",
            min=1,
        ),
    ] = None,
    columns: Annotated[
        str | None,
        option(
            FOLDER,
            "Segment these columns, instead of joints; * and ? are wildcards.",
            metavar="NAME,NAME,…",
        ),
    ] = None,
    without_columns: Annotated[
        str | None,
        option(FOLDER, "Exclude these columns of signals, such as 'emg*'.", metavar="NAME,NAME,…"),
    ] = None,
    constants: Constants = None,
    as_json: Annotated[bool, option(OUTPUT, "Print JSON instead of tables.", "--json")] = False,
    fps: Annotated[float | None, option(RESULT, "Frames per second of .txt files.")] = None,
    method: Annotated[
        list[str] | None,
        option(
            METHOD,
            "Presets to run, such as kineme,haca,uniform: by default kineme on a folder, all "
            "on the benchmark. `kineme presets` lists them.",
            "--method",
            "--methods",
            "--preset",
            metavar="NAME,…",
        ),
    ] = None,
    trial: Annotated[
        list[str] | None,
        option(
            BENCH,
            "Recording of the benchmark, such as 86_01; by default all available.",
            metavar="NAME",
        ),
    ] = None,
    data: Annotated[
        Path | None,
        option(
            BENCH,
            "Folder of its recordings and annotations; by default KINEME_DATA, then the "
            "files that `kineme-cmu 86` downloaded.",
            metavar="FOLDER",
        ),
    ] = None,
    plot: Annotated[
        Path | None, option(BENCH, "Draw each recording into this folder.", metavar="FOLDER")
    ] = None,
    figures: Annotated[
        Path | None, option(BENCH, "Make the figures and tables of the paper.", metavar="FOLDER")
    ] = None,
    output: Annotated[Path | None, output_option("Write all scores: .json or .csv.")] = None,
    quiet: Quiet = False,
) -> None:
    """Score segments of a file, folder or benchmark against labels."""
    with exit_on_error(what):
        _check_output(output)
        names = [*split_names(*(method or ()))]
        if what != BENCHMARK and Path(what).is_dir():
            if not labels:
                raise typer.BadParameter("--labels FILE or FOLDER is needed for a folder")
            if len(labels) > 1:
                if names or constants or clusters is not None or mapping != "recording":
                    raise typer.BadParameter(
                        "several --labels compare annotators and run no method: leave out "
                        "the options of methods"
                    )
                from kineme.cli.scoring import run_people

                run_people(Path(what), labels, output=output, as_json=as_json, quiet=quiet)
                raise typer.Exit
            if clusters is not None and mapping != "folder":
                raise typer.BadParameter("--clusters N needs --mapping folder")
            from kineme.cli.scoring import run_folder

            scored = run_folder(
                Path(what),
                labels[0],
                names or [DEFAULT],
                mapping=mapping,
                n_clusters=clusters,
                read_options=ReadOptions(columns=split_names(columns) or None),
                without=split_names(without_columns),
                constants=parse_constants(names or [DEFAULT], constants) if constants else {},
                output=output,
                as_json=as_json,
                quiet=quiet,
            )
            raise typer.Exit(0 if scored else 1)
        if constants:
            raise typer.BadParameter(
                "constants can only be set for a folder of recordings", param_hint=SET
            )
        if what != BENCHMARK:
            if labels and not Path(what).exists():
                raise ReadError(what, "there is no such folder")
            if against is None:
                raise typer.BadParameter(f"--against LABELS is needed, or {BENCHMARK} to run it")
            from kineme.cli.scoring import score_file

            silent = quiet or as_json
            records = score_file(Path(what), against, fps, quiet=silent)
        else:
            if against is not None:
                raise typer.BadParameter(
                    f"{BENCHMARK} has its own annotations: leave out --against"
                )
            records = _load_benchmark()(names, trial, data, plot, figures, quiet=quiet or as_json)
        _output_records(records, output, as_json=as_json)


def _check_output(output: Path | None) -> None:
    """Raise an error for an output that cannot be written, before any work is done."""
    if output is None:
        return
    from kineme.evaluation.score import OUTPUTS

    check_suffix("--output", output, OUTPUTS)
    if not output.parent.is_dir():
        raise WriteError(output, f"the folder {output.parent} does not exist")


def _output_records(
    records: Sequence[Mapping[str, Any]], output: Path | None, *, as_json: bool
) -> None:
    from kineme.evaluation.score import format_json, write_records

    if as_json:
        typer.echo(format_json(records))
    if output is not None:
        write_records(records, output)


def _load_benchmark() -> Callable[..., list[dict[str, Any]]]:
    """Return the function that runs the benchmark, from the package that registers it."""
    from importlib.metadata import entry_points

    for point in entry_points(group="kineme.benchmarks", name=BENCHMARK):
        return point.load()  # type: ignore[no-any-return]
    raise KinemeError(
        f"{BENCHMARK} needs the package kineme-reproduction: in the folder of kineme's sources, "
        "pip install ./reproduction"
    )
