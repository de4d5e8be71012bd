"""``kineme evaluate``: methods on the benchmark, or any result against any annotation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme._files import atomic_write
from kineme.cli.messages import Failures, progress
from kineme.cli.reading import Quiet
from kineme.errors import ParameterError, WriteError

if TYPE_CHECKING:
    from kineme.evaluation.benchmark import Result
    from kineme.evaluation.methods import Method

BENCHMARK = "cmu86"
BENCH = "Benchmark"
OWN = "Own files"


def evaluate(
    what: Annotated[
        str,
        typer.Argument(
            metavar="cmu86|SEGMENTS",
            help="The benchmark, or a result: a segment table, a table of intervals, or a .txt "
            "with one label per frame.",
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
            help="A method to run: a preset, aca, haca, pca, ppca, gmm or uniform. May be given "
            "several times; all by default.",
            rich_help_panel=BENCH,
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
        if what != BENCHMARK:
            if against is None:
                raise typer.BadParameter(f"--against LABELS is needed, or {BENCHMARK} to run it")
            records = _score_file(Path(what), against, fps, recording, trial, quiet=quiet)
        else:
            if against is not None:
                raise typer.BadParameter(f"{BENCHMARK} brings its own truth: leave out --against")
            names = [*(preset or ()), *(method or ())]
            records = _run_benchmark(names, trial, data, plot, figures, quiet=quiet)
        if output is not None:
            from kineme.evaluation.tables import write_records

            write_records(records, output)
    failures.exit()


def _score_file(
    path: Path,
    labels: Path,
    fps: float | None,
    recording: Path | None,
    trials: list[str] | None,
    *,
    quiet: bool,
) -> list[dict[str, Any]]:
    from kineme.cli.scores import show_one
    from kineme.evaluation.inputs import read_result, read_truth, recording_of, score
    from kineme.formats import read_motion

    found = read_result(path, fps=fps)
    truth = read_truth(labels, found, fps=fps, trial=trials[0] if trials else None)
    source = recording or recording_of(found)
    scores = score(truth, found, read_motion(source) if source else None)
    if not quiet:
        show_one(path.name, scores)
        if source is None:
            typer.echo("The recording is not at hand, so there are no distances: --recording FILE")
    return [{"result": path.name, "truth": labels.name, **scores}]


def _run_benchmark(
    names: list[str],
    trials: list[str] | None,
    data: Path | None,
    plot: Path | None,
    figures: Path | None,
    *,
    quiet: bool,
) -> list[dict[str, Any]]:
    from kineme.cli.scores import show_results
    from kineme.evaluation.benchmark import run
    from kineme.evaluation.tables import as_records
    from kineme.evaluation.trials import find_folder, load_trials

    methods = _methods(names)
    for folder in (plot, figures):
        _make_folder(folder)
    with progress(BENCHMARK, quiet=quiet) as stage:
        folder = find_folder(data)
        loaded = load_trials(folder, trials, progress=stage)
        results = run(loaded, methods, progress=stage)
    if not quiet:
        show_results(results)
    with progress("figures", quiet=quiet) as stage:
        _draw(results, folder, plot, figures, stage)
    return as_records(results)


def _methods(names: list[str]) -> Mapping[str, Method]:
    from kineme.evaluation.methods import METHODS, method

    try:
        return {name: method(name) for name in names} or METHODS
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error


def _draw(
    results: list[Result], data: Path, plot: Path | None, figures: Path | None, stage: Any
) -> None:
    if plot is not None:
        from kineme.evaluation.figures.bars import plot_trials

        plot_trials(results, plot)
    if figures is not None:
        from kineme.evaluation.figures import make_figures

        tables = make_figures(results, data, figures, progress=stage)
        text = "\n".join(f"## {title}\n\n{table}" for title, table in tables.items())
        with atomic_write(figures / "tables.md") as draft:
            draft.write_text(text, encoding="utf-8")


def _check_output(output: Path | None) -> None:
    """WriteError before the work for what could not be written after it."""
    if output is None:
        return
    from kineme.evaluation.tables import OUTPUTS

    if output.suffix.lower() not in OUTPUTS:
        raise WriteError(output, f"scores are written as {' or '.join(OUTPUTS)}")
    if not output.parent.is_dir():
        raise WriteError(output, f"the folder {output.parent} does not exist")


def _make_folder(folder: Path | None) -> None:
    try:
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WriteError(folder or "", f"cannot be made: {error.strerror}") from error
