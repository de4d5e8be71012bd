"""What goes to standard error: errors, warnings, progress."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer

from kineme.errors import KinemeError, KinemeWarning

PATIENCE = 1.0  # seconds before progress is shown


class Failures:
    """Counts and reports the inputs that failed, so that the others still run."""

    def __init__(self) -> None:
        self.count = 0

    @contextmanager
    def caught(self, subject: object) -> Iterator[None]:
        """Report a failure in the block as one line that names ``subject``."""
        try:
            yield
        except KinemeError as error:
            self.count += 1
            text = _one_line(error)
            _say("error", text if str(subject) in text else f"{subject}: {text}", typer.colors.RED)

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
    from rich.console import Console

    status = Console(stderr=True).status(str(what))
    if quiet or not status.console.is_terminal:
        yield _no_progress
        return
    timer = threading.Timer(PATIENCE, status.start)
    timer.daemon = True
    timer.start()
    try:
        yield lambda stage: status.update(f"{what}: {stage}")
    finally:
        timer.cancel()
        timer.join()
        status.stop()


def _no_progress(_: str) -> None:
    """Says nothing."""


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    _say("warning", _one_line(message), typer.colors.YELLOW)


def _say(what: str, text: str, color: str) -> None:
    typer.secho(f"{what}: ", fg=color, bold=True, err=True, nl=False)
    typer.echo(text, err=True)


def _one_line(message: object) -> str:
    return " ".join(str(message).split())
