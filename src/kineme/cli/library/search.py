"""``kineme library search``: where recordings are like an example."""

from __future__ import annotations

import re
from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme._counts import counted
from kineme.cli.library.folder import Folder, Json, Scheduler, opened
from kineme.cli.options.reading import Quiet
from kineme.cli.options.targets import make_folder_of

if TYPE_CHECKING:
    from kineme.library import Example, Hit

_SPAN = re.compile(r"(?P<take>.+)@(?P<start>[0-9.]+)-(?P<stop>[0-9.]+)")
SPAN = "TAKE[@START-STOP]"


def search(
    folder: Folder,
    like: Annotated[
        list[str] | None,
        typer.Option(
            metavar=SPAN,
            help="A recording, or the name of one in the library, and the seconds that count; may "
            "be given again: any of them will do.",
        ),
    ] = None,
    start: Annotated[float, typer.Option(help="Seconds at which a single --like starts.")] = 0.0,
    stop: Annotated[float | None, typer.Option(help="And stops.", show_default="its end")] = None,
    cluster: Annotated[
        str | None, typer.Option(help="Search for what is typical of a cluster, number or name.")
    ] = None,
    unlike: Annotated[
        list[str] | None,
        typer.Option(metavar=SPAN, help="Leave out what is more like this; may be given again."),
    ] = None,
    threshold: Annotated[
        float | None,
        typer.Option(
            help="Largest distance; lower finds less, more of it right.", show_default="0.85"
        ),
    ] = None,
    top: Annotated[int, typer.Option(min=1, help="Hits at most.")] = 50,
    max_per_recording: Annotated[
        int | None, typer.Option(min=1, help="Of one recording at most.")
    ] = None,
    mirror: Annotated[
        bool, typer.Option("--mirror", help="Search for the mirror images as well.")
    ] = False,
    export: Annotated[
        Path | None, typer.Option(help="Folder to make: each hit as a clip, and a manifest.")
    ] = None,
    scheduler: Scheduler = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Find what is like an example in all recordings, whoever moves there."""
    examples = [_example(text) for text in like or ()]
    if (start or stop is not None) and len(examples) != 1:
        raise typer.BadParameter(
            f"--start and --stop are of a single --like; give several as {SPAN}"
        )
    if (start or stop is not None) and "@" not in (like or [""])[0]:
        examples = [_example_of(like[0] if like else "", start, stop)]
    if not examples and cluster is None:
        raise typer.BadParameter("nothing to search for: give --like or --cluster")
    with opened(folder) as library:
        from kineme.matching import THRESHOLD

        if export is not None:
            make_folder_of(export)
        hits = library.search(
            examples,
            cluster=cluster,
            unlike=[_example(text) for text in unlike or ()],
            threshold=THRESHOLD if threshold is None else threshold,
            top=top,
            max_per_recording=max_per_recording,
            mirror=mirror,
            client=scheduler,
        )
        clips = [] if export is None else library.clips(hits, export)
        if json:
            for hit in hits:
                typer.echo(dumps(hit._asdict()))
        elif not quiet:
            _show(hits)
            if export is not None:
                typer.echo(f"{counted(len(clips), 'clip')} in {export}")


def _example(text: str) -> Example:
    """A recording and its span, as typed; one whose name looks like that is itself."""
    found = None if Path(text).exists() else _SPAN.fullmatch(text)
    if found is None:
        return _example_of(text, 0.0, None)
    try:
        return _example_of(found["take"], float(found["start"]), float(found["stop"]))
    except ValueError as error:
        raise typer.BadParameter(f"{text!r} is not {SPAN}") from error


def _example_of(take: str, start: float, stop: float | None) -> Example:
    from kineme.errors import ParameterError
    from kineme.library import Example

    try:
        return Example(take, start, stop)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error


def _show(hits: list[Hit]) -> None:
    from rich.text import Text

    from kineme.cli.console import Console
    from kineme.cli.tables import cluster_cell, new_table

    console = Console(highlight=False)
    table = new_table("#", "recording", "start s", "stop s", "distance", "cluster", "label")
    for number, hit in enumerate(hits):
        span = f"{hit.start_s:.2f}", f"{hit.stop_s:.2f}", f"{hit.distance:.2f}"
        table.add_row(
            str(number), Text(hit.recording), *span, cluster_cell(hit.cluster), Text(hit.label)
        )
    n, recordings = len(hits), len({hit.recording for hit in hits})
    if hits:
        console.print(table)
    console.print(
        f"{counted(n, 'hit')} in {counted(recordings, 'recording')}"
        if hits
        else "nothing found: a higher --threshold finds more"
    )
