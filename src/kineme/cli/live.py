"""``kineme live``: segment a stream and count repetitions while it is recorded."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, nullcontext, suppress
from dataclasses import dataclass, field, replace
from functools import partial
from json import dumps
from pathlib import Path
from time import sleep
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme._util.checks import format_count
from kineme.cli.files import check_writable
from kineme.cli.help import INPUT, METHOD, OUTPUT, TABLES, option, output_option
from kineme.cli.options import READING, SEGMENTING, Quiet, add_options
from kineme.cli.tables import make_table
from kineme.cli.terminal import Console, exit_on_error, print_skipped
from kineme.formats import read
from kineme.formats.options import ReadOptions
from kineme.labels import write_segments
from kineme.live.events import ActivityEnded, ActivityStarted, Event, Gap, Notice, Repetition
from kineme.live.outputs import OUTPUTS, Send
from kineme.methods.segmenter import SegmentOptions

if TYPE_CHECKING:
    from rich.table import Table

    from kineme.live.sources import Source
    from kineme.live.storage import Journal
    from kineme.live.stream import Stream

OUTPUT_OPTIONS = {
    name: Annotated[output.type | None, option(OUTPUT, output.help, metavar=output.metavar)]
    for name, output in OUTPUTS.items()
}
"""Options of the registered outputs for events."""
MAX_PAST = 6
"""Finished activities that the terminal shows."""


@add_options(READING | SEGMENTING, outputs=OUTPUT_OPTIONS)
def live(
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    outputs: dict[str, Any],
    replay: Annotated[Path | None, option(INPUT, "Replay this recording.")] = None,
    speed: Annotated[float, option(INPUT, "Speed factor of --replay; 0: no delay.", min=0)] = 1.0,
    lsl: Annotated[
        str | None, option(INPUT, "Read an LSL stream, by name or type.", metavar="NAME")
    ] = None,
    osc: Annotated[
        int | None, option(INPUT, "Receive OSC, such as VMC, on this UDP port.", metavar="PORT")
    ] = None,
    osc_host: Annotated[
        str, option(INPUT, "Local address for --osc; 0.0.0.0 for any.")
    ] = "127.0.0.1",
    delay: Annotated[
        float, option(METHOD, "Seconds until the start of an activity is final.", min=0.1)
    ] = 5.0,
    interval: Annotated[float, option(METHOD, "Seconds between analyses.", min=0.1)] = 2.0,
    output: Annotated[
        Path | None, output_option(f"Write the segments at the end: {TABLES}.")
    ] = None,
    record: Annotated[
        Path | None,
        option(OUTPUT, "Save the rows in NAME.journal.csv, converted to NAME.parquet at the end."),
    ] = None,
    recover: Annotated[
        Path | None, option(OUTPUT, "Convert the journal of a killed run to Parquet, then exit.")
    ] = None,
    page: Annotated[
        bool, option(OUTPUT, "Show the stream in the browser until Ctrl+C.", "--page")
    ] = False,
    json: Annotated[bool, option(OUTPUT, "Print JSON, one line per event.", "--json")] = False,
    quiet: Quiet = False,
) -> None:
    """Segment and count while a recording is made.

    Rows are read as CSV or JSON from standard input, unless another source is given. Results are
    provisional at first. The start of an activity is final after --delay, its end and its
    repetitions when the next one begins. Ctrl+C ends the recording.

    For example: sensor | kineme live --fps 100 --record take
    """
    from kineme.live.storage import Journal, recover_journal

    sources = {"--replay": replay, "--lsl": lsl, "--osc": osc}
    given_sources = [name for name, value in sources.items() if value is not None]
    if len(given_sources) > 1:
        raise typer.BadParameter("give one source only", param_hint=" / ".join(given_sources))
    with exit_on_error():
        if recover is not None:
            typer.echo(f"wrote {recover_journal(recover)}")
            return
        check_writable(output)
        source = _open_source(replay, speed, lsl, (osc, osc_host), read_options)
        stream = _make_stream(source, segment_options, delay, interval)
        journal = None if record is None else Journal(record, source.channels, source.fps)
        with ExitStack() as opened:
            opening = [OUTPUTS[name].open(value) for name, value in outputs.items()]
            opening += [_open_page(stream)] if page else []
            sends = [opened.enter_context(each) for each in opening]
            with (
                nullcontext() if journal is None else closing(journal),
                _open_printer(json=json, quiet=quiet) as show,
            ):
                is_stopped = _push_all(source, stream, journal, [*sends, show])
            _write(stream, output, journal, quiet=json or quiet)
            if page and not is_stopped:
                _wait_for_interrupt()


def _push_all(
    source: Source, stream: Stream, journal: Journal | None, sends: Sequence[Send]
) -> bool:
    """Send the events of all rows until the source ends; return whether Ctrl+C ended it."""

    def tell(events: Sequence[Event]) -> None:
        for send in sends:
            send(events)

    try:
        for rows in source.rows if journal is None else journal.write_ahead(source.rows):
            for remark in rows.remarks:
                print_skipped(remark)
            tell(stream.push(rows.values, rows.seconds, unit="s"))
    except KeyboardInterrupt:
        return True
    finally:
        tell(stream.finish())
    return False


def _write(stream: Stream, output: Path | None, journal: Journal | None, *, quiet: bool) -> None:
    """Write the segments and print the written files."""
    if output is not None:
        write_segments(stream.segmentation, output)
    if not quiet:
        for path in filter(None, (journal and journal.target, output)):
            typer.echo(f"wrote {path}")


@contextmanager
def _open_page(stream: Stream) -> Iterator[Send]:
    """Open a page in the browser; yield the function that updates it."""
    from kineme.studio.live_page import LivePage, serve_page

    skeleton = stream.layout.skeleton
    page = LivePage(stream.fps, stream.layout.channels, skeleton.parents if skeleton else ())

    def send(events: Sequence[Event]) -> None:
        page.add([event.to_json() for event in events], *stream.frames(page.n_frames))
        page.has_ended = stream.is_finished

    with serve_page(page, lambda address: typer.echo(f"kineme live: {address}", err=True)):
        yield send


def _wait_for_interrupt() -> None:
    with suppress(KeyboardInterrupt):
        # Printed inside the block: whoever reads the line may interrupt at once.
        typer.echo("the page stays open until Ctrl+C", err=True)
        while True:
            sleep(1)


def _open_source(
    replay: Path | None,
    speed: float,
    lsl: str | None,
    osc: tuple[int | None, str],  # port and address
    options: ReadOptions,
) -> Source:
    """Return the selected source, with its frame rate."""
    from kineme.live import sources

    if replay is not None:
        return sources.replay(read(replay, **vars(options)), speed)
    if lsl is not None:
        source = sources.receive_lsl(lsl)
    elif (port := osc[0]) is not None:
        source = sources.receive_osc(port, osc[1])
    else:
        source = sources.read_lines(sys.stdin, options.columns or ())
    fps = source.fps if options.fps is None else options.fps
    if fps and source.has_unit:
        return replace(source, fps=fps)
    return sources.measure_rate(source, fps)


def _make_stream(source: Source, options: SegmentOptions, delay: float, interval: float) -> Stream:
    from kineme.live.stream import Stream, as_keywords

    return Stream(
        fps=source.fps,
        channels=None if source.skeleton else source.channels,
        skeleton=source.skeleton,
        delay=delay,
        interval=interval,
        **as_keywords(options),
    )


@contextmanager
def _open_printer(*, json: bool, quiet: bool) -> Iterator[Send]:
    """Yield a function that prints events as JSON, as a live table in a terminal, or as text."""
    if json or quiet or not sys.stdout.isatty():
        yield _print_json if json else partial(_print_lines, quiet=quiet)
        return
    from rich.live import Live

    view = View()
    with Live(view.table(), console=Console(), refresh_per_second=8) as screen:

        def update(events: Sequence[Event]) -> None:
            for event in events:
                view.add(event)
                if isinstance(event, Notice):
                    screen.console.print(event.text)
            if events:
                screen.update(view.table())

        yield update


def _print_json(events: Sequence[Event]) -> None:
    for event in events:
        sys.stdout.write(dumps(event.to_json()) + "\n")
    sys.stdout.flush()


def _print_lines(events: Sequence[Event], *, quiet: bool) -> None:
    for event in events:
        if isinstance(event, Notice):
            print_skipped(event.text)
        elif event.is_final and not quiet:
            sys.stdout.write(describe(event) + "\n")
    sys.stdout.flush()


def describe(event: Event) -> str:
    """Return a final event as a line of text.

    Examples
    --------
    >>> describe(Repetition(at_s=9.0, number=3, start_s=2.0, stop_s=3.5, cluster=0))
    '    3.50 s  cluster 0: 3'
    """
    if isinstance(event, ActivityStarted):
        return f"{event.start_s:8.2f} s  {_format_name(event)} begins"
    if isinstance(event, ActivityEnded):
        count = format_count(event.repetitions, "repetition")
        return f"{event.stop_s:8.2f} s  {_format_name(event)} ends, {count}"
    if isinstance(event, Repetition):
        return f"{event.stop_s:8.2f} s  cluster {event.cluster}: {event.number}"
    if isinstance(event, Gap):
        return f"{event.start_s:8.2f} s  gap of {event.stop_s - event.start_s:.2f} s"
    return ""


def _format_name(event: ActivityStarted | ActivityEnded) -> str:
    return event.label or f"cluster {event.cluster}"


@dataclass
class View:
    """Live table in the terminal: the present activity and the last finished ones."""

    name: str = "–"
    count: int = 0
    stops: list[float] = field(default_factory=list)
    past: list[ActivityEnded] = field(default_factory=list)

    def add(self, event: Event) -> None:
        """Update the view with an event.

        Name and count of the present activity follow provisional events, as these are early. Final
        events only list past activities, and clear the present one when the recording ends.
        """
        if isinstance(event, ActivityStarted) and not event.is_final:
            self.name, self.count, self.stops = _format_name(event), 0, []
        elif isinstance(event, Repetition) and not event.is_final:
            self.count = event.number
            self.stops = [*self.stops[-4:], event.stop_s]
        elif isinstance(event, ActivityEnded):
            if event.is_final:
                self.past = [*self.past[-MAX_PAST + 1 :], event]
            if not event.is_final or event.stop_s >= event.at_s:  # or the recording has ended
                self.name, self.count, self.stops = "–", 0, []

    @property
    def tempo(self) -> float:
        """Repetitions per minute over the last ones; 0 if there are too few."""
        if len(self.stops) < 2 or self.stops[-1] <= self.stops[0]:
            return 0.0
        return 60 * (len(self.stops) - 1) / (self.stops[-1] - self.stops[0])

    def table(self) -> Table:
        """Return the table to show."""
        table = make_table("activity", "from s", "to s", "repetitions", "a minute")
        for event in self.past:
            row = _format_name(event), f"{event.start_s:.1f}", f"{event.stop_s:.1f}"
            table.add_row(*row, str(event.repetitions), "", style="dim")
        tempo = f"{self.tempo:.0f}" if self.tempo else ""
        table.add_row(self.name, "", "", str(self.count), tempo, style="bold")
        return table
