"""What answers and requests have in common."""

from __future__ import annotations

from starlette.responses import JSONResponse

from kineme.web.encoding import to_json


class MessageResponse(JSONResponse):
    """A message as JSON."""

    def render(self, content: object) -> bytes:
        return to_json(content)


def number_in(text: str) -> int:
    """The number in an address; -1, which nothing has, for anything else."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 9 else -1
