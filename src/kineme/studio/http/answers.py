"""What answers and requests have in common."""

from __future__ import annotations

from urllib.parse import quote

from starlette.responses import JSONResponse, Response

from kineme.web.encoding import to_json


class MessageResponse(JSONResponse):
    """A message as JSON."""

    def render(self, content: object) -> bytes:
        return to_json(content)


def file_response(name: str, content: bytes) -> Response:
    """A file to keep; what is not Unicode in its name becomes "?"."""
    called = quote(name.encode(errors="replace"), safe="")
    headers = {"content-disposition": f"attachment; filename*=UTF-8''{called}"}
    return Response(content, headers=headers, media_type="application/octet-stream")


def number_in(text: str) -> int:
    """The number in an address; -1, which nothing has, for anything else."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 9 else -1
