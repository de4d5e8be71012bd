"""Who may ask: pages of this very server, and whoever holds its token.

The server listens on this machine only. That keeps other machines out, but not
other pages in the same browser, nor names of other hosts made to point here.
So a request must name this server as its host, must not come from the page of
another origin, and, for anything but the page's own files, must carry the
token, which only the address printed at the start has. What is answered is
never stored, framed, sniffed or mixed with anything from elsewhere.
"""

from __future__ import annotations

import secrets
from collections.abc import MutableMapping
from typing import Any
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import Request
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

TOKEN_HEADER = "x-kineme-token"  # noqa: S105 (a header's name)
IN_ADDRESS = ("/", "/api/events")
VIDEO = "/video"
"""Paths that take the token in their address: browsers send no headers for these."""
TRUSTED = "kineme.trusted"

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "font-src 'self'; media-src 'self'; connect-src 'self'; worker-src 'self' blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "content-security-policy": POLICY,
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), geolocation=(), microphone=()",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
}


def new_token() -> str:
    """A token that cannot be guessed."""
    return secrets.token_urlsafe(24)


class Guard:
    """An application behind these rules.

    Parameters
    ----------
    app : ASGIApp
    token : str
        What requests must carry.
    port : int
        The server's own.
    """

    def __init__(self, app: ASGIApp, *, token: str, port: int):
        self._app = app
        self._token = token.encode()
        hosts = [f"{name}:{port}" for name in ("127.0.0.1", "localhost")]
        self._origins = {f"http://{host}" for host in hosts}
        self._hosts = {*hosts, "127.0.0.1", "localhost"} if port == 80 else {*hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers[name] = value
                # The page's own files may be kept, if the browser asks each time for newer ones.
                own = not scope["path"].startswith("/api")
                headers.setdefault("cache-control", "no-cache" if own else "no-store")
            await send(message)

        scope[TRUSTED] = scope["type"] == "http" and self._knows(scope, Headers(scope=scope))
        refusal = self._refusal(scope)
        if refusal is None:
            await self._app(scope, receive, send_with_headers)
        else:
            answer = JSONResponse({"error": refusal}, status_code=403)
            await answer(scope, receive, send_with_headers)

    def _refusal(self, scope: MutableMapping[str, Any]) -> str | None:
        """Why a request is refused, if it is."""
        if scope["type"] != "http":
            return "only plain HTTP is spoken here"
        headers = Headers(scope=scope)
        if headers.getlist("host") not in [[host] for host in self._hosts]:
            return "this server answers to 127.0.0.1 and localhost only"
        if not {*headers.getlist("origin")} <= self._origins:
            return "pages of other origins may not ask this server"
        if headers.get("sec-fetch-site") == "cross-site" and scope["path"] != "/":
            return "pages of other sites may not ask this server"
        if scope["path"].startswith("/api") and not scope[TRUSTED]:
            return "the token is missing or wrong: use the address that kineme studio printed"
        return None

    def _knows(self, scope: MutableMapping[str, Any], headers: Headers) -> bool:
        given = headers.get(TOKEN_HEADER)
        path = scope["path"]
        if given is None and (path in IN_ADDRESS or path.endswith(VIDEO)):
            given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        return given is not None and secrets.compare_digest(given.encode(), self._token)


def is_trusted(request: Request) -> bool:
    """Whether a request that has passed the guard carries the token."""
    return bool(request.scope[TRUSTED])
