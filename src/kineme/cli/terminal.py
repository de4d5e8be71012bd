"""Console output to a terminal, a file or a pipe: tables, and messages on standard error.

Names of files, joints and labels may contain control codes for terminals, which are escaped. Only
on a terminal are lines wrapped.
"""

from __future__ import annotations

import re
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

import rich.console
import typer
from rich.console import ConsoleOptions, RenderableType
from rich.segment import Segment

from kineme._util.parallel import announce_to
from kineme.errors import FileError, KinemeError, KinemeWarning

_CONTROLS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""Control characters except tab and line feed, and characters that change text direction."""
UNLIMITED_WIDTH = 10_000
"""Width for files and pipes, so that lines are never wrapped."""
PROGRESS_DELAY_S = 1.0
"""Time before progress is shown."""


class Console(rich.console.Console):
    """A console of rich that escapes control characters in texts.

    Without a terminal, every row of a table is on one line, however long.
    """

    def __init__(self, *, width: int | None = None, **options: Any) -> None:
        super().__init__(width=width, **options)
        if width is None and not self.is_terminal:
            self.width = UNLIMITED_WIDTH

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        """Return the segments of a renderable with control characters escaped.

        Rich's own control codes are separate segments and are kept.
        """
        for segment in super().render(renderable, options):
            text = segment.text if segment.control else escape_controls(segment.text)
            yield segment if text == segment.text else segment._replace(text=text)


def escape_controls(text: str) -> str:
    """Return a text with its control characters escaped.

    Examples
    --------
    >>> escape_controls("a" + chr(7) + "b") == "a" + chr(92) + "x07b"
    True
    """
    return _CONTROLS.sub(lambda match: match[0].encode("unicode_escape").decode(), text)


@contextmanager
def show_progress(what: object, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """Yield a function that shows the current stage on a terminal, after a second."""
    status = Console(stderr=True).status(str(what))
    if quiet or not status.console.is_terminal:
        yield lambda _: None
        return
    timer = threading.Timer(PROGRESS_DELAY_S, status.start)
    timer.daemon = True
    timer.start()
    try:
        with announce_to(show := lambda stage: status.update(f"{what}: {stage}")):
            yield show
    finally:
        timer.cancel()
        timer.join()
        status.stop()


def shorten_warnings() -> None:
    """Show every KinemeWarning, and print any warning as one line without its source."""
    warnings.simplefilter("always", KinemeWarning)
    warnings.showwarning = _show_warning


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    _print_message("warning", format_line(message), typer.colors.YELLOW)


@contextmanager
def exit_on_error(subject: object = "") -> Iterator[None]:
    """Print an error in the block as one line that names ``subject``, and exit with code 1."""
    try:
        yield
    except KinemeError as error:
        # The error of a file names that file.
        print_error(format_line(error, subject="" if isinstance(error, FileError) else subject))
        raise typer.Exit(1) from error


def print_error(text: str) -> None:
    """Print a line about a failure."""
    _print_message("error", text, typer.colors.RED)


def print_skipped(text: str) -> None:
    """Print a line about something skipped that was not requested by name."""
    _print_message("skipped", text, typer.colors.YELLOW)


def _print_message(what: str, text: str, color: str) -> None:
    typer.secho(f"{what}: ", fg=color, bold=True, err=True, nl=False)
    typer.echo(escape_controls(text), err=True)


def format_line(message: object, *, subject: object = "") -> str:
    """Return a message on one line, with its subject if the message does not contain it."""
    text = " ".join(str(message).split())
    return text if str(subject) in text else f"{subject}: {text}"
