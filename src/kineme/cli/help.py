"""Help that names the registered formats, which is filled in only when it is shown.

Formats are many modules, and other packages may add theirs: importing them takes
time that a command which reads no such file does not need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from typer.core import TyperCommand

if TYPE_CHECKING:
    from typer._click import Context, HelpFormatter

RECORDINGS = "@recordings@"
"""Stands in a help text for the names of the formats of recordings."""
LABELS = "@labels@"
"""Stands for those of the formats of labels."""
TABLES = "@tables@"
"""Stands for the suffixes by which these are written."""


class Command(TyperCommand):
    """A command in whose help such names may stand."""

    def format_help(self, ctx: Context, formatter: HelpFormatter) -> None:
        """Write the help, filled in."""
        for parameter in self.params:
            text = getattr(parameter, "help", None)
            if text and "@" in text:
                parameter.help = _filled(text)  # type: ignore[attr-defined]
        super().format_help(ctx, formatter)


def _filled(text: str) -> str:
    from kineme.formats import supported_formats
    from kineme.labels import label_formats, written_suffixes

    formats = reversed(supported_formats())  # the oldest first
    recordings = [known.name for known in formats if known.read is not None]
    text = text.replace(RECORDINGS, ", ".join(recordings))
    return text.replace(LABELS, ", ".join(label_formats())).replace(
        TABLES, ", ".join(written_suffixes())
    )
