"""Messages on standard error: errors, warnings, progress."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer

from kineme._util.parallel import announce_to
from kineme.errors import KinemeError, KinemeWarning

PROGRESS_DELAY_S = 1.0
"""Time before progress is shown."""


class Failures:
    """Count and print failures, so that the command can end with an exit code."""

    def __init__(self) -> None:
        self.count = 0

    @contextmanager
    def catch_errors(self, subject: object) -> Iterator[None]:
        """Print an error in the block as one line that names ``subject``."""
        try:
            yield
        except KinemeError as error:
            self.count += 1
            print_error(format_line(error, subject=subject))

    def exit(self) -> None:
        """Exit with code 1 if anything failed."""
        if self.count:
            raise typer.Exit(1)


def shorten_warnings() -> None:
    """Show every KinemeWarning, and print any warning as one line without its source."""
    warnings.simplefilter("always", KinemeWarning)
    warnings.showwarning = _show_warning


@contextmanager
def show_progress(what: object, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """Yield a function that shows the current stage on a terminal, after a second."""
    from kineme.cli.terminal import Console

    status = Console(stderr=True).status(str(what))
    if quiet or not status.console.is_terminal:
        yield _ignore_stage
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


def _ignore_stage(_: str) -> None:
    """Ignore the stage."""


def print_error(text: str) -> None:
    """Print a line about a failure."""
    _print_message("error", text, typer.colors.RED)


def print_skipped(text: str) -> None:
    """Print a line about something skipped that was not requested by name."""
    _print_message("skipped", text, typer.colors.YELLOW)


def format_line(message: object, *, subject: object = "") -> str:
    """Return a message on one line, with its subject if the message does not contain it."""
    text = " ".join(str(message).split())
    return text if str(subject) in text else f"{subject}: {text}"


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    _print_message("warning", format_line(message), typer.colors.YELLOW)


def _print_message(what: str, text: str, color: str) -> None:
    from kineme.cli.terminal import escape_controls

    typer.secho(f"{what}: ", fg=color, bold=True, err=True, nl=False)
    typer.echo(escape_controls(text), err=True)
