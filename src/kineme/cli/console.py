"""Tables and progress on the terminal, in which no name of a file, joint or label steers it."""

from __future__ import annotations

from collections.abc import Iterable

import rich.console
from rich.console import ConsoleOptions, RenderableType
from rich.segment import Segment

from kineme.cli.harmless import harmless


class Console(rich.console.Console):
    """A console of rich that spells out the control characters of texts."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        """The segments of a renderable; rich's own control codes are segments of their own."""
        for segment in super().render(renderable, options):
            told = segment.text if segment.control else harmless(segment.text)
            yield segment if told == segment.text else segment._replace(text=told)
