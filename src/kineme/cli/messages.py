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
            say_error(one_line(error, subject=subject))

    def exit(self) -> None:
        """End with code 1 if anything failed."""
        if self.count:
            raise typer.Exit(1)


def short_warnings() -> None:
    """Show every KinemeWarning, and any warning as one line without its source."""
    warnings.simplefilter("always", KinemeWarning)
    warnings.showwarning = _show_warning


@contextmanager
def progress(what: object, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """A function to name the stage at work; shown on a terminal once a second has passed."""
    from kineme.cli.terminal import Console

    status = Console(stderr=True).status(str(what))
    if quiet or not status.console.is_terminal:
        yield _no_progress
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


def _no_progress(_: str) -> None:
    """Says nothing."""


def say_error(text: str) -> None:
    """A line about what failed."""
    _say("error", text, typer.colors.RED)


def say_skipped(text: str) -> None:
    """A line about what was left out, though nobody had asked for it by name."""
    _say("skipped", text, typer.colors.YELLOW)


def one_line(message: object, *, subject: object = "") -> str:
    """Return a message without line breaks, and what it is about if that is not in it."""
    text = " ".join(str(message).split())
    return text if str(subject) in text else f"{subject}: {text}"


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    _say("warning", one_line(message), typer.colors.YELLOW)


def _say(what: str, text: str, color: str) -> None:
    from kineme.cli.terminal import harmless

    typer.secho(f"{what}: ", fg=color, bold=True, err=True, nl=False)
    typer.echo(harmless(text), err=True)
