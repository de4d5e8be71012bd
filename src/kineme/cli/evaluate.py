"""``kineme evaluate``: methods on the benchmark or any folder, or one result against its truth."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from kineme._files import atomic_write
from kineme.cli.messages import Failures, progress
from kineme.cli.reading import Quiet
from kineme.errors import ParameterError, ReadError, WriteError

if TYPE_CHECKING:
    from kineme.reproduction.benchmark import Result
    from kineme.reproduction.methods import Method

BENCHMARK = "cmu86"
BENCH = "Benchmark"
FOLDER = "A folder of recordings"
OWN = "One result"
DEFAULT = "kineme"
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
            help="Whether clusters stand for classes of one recording, or for the same in all.",
            rich_help_panel=FOLDER,
        ),
    ] = "recording",
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
            help="Methods to run: presets, aca, haca, pca, ppca, gmm or uniform. All by default; "
            "of a folder, the default preset.",
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
            from kineme.cli.evaluate_folder import run_folder
            from kineme.evaluation.recordings import Reading

            scored = run_folder(
                Path(what),
                labels,
                names or [DEFAULT],
                mapping=mapping,
                reading=Reading(_listed(columns), _listed(without_columns)),
                output=output,
                as_json=as_json,
                quiet=quiet,
            )
            raise typer.Exit(0 if scored else 1)
        if what != BENCHMARK:
            if against is None:
                raise typer.BadParameter(f"--against LABELS is needed, or {BENCHMARK} to run it")
            records = _score_file(Path(what), against, fps, recording, trial, quiet=quiet)
        else:
            if against is not None:
                raise typer.BadParameter(f"{BENCHMARK} brings its own truth: leave out --against")
            records = _run_benchmark(names, trial, data, plot, figures, quiet=quiet)
        if output is not None:
            from kineme.evaluation.tables import write_records

            write_records(records, output)
    failures.exit()


def _listed(*texts: str | None) -> tuple[str, ...]:
    """The names in texts with commas between them."""
    names = (name.strip() for text in texts if text for name in text.split(","))
    return tuple(name for name in names if name)


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
    from kineme.evaluation.inputs import (
        comparison,
        read_result,
        read_truth,
        recording_of,
        score,
    )
    from kineme.formats import read_motion
    from kineme.reproduction.annotations import is_annotations, read_trial

    found = read_result(path, fps=fps)
    n_frames, rate = comparison(found)
    if is_annotations(labels):
        recorded = (found.provenance.get("input") or {}).get("path") or ""
        truth = read_trial(labels, trials[0] if trials else Path(recorded).stem, fps=rate)
        if truth.frames != n_frames:
            said, lasts = truth.frames / rate, n_frames / rate
            raise ReadError(labels, f"speaks of {said:.2f} s, the result of {lasts:.2f} s")
    else:
        truth = read_truth(labels, found, fps=fps)
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
    from kineme.reproduction.benchmark import as_records, run
    from kineme.reproduction.trials import find_folder, load_trials

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
    from kineme.reproduction.methods import METHODS, method

    try:
        return {name: method(name) for name in names} or METHODS
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error


def _draw(
    results: list[Result], data: Path, plot: Path | None, figures: Path | None, stage: Any
) -> None:
    if plot is not None:
        from kineme.reproduction.figures.bars import plot_trials

        plot_trials(results, plot)
    if figures is not None:
        from kineme.reproduction.figures import make_figures

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
