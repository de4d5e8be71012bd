"""What goes to standard error: errors, warnings, progress."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer

from kineme._util.parallel import announce_to
from kineme.errors import KinemeError, KinemeWarning

PATIENCE = 1.0  # seconds before progress is shown


class Failures:
    """Counts and reports what failed, so that the command can end with one sentence of it."""

    def __init__(self) -> None:
        self.count = 0

    @contextmanager
    def caught(self, subject: object) -> Iterator[None]:
        """Report a failure in the block as one line that names ``subject``."""
        try:
            yield
        except KinemeError as error:
            self.count += 1
            print_error(format_line(error, subject=subject))

    def exit(self) -> None:
        """End with code 1 if anything failed."""
        if self.count:
            raise typer.Exit(1)


def shorten_warnings() -> None:
    """Show every KinemeWarning, and any warning as one line without its source."""
    warnings.simplefilter("always", KinemeWarning)
    warnings.showwarning = _show_warning


@contextmanager
def show_progress(what: object, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """A function to name the stage at work; shown on a terminal once a second has passed."""
    from kineme.cli.terminal import Console

    status = Console(stderr=True).status(str(what))
    if quiet or not status.console.is_terminal:
        yield _ignore_stage
        return
    timer = threading.Timer(PATIENCE, status.start)
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
    """Says nothing."""


def print_error(text: str) -> None:
    """A line about what failed."""
    _print_message("error", text, typer.colors.RED)


def print_skipped(text: str) -> None:
    """A line about what was left out, though nobody had asked for it by name."""
    _print_message("skipped", text, typer.colors.YELLOW)


def format_line(message: object, *, subject: object = "") -> str:
    """Return a message without line breaks, and what it is about if that is not in it."""
    text = " ".join(str(message).split())
    return text if str(subject) in text else f"{subject}: {text}"


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    _print_message("warning", format_line(message), typer.colors.YELLOW)


def _print_message(what: str, text: str, color: str) -> None:
    from kineme.cli.terminal import escape_controls

    typer.secho(f"{what}: ", fg=color, bold=True, err=True, nl=False)
    typer.echo(escape_controls(text), err=True)
