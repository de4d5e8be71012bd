"""``kineme report``: recordings in, pages to look at out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme.cli.inputs import Files, recordings_of
from kineme.cli.messages import Failures, progress
from kineme.cli.reading import Effectors, Quiet, effector_names
from kineme.cli.segment import run
from kineme.cli.signals import Columns, Emg, SignalOptions, run_signals
from kineme.cli.targets import check_writable, targets
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT, PRESETS, resolve_preset

if TYPE_CHECKING:
    from kineme.recordings.motion import Motion
    from kineme.recordings.signals import Signals
    from kineme.segments.segmentation import Segmentation


def report(
    files: Files,
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            help="Page to write: .html; a folder; or a name with {name} in it.",
        ),
    ] = Path(),
    segments: Annotated[
        Path | None,
        typer.Option(
            help="Table or labels to show, instead of segmenting anew; a folder of "
            "NAME.segments.json; or a name with {name} in it.",
        ),
    ] = None,
    preset: Annotated[str, typer.Option(help=f"{', '.join(PRESETS)}.")] = DEFAULT,
    quiet: Quiet = False,
    effectors: Effectors = None,
    columns: Columns = None,
    emg: Emg = False,
    overrides: dict[str, Any] | None = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Write a page on which a recording plays beside its segments, for any browser.

    One file with everything in it: it needs neither a server nor a network.
    """
    overrides = overrides or {}
    try:
        chosen = resolve_preset(preset, **overrides)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error
    reading = reading or {}
    signals = SignalOptions.of(columns, reading.get("fps"), emg=emg)
    names = effector_names(effectors)
    failures = Failures()
    files = recordings_of(files, failures)
    pages = [page for page in targets("--output", output, files, ".html") if page is not None]
    tables = targets("--segments", segments, files, ".segments.json")
    for path, page, table in zip(files, pages, tables, strict=True):
        with failures.caught(path):
            check_writable(page=page)
            source: Motion | Signals
            if table is not None:
                source, result = _read(path, table, reading, signals, quiet=quiet)
            elif signals.mean(path):
                result, _, source = run_signals(path, signals, preset, overrides, quiet=quiet)
            else:
                result, _, source = run(path, reading, chosen, names, quiet=quiet)
            from kineme.report.page import write_report

            write_report(source, result, page, name=path.name, effectors=names)
            if not quiet:
                typer.echo(page)
    failures.exit()


def _read(
    path: Path,
    table: Path,
    reading: dict[str, Any],
    signals: SignalOptions,
    *,
    quiet: bool,
) -> tuple[Motion | Signals, Segmentation]:
    """A recording and the segments in a file."""
    with progress(path.name, quiet=quiet) as stage:
        stage("reading")
        from kineme.formats import read
        from kineme.labels import read_segments

        is_signal = signals.mean(path)
        source = signals.drawn(signals.read(path)) if is_signal else read(path, **reading)
        return source, read_segments(table, fps=source.fps, n_frames=source.n_frames)
