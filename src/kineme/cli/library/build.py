"""``kineme library build``: build a library from recordings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme._util.checks import format_count
from kineme._util.files import is_remote
from kineme._util.parallel import count_threads
from kineme.cli.files import Batch
from kineme.cli.help import INPUT, OUTPUT, RECORDINGS, option
from kineme.cli.library.commands import Scheduler, parse_path_or_url
from kineme.cli.options import READING, SEGMENTING, Quiet, add_options, are_given
from kineme.cli.terminal import exit_on_error, format_line, print_skipped, show_progress
from kineme.errors import KinemeError
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions

if TYPE_CHECKING:
    from kineme.library import Built


OPTIONS = READING | SEGMENTING


@add_options(OPTIONS)
def build(
    into: Annotated[
        Path,
        option(
            OUTPUT,
            "Folder or URL of the library to create or update.",
            "--into",
            parser=parse_path_or_url,
            metavar="LIB",
        ),
    ],
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    context: typer.Context,
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            parser=parse_path_or_url,
            metavar="FILES",
            help=f"Recordings, folders of them, or URLs: {RECORDINGS}. They are added to those "
            "of the library; without any, it checks its own again.",
        ),
    ] = None,
    remove: Annotated[
        list[Path] | None,
        option(
            OUTPUT,
            "Remove these files or folders from the library; may be repeated.",
            parser=parse_path_or_url,
            metavar="PATH",
        ),
    ] = None,
    jobs: Annotated[
        int | None,
        typer.Option(min=1, help="Number of processes.", show_default="one for each core"),
    ] = None,
    scheduler: Scheduler = None,
    recursive: Annotated[
        bool | None,
        option(
            INPUT,
            "Whether to include subfolders.",
            "--recursive/--flat",
            "-r",
            show_default="as in the last build",
        ),
    ] = None,
    quiet: Quiet = False,
) -> None:
    """Segment a collection and index it for search.

    Recordings in the library are kept, and an interrupted build is resumed. Options for reading and
    segmenting stay as before; if one is changed, all recordings are segmented again.
    """
    processes = jobs or count_threads()
    with exit_on_error(into):
        if processes > 1 and scheduler is None and _needs_processes(files or (), into):
            from kineme.library.executors import start_fork_server

            start_fork_server()  # worker processes start while modules are imported
        from kineme.library.building import build as build_library
        from kineme.library.planning import list_sources

        as_before = not are_given(context, OPTIONS)
        # The build forgets removed sources and those never found, so list them before it.
        sources = list_sources(into, files or (), remove or ())
        with show_progress(into, quiet=quiet) as stage:
            built = build_library(
                files or (),
                into,
                remove=remove or (),
                recursive=recursive,
                read_options=None if as_before else read_options,
                segment_options=None if as_before else segment_options,
                jobs=processes,
                client=scheduler,
                progress=stage,
            )
        if not quiet:
            typer.echo(_summarize(built))
        _report_and_exit(built, sources)


def _needs_processes(files: Sequence[Path], into: Path) -> bool:
    """Return whether there is probably work for several processes."""
    from kineme.library.storage.layout import HEAD

    is_new = not (into / HEAD).exists()
    return is_new and (len(files) > 1 or any(file.is_dir() for file in files))


def _report_and_exit(built: Built, sources: Sequence[Path]) -> None:
    """Print what failed; exit with code 1 if it was named by the user."""
    failed = {path: reason for path, reason in built.failed.items() if is_remote(path)}
    for path, reason in failed.items():
        print_skipped(format_line(reason, subject=path))
    if failed.keys() & {*sources}:
        raise typer.Exit(1)
    batch = Batch([path for path in sources if not is_remote(path)], recursive=built.recursive)
    for path in batch.paths:
        with batch.catch_errors(path):
            if path in built.failed:
                raise KinemeError(built.failed[path])
    batch.exit()


def _summarize(built: Built) -> str:
    n = len(built.paths)
    parts = [f"{format_count(n, 'recording')} in {built.folder}", f"{built.new} new"]
    parts += [f"{built.removed} removed"] * bool(built.removed)
    parts += [f"{len(built.failed)} failed"] * bool(built.failed)
    return ", ".join(parts)
