"""Console output to a terminal, a file or a pipe.

Names of files, joints and labels may contain control codes for terminals, which are escaped. Only
on a terminal are lines wrapped.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import rich.console
from rich.console import ConsoleOptions, RenderableType
from rich.segment import Segment

_CONTROLS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""Control characters except tab and line feed, and characters that change text direction."""
UNLIMITED_WIDTH = 10_000
"""Width for files and pipes, so that lines are never wrapped."""


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
