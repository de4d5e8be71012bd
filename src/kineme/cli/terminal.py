"""What is printed, on a terminal, in a file or a pipe.

Names of files, joints and labels may hold codes that would steer a terminal: they are spelled
out. Only a terminal has an edge at which lines are broken.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import rich.console
from rich.console import ConsoleOptions, RenderableType
from rich.segment import Segment

_STEERS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""Controls but tab and line feed, and what turns the direction of text."""
EDGELESS = 10_000
"""Columns of a file or a pipe, which has no edge at which lines would have to be broken."""


class Console(rich.console.Console):
    """A console of rich that spells out the control characters of texts.

    What is no terminal gets every row of a table on a line of its own, however long.
    """

    def __init__(self, *, width: int | None = None, **options: Any) -> None:
        super().__init__(width=width, **options)
        if width is None and not self.is_terminal:
            self.width = EDGELESS

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        """Return the segments of a renderable.

        Rich's own control codes are segments of their own.
        """
        for segment in super().render(renderable, options):
            text = segment.text if segment.control else escape_controls(segment.text)
            yield segment if text == segment.text else segment._replace(text=text)


def escape_controls(text: str) -> str:
    """Return a text whose control characters, which could steer a terminal, are spelled out.

    Examples
    --------
    >>> escape_controls("a" + chr(7) + "b") == "a" + chr(92) + "x07b"
    True
    """
    return _STEERS.sub(lambda found: found[0].encode("unicode_escape").decode(), text)
