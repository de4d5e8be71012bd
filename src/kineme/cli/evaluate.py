"""``kineme evaluate``: score methods on the benchmark or a folder, or a single result.

With one ``--labels``, a folder compares methods on recordings that people labelled; with several,
it measures the agreement of people. A result is compared with the truth, both from files.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from kineme._util.checks import join_names
from kineme.cli.help import METHOD, OUTPUT, option
from kineme.cli.options import SET, Constants, Quiet, parse_constants, split_names
from kineme.cli.tables import show_scores, show_table
from kineme.cli.terminal import escape_controls, exit_on_error, show_progress
from kineme.errors import KinemeError, ParameterError, ReadError, WriteError
from kineme.evaluation.annotators import (
    AnnotatorAgreement,
    annotator_agreement,
    gather_labels,
    name_annotators,
    read_extent,
)
from kineme.evaluation.folder import (
    FolderScores,
    Mapped,
    RecordingScores,
    check_method,
    evaluate_folder,
    find_recordings,
)
from kineme.evaluation.inputs import (
    choose_comparison_rate,
    is_annotation_file,
    read_result,
    read_trial,
    read_truth,
    score,
)
from kineme.evaluation.score import (
    explain_disagreement,
    format_score,
    make_score_rows,
    scores,
    write_result,
)
from kineme.formats.options import ReadOptions
from kineme.labels.collections import Extent, find_labels, find_labels_and_unmatched
from kineme.methods.presets import DEFAULT

MAX_NAMES = 5
"""File names printed; the rest is only counted."""
MATCHED_BY = {
    "names": "by names",
    "mapping": "by the best mapping: names are missing, or differ between people",
}
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
            "frame; a segment table; annotations.json or mocap.txt.",
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
        Mapped,
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
            "Recording of the benchmark, such as 86_01, by default all available; for one "
            "result, the recording whose annotations to use.",
            metavar="NAME",
        ),
    ] = None,
    data: Annotated[
        Path | None,
        option(
            BENCH,
            "Folder of its recordings and annotations; by default KINEME_DATA, then the "
            "files that `kineme data cmu 86` fetched.",
            metavar="FOLDER",
        ),
    ] = None,
    plot: Annotated[
        Path | None, option(BENCH, "Draw each recording into this folder.", metavar="FOLDER")
    ] = None,
    figures: Annotated[
        Path | None, option(BENCH, "Make the figures and tables of the paper.", metavar="FOLDER")
    ] = None,
    output: Annotated[
        Path | None, option(OUTPUT, "Write all scores: .json or .csv.", "--output", "-o")
    ] = None,
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

                run_people(Path(what), labels, output=output, as_json=as_json, quiet=quiet)
                raise typer.Exit
            if clusters is not None and mapping != "folder":
                raise typer.BadParameter("--clusters N needs --mapping folder")

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

            silent = quiet or as_json
            records = score_file(Path(what), against, fps, trial, quiet=silent)
        else:
            if against is not None:
                raise typer.BadParameter(
                    f"{BENCHMARK} has its own annotations: leave out --against"
                )
            records = _load_benchmark()(names, trial, data, plot, figures, quiet=quiet or as_json)
        _output_records(records, output, as_json=as_json)


def _check_output(output: Path | None) -> None:
    """Raise WriteError for an output that cannot be written, before any work is done."""
    if output is None:
        return
    from kineme.evaluation.score import OUTPUTS

    if output.suffix.lower() not in OUTPUTS:
        raise WriteError(output, f"scores are written as {' or '.join(OUTPUTS)}")
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


def run_folder(
    folder: Path,
    labels: Path,
    methods: Sequence[str],
    *,
    mapping: Mapped,
    n_clusters: int | None,
    read_options: ReadOptions,
    without: Sequence[str],
    constants: Mapping[str, Any],
    output: Path | None,
    as_json: bool,
    quiet: bool,
) -> bool:
    """Print and write the scores of the methods; return whether any recording was scored."""
    try:
        for name in methods:
            check_method(name)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    with show_progress(folder, quiet=quiet or as_json) as stage:
        stage("looking for recordings")
        recordings = find_recordings(folder)
        labelled, strays = find_labels_and_unmatched(recordings, labels)
        result = evaluate_folder(
            labelled,
            methods,
            mapping=mapping,
            n_clusters=n_clusters,
            read_options=read_options,
            without=without,
            constants=constants,
            progress=stage,
        )
    if not quiet:
        _print_names("labels without a recording", strays)
        _print_names(
            "recordings without labels, left out",
            [path.name for path in recordings if path not in labelled],
        )
    _print_problems(result, quiet=quiet)
    if as_json:
        typer.echo(result.to_json())
    elif not quiet:
        _show_scores(result)
    if output is not None:
        write_result(result, output)
    return any(not one.error for ones in result.methods.values() for one in ones)


def _print_names(what: str, names: Sequence[str]) -> None:
    if names:
        typer.echo(escape_controls(f"{what}: {join_names(names, MAX_NAMES)}"), err=True)


def _print_problems(result: FolderScores, *, quiet: bool) -> None:
    """Print which recordings failed and why, and notes on the labels of the others."""
    for name, ones in result.methods.items():
        for one in ones:
            if one.error:
                typer.echo(escape_controls(f"{one.recording}, {name}: {one.error}"), err=True)
    for one in next(iter(result.methods.values())):
        if one.notes and not quiet:
            typer.echo(escape_controls(f"{one.recording}: {'; '.join(one.notes)}"), err=True)


def _show_scores(result: FolderScores) -> None:
    """Print the scores of each recording by method, then the scores over all recordings."""
    columns: dict[str, Any] = {method: result.pool_scores(method) for method in result.methods}
    evaluated = [one for some in result.methods.values() for one in some]
    counts = [name for name in ("count_error",) if any(name in one.scores for one in evaluated)]
    score_names = ("mof", "edit", "f1@50", "border_f1", *counts)
    by_method = [
        (
            method if len(columns) > 1 else "",
            [(one.recording, _format_row(one, score_names)) for one in evaluated],
        )
        for method, evaluated in result.methods.items()
    ]
    show_table("by recording", [scores()[name].title for name in score_names], by_method)
    counted = [
        f"{sum(not one.error for one in evaluated)} of {len(evaluated)}"
        for evaluated in result.methods.values()
    ]
    groups = [*make_score_rows(columns), ("recordings", [("recordings scored", counted)])]
    title = f"over all recordings, one mapping for each {result.mapping}"
    show_table(title, list(columns), groups, note=explain_disagreement(columns))


def _format_row(one: RecordingScores, names: Sequence[str]) -> list[str]:
    if one.error:
        return ["failed"] * len(names)
    values = (one.scores.get(name) for name in names)
    return ["" if value is None else format_score(value) for value in values]


def run_people(
    folder: Path, labels: Sequence[Path], *, output: Path | None, as_json: bool, quiet: bool
) -> None:
    """Print and write how well people agree who labelled the recordings of a folder."""
    with show_progress(folder, quiet=quiet or as_json) as stage:
        stage("looking for recordings")
        recordings = find_recordings(folder)
        names = name_annotators(labels)
        paths = zip(names, labels, strict=True)
        sources = {name: find_labels(recordings, path) for name, path in paths}

        def read_length(path: Path) -> Extent:
            stage(f"reading {path.name}")
            return read_extent(path)

        labelled, failures = gather_labels(sources, read_length)
    for failure in failures:
        typer.echo(escape_controls(failure), err=True)
    if not any(len(sides) > 1 for sides in labelled.values()):
        raise ReadError(folder, "has no recording that two people labelled")
    result = annotator_agreement(labelled)
    if as_json:
        typer.echo(result.to_json())
    elif not quiet:
        _show_agreement(result)
    if output is not None:
        write_result(result, output)


def _show_agreement(result: AnnotatorAgreement) -> None:
    """Print a row for each pair of people, one for all, and one for each recording."""
    pairs = [
        (f"{first}, {second}", [format_score(kappa), format_score(f1), "", str(recordings)])
        for first, second, kappa, f1, recordings in result.pairs
    ]
    n_complete = sum(len(one.annotators) == len(result.annotators) for one in result.recordings)
    all_row = ("all together", ["", "", format_score(result.fleiss_kappa), str(n_complete)])
    show_table(
        f"agreement of {len(result.annotators)} annotators, {MATCHED_BY[result.by]}",
        ["Cohen's kappa", "border F1", "Fleiss' kappa", "recordings"],
        [("", [*pairs, all_row])],
    )
    rows = [
        (one.recording, [format_score(one.fleiss_kappa), str(len(one.differences))])
        for one in result.recordings
    ]
    show_table("by recording", ["Fleiss' kappa", "differences"], [("", rows)])


def score_file(
    path: Path, labels: Path, fps: float | None, trials: list[str] | None, *, quiet: bool
) -> list[dict[str, Any]]:
    """Return the scores of a result as records; print them unless quiet."""
    result = read_result(path, fps=fps)
    n_frames, rate = choose_comparison_rate(result)
    if is_annotation_file(labels):
        recording_path = (result.provenance.get("input") or {}).get("path") or ""
        truth = read_trial(labels, trials[0] if trials else Path(recording_path).stem, fps=rate)
        if truth.frames != n_frames:
            seconds = truth.frames / rate
            raise ReadError(
                labels, f"covers {seconds:.2f} s, but the result lasts {n_frames / rate:.2f} s"
            )
    else:
        truth = read_truth(labels, result, fps=fps)
    scores = score(truth, result)
    if not quiet:
        show_scores(path.name, {"score": scores})
    return [{"result": path.name, "truth": labels.name, **scores}]
