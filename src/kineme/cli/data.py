"""``kineme data``: download public recordings into a cache."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from rich import progress as rich_progress
from rich.filesize import decimal

from kineme._util.checks import format_count
from kineme.cli.help import INPUT, option, output_option
from kineme.cli.options import Quiet
from kineme.cli.terminal import Console, exit_on_error

if TYPE_CHECKING:
    from kineme.datasets.cmu import Fetched
    from kineme.datasets.download import Progress


def data(
    database: Annotated[  # noqa: ARG001 (there is one so far)
        Literal["cmu"], typer.Argument(help="cmu: the CMU Graphics Lab Motion Capture Database.")
    ],
    subject: Annotated[int, typer.Argument(min=1, help="Number of the subject, such as 86.")],
    trials: Annotated[
        str | None,
        option(
            INPUT,
            "Recordings of the subject to fetch, such as 1,2,9-11; by default from 1 up to "
            "the first that does not exist.",
            metavar="NUMBER,NUMBER,…",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        output_option("Folder for the files, by default the cache of kineme.", metavar="FOLDER"),
    ] = None,
    site: Annotated[str | None, typer.Option(envvar="KINEME_CMU_SITE", hidden=True)] = None,
    annotations: Annotated[
        str | None, typer.Option(envvar="KINEME_CMU_ANNOTATIONS", hidden=True)
    ] = None,
    timeout: Annotated[
        float, option(INPUT, "Seconds without data after which kineme connects again.")
    ] = 30.0,
    quiet: Quiet = False,
) -> None:
    """Download public recordings.

    Interrupted downloads are resumed; existing files are checked and kept.

    For example: kineme data cmu 86 --trials 1,2
    """
    numbers = _parse_numbers(trials)
    from kineme.datasets.cmu import ANNOTATIONS, SITE, fetch_subject

    start = time.perf_counter()
    files: list[Fetched] = []
    with exit_on_error(f"subject {subject}"):
        try:
            with _show_progress(quiet=quiet) as (shown, say):
                for file in fetch_subject(
                    subject,
                    numbers,
                    folder=output,
                    progress=shown,
                    site=site or SITE,
                    annotations=annotations or ANNOTATIONS,
                    timeout_s=timeout,
                ):
                    files.append(file)
                    say(_describe_file(file))
        finally:
            if files and not quiet:
                typer.echo(_summarize(files, time.perf_counter() - start))


def _parse_numbers(text: str | None) -> list[int] | None:
    """Parse numbers and ranges such as ``1,2,9-11``."""
    if text is None:
        return None
    numbers: list[int] = []
    for part in text.split(","):
        first, dash, last = part.strip().partition("-")
        try:
            span = range(int(first), int(last if dash else first) + 1)
        except ValueError as error:
            reason = f"{part!r} is not a number or a range"
            raise typer.BadParameter(reason, param_hint="--trials") from error
        if not span:
            raise typer.BadParameter(f"{part!r} runs backwards", param_hint="--trials")
        numbers += span
    if not numbers or min(numbers) < 1:
        raise typer.BadParameter(f"{text!r} contains no trial number", param_hint="--trials")
    return [*dict.fromkeys(numbers)]


@contextmanager
def _show_progress(*, quiet: bool) -> Iterator[tuple[Progress | None, Callable[[str], None]]]:
    """Yield a function that shows the progress of a file, and one that prints a line above it."""
    console = Console(stderr=True, highlight=False)
    if quiet:
        yield None, lambda _: None
        return
    if not console.is_terminal:
        yield None, lambda line: typer.echo(line, err=True)
        return
    columns = (
        "[progress.description]{task.description}",
        rich_progress.BarColumn(),
        rich_progress.DownloadColumn(),
        rich_progress.TransferSpeedColumn(),
    )
    with rich_progress.Progress(*columns, console=console, transient=True) as bars:
        tasks: dict[str, rich_progress.TaskID] = {}

        def show(name: str, done: int, total: int | None) -> None:
            if name not in tasks:
                tasks[name] = bars.add_task(name, total=total)
            bars.update(tasks[name], completed=done, total=total, visible=done != total)

        yield show, console.print


def _describe_file(file: Fetched) -> str:
    length = "" if file.frames is None else f"{format_count(file.frames, 'frame')}, "
    how = "fetched" if file.new else "there already"
    return f"{file.path.name}: {length}{decimal(file.size)}, {how}"


def _summarize(files: list[Fetched], seconds: float) -> str:
    new = [file for file in files if file.new]
    size = decimal(sum(file.size for file in new))
    return (
        f"{format_count(len(files), 'file')} in {files[0].path.parent}: {len(new)} fetched, "
        f"{size}, {seconds:.1f} s"
    )
