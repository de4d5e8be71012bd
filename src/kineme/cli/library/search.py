"""``kineme library search``: find movements that are similar to an example."""

from __future__ import annotations

import re
from json import dumps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.text import Text

from kineme._util.checks import format_count
from kineme.cli.files import make_parent_folder
from kineme.cli.help import OUTPUT, option
from kineme.cli.library.commands import Folder, Json, Scheduler, open_library
from kineme.cli.options import Quiet
from kineme.cli.tables import format_cluster, make_table
from kineme.cli.terminal import Console
from kineme.errors import ParameterError

if TYPE_CHECKING:
    from kineme.library import Example, Hit

_SPAN = re.compile(r"(?P<name>.+)@(?P<start>[0-9.]+)-(?P<stop>[0-9.]+)")
SPAN = "RECORDING[@START-STOP]"
QUERY = "Query"


def search(
    folder: Folder,
    like: Annotated[
        list[str] | None,
        option(
            QUERY,
            "Example to search for: a recording or the name of one in the library, and its "
            "seconds. May be repeated; hits match any example.",
            metavar=SPAN,
        ),
    ] = None,
    start: Annotated[
        float, option(QUERY, "Start of a single --like, in seconds.", metavar="SECONDS")
    ] = 0.0,
    stop: Annotated[
        float | None,
        option(
            QUERY, "End of a single --like, in seconds.", metavar="SECONDS", show_default="its end"
        ),
    ] = None,
    cluster: Annotated[
        str | None,
        option(
            QUERY, "Search for typical movements of a cluster, by number or name.", metavar="NAME"
        ),
    ] = None,
    unlike: Annotated[
        list[str] | None,
        option(
            QUERY,
            "Exclude hits that are more similar to this example; may be repeated.",
            metavar=SPAN,
        ),
    ] = None,
    mirror: Annotated[
        bool,
        option(
            QUERY,
            "Also search with left and right exchanged (bodies only).",
            "--mirror/--no-mirror",
        ),
    ] = True,
    threshold: Annotated[
        float | None,
        option(
            OUTPUT, "Largest distance, 0 to 2; lower finds fewer, better hits.", show_default="0.85"
        ),
    ] = None,
    top: Annotated[int, option(OUTPUT, "Largest number of hits.", min=1)] = 50,
    max_per_recording: Annotated[
        int | None, option(OUTPUT, "Largest number of hits per recording.", min=1)
    ] = None,
    tag: Annotated[
        str | None,
        option(
            OUTPUT,
            "Only hits with this tag: forwards, backwards, left, right, in place, turn "
            "left, turn right, start, stop.",
        ),
    ] = None,
    export: Annotated[
        Path | None,
        option(
            OUTPUT, "New folder for the hits as clips, listed in manifest.csv.", metavar="FOLDER"
        ),
    ] = None,
    scheduler: Scheduler = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Find movements that match an example.

    For example: kineme library search LIB --like walk.bvh@3.5-6
    """
    examples = [_parse_example(text) for text in like or ()]
    if (start or stop is not None) and len(examples) != 1:
        raise typer.BadParameter(f"--start and --stop need a single --like; give several as {SPAN}")
    if (start or stop is not None) and "@" not in (like or [""])[0]:
        examples = [_make_example(like[0] if like else "", start, stop)]
    if not examples and cluster is None:
        raise typer.BadParameter("nothing to search for: give --like or --cluster")
    with open_library(folder) as library:
        from kineme.transfer.matching import THRESHOLD

        if export is not None:
            make_parent_folder(export)
        hits = library.search(
            examples,
            cluster=cluster,
            unlike=[_parse_example(text) for text in unlike or ()],
            threshold=THRESHOLD if threshold is None else threshold,
            top=top,
            max_per_recording=max_per_recording,
            mirror=mirror,
            tag=tag,  # type: ignore[arg-type]
            client=scheduler,
        )
        clips = [] if export is None else library.clips(hits, export)
        if json:
            for hit in hits:
                typer.echo(dumps(hit._asdict()))
        elif not quiet:
            _show(hits)
            if export is not None:
                typer.echo(f"{format_count(len(clips), 'clip')} in {export}")


def _parse_example(text: str) -> Example:
    """Parse ``RECORDING@START-STOP``; an existing file of that name is taken as a whole."""
    match = None if Path(text).exists() else _SPAN.fullmatch(text)
    if match is None:
        return _make_example(text, 0.0, None)
    try:
        return _make_example(match["name"], float(match["start"]), float(match["stop"]))
    except ValueError as error:
        raise typer.BadParameter(f"{text!r} is not {SPAN}") from error


def _make_example(name: str, start: float, stop: float | None) -> Example:
    from kineme.library import Example

    try:
        return Example(name, start, stop)
    except ParameterError as error:
        raise typer.BadParameter(str(error)) from error


def _show(hits: list[Hit]) -> None:
    console = Console(highlight=False)
    table = make_table("#", "recording", "start s", "stop s", "distance", "cluster", "label")
    for number, hit in enumerate(hits):
        span = f"{hit.start_s:.2f}", f"{hit.stop_s:.2f}", f"{hit.distance:.2f}"
        table.add_row(
            str(number), Text(hit.recording), *span, format_cluster(hit.cluster), Text(hit.label)
        )
    n, recordings = len(hits), len({hit.recording for hit in hits})
    if hits:
        console.print(table)
    console.print(
        f"{format_count(n, 'hit')} in {format_count(recordings, 'recording')}"
        if hits
        else "nothing found: a higher --threshold, or no --tag, may find more"
    )
