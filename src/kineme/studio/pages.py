"""The page's own files: those of the built bundle, and no others."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path

from starlette.requests import Request
from starlette.responses import Response

STATIC = Path(__file__).parents[1] / "web" / "static"
PAGE = "studio.html"
TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".wasm": "application/wasm",
    ".woff2": "font/woff2",
}


class Pages:
    """Files of a folder, read when asked for; what the browser has is asked for by its digest."""

    def __init__(self, folder: Path = STATIC):
        self._folder = folder

    def answer(self, request: Request) -> Response:
        """The file that the path names; 404 for everything not in the folder."""
        name = request.path_params.get("path") or PAGE
        path = self._files().get(name)
        if path is None:
            missing = "has not been built: npm run build" if name == PAGE else "is not one of ours"
            return Response(f"this page {missing}", 404, media_type="text/plain")
        content = path.read_bytes()
        headers = {"etag": f'"{sha256(content).hexdigest()[:32]}"', "cache-control": "no-cache"}
        if headers["etag"] in request.headers.get("if-none-match", ""):
            return Response(status_code=304, headers=headers)
        return Response(content, headers=headers, media_type=TYPES[path.suffix])

    def _files(self) -> dict[str, Path]:
        """By name; paths are never made from what is asked for."""
        return {
            path.relative_to(self._folder).as_posix(): path
            for path in self._folder.rglob("*")
            if path.is_file() and path.suffix in TYPES
        }
