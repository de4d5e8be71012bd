"""``kineme studio``: view recordings and correct their segments in the browser."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from kineme.cli.help import OUTPUT, option
from kineme.cli.options import ALL, BODY, Effectors, add_options, are_given
from kineme.cli.terminal import exit_on_error
from kineme.errors import ParameterError
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions

OPTIONS = {"effectors": Effectors} | BODY


@add_options(OPTIONS)
def studio(
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    context: typer.Context,
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="FILES|FOLDER",
            help="Recordings, a folder of them, or a library; by default the current folder.",
        ),
    ] = None,
    port: Annotated[
        int | None,
        option(
            OUTPUT,
            "Port to listen on; 0 for any.",
            metavar="N",
            show_default="the first free from 8750",
        ),
    ] = None,
    browser: Annotated[
        bool,
        option(
            OUTPUT,
            "Whether to open the page in the browser.",
            "--browser/--no-browser",
            show_default="--browser",
        ),
    ] = True,
    dev: Annotated[
        bool,
        typer.Option(
            "--dev", hidden=True, help="Serve the pages from their sources, for `npm run dev`."
        ),
    ] = False,
) -> None:
    """See and correct segments in the browser.

    The page is served on this machine only; presets and constants are selected there. Corrections
    are saved in NAME.segments.json beside each recording after every edit. Ctrl+C stops the server.
    """
    with exit_on_error("studio"):
        root, recordings = _choose_folder(files or [Path()])
        from kineme.library.storage.layout import HEAD
        from kineme.studio.server import serve

        if read_options.person == ALL:
            read_options = replace(read_options, person=None)
            _split_people(recordings, read_options)

        library = None
        if recordings is None and (root / HEAD).is_file():
            if are_given(context, OPTIONS):
                raise ParameterError(
                    f"{root} is a library, which already has reading options: leave these out"
                )
            from kineme.studio.library import StudioLibrary

            library = StudioLibrary(root)
            read_options, segment_options = library.options()

        serve(
            root, recordings, read_options=read_options, segment_options=segment_options,
            port=port, browser=browser, library=library, development=dev,
            announce=lambda address: typer.echo(f"kineme studio: {address} (Ctrl+C ends it)"),
        )  # fmt: skip


def _split_people(recordings: list[Path] | None, options: ReadOptions) -> None:
    """Make each person in the named files a separate recording."""
    if recordings is None:
        raise ParameterError("--person all needs file names: give them, or choose in the page")
    from kineme.studio.folder import Folder
    from kineme.studio.open_recordings import OpenRecordings
    from kineme.studio.storage.sidecars import read_saved_options

    open_recordings = OpenRecordings(Folder(Path(), recordings), lambda *_: None, options)
    for listed in open_recordings.folder.recordings().values():
        if not listed.person:
            open_recordings.change_reading(
                listed.id, read_saved_options(listed.path), everybody=True
            )


def _choose_folder(paths: list[Path]) -> tuple[Path, list[Path] | None]:
    """Return the folder, and the files in it to open; None opens all of them."""
    for path in paths:
        if not path.exists():
            raise ParameterError(f"{path}: there is no such file or folder")
    if len(paths) == 1 and paths[0].is_dir():
        return paths[0], None
    for path in paths:
        if path.is_dir():
            raise ParameterError(f"{path} is a folder: give one folder, or files")
    return paths[0].parent, list(dict.fromkeys(paths))
