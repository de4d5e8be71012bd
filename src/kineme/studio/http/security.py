"""Access control: accept requests only with the token, from this server's own pages, in time.

The server listens on this machine only. That keeps out other machines, but neither other pages in
the same browser nor foreign host names that resolve to this machine. So a request must name this
server as its host and must not come from a page of another origin. Everything except the page's own
files needs the token, which is only in the printed address. Responses may not be stored, framed,
sniffed or mixed with content from elsewhere. Connections without a complete request are closed, so
that nobody can hold them all open.
"""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import MutableMapping
from typing import Any
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import Request
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.auto import AutoHTTPProtocol

TOKEN_HEADER = "x-kineme-token"  # noqa: S105 (a header's name)
TOKEN_IN_URL = ("/", "/api/events")
"""Paths that accept the token in the URL."""
VIDEO = "/video"
"""Path suffix that accepts the token in the URL, like `TOKEN_IN_URL`: browsers send no headers for
these.
"""
TRUSTED = "kineme.trusted"
"""Key of the ASGI scope: whether the request carries the token."""
DEVELOPMENT = "http://127.0.0.1:5173"
"""Origin at which ``npm run dev`` serves the pages from their sources."""

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
"""Security headers of every response."""
HEADER_TIMEOUT_S = 20.0
"""Time to receive all headers of a request, from their first byte."""


def make_token() -> str:
    """Return a random token that cannot be guessed."""
    return secrets.token_urlsafe(24)


class Guard:
    """Wrap an application with these checks; ``development`` also accepts the Vite server."""

    def __init__(self, app: ASGIApp, *, token: str, port: int, development: bool = False):
        self._app = app
        self._token = token.encode()
        hosts = [f"{name}:{port}" for name in ("127.0.0.1", "localhost")]
        self._origins = {f"http://{host}" for host in hosts}
        if development:
            self._origins.add(DEVELOPMENT)
        self._hosts = {*hosts, "127.0.0.1", "localhost"} if port == 80 else {*hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it with status 403."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers[name] = value
                # The browser may cache page files if it checks for newer ones each time.
                is_page = not scope["path"].startswith("/api")
                headers.setdefault("cache-control", "no-cache" if is_page else "no-store")
            await send(message)

        scope[TRUSTED] = scope["type"] == "http" and self._has_token(scope, Headers(scope=scope))
        refusal = self._find_refusal(scope)
        if refusal is None:
            await self._app(scope, receive, send_with_headers)
        else:
            response = JSONResponse({"error": refusal}, status_code=403)
            await response(scope, receive, send_with_headers)

    def _find_refusal(self, scope: MutableMapping[str, Any]) -> str | None:
        """Return why a request is refused; None if it is allowed."""
        if scope["type"] != "http":
            return "only plain HTTP is supported"
        headers = Headers(scope=scope)
        # Exactly one host header, with a name of this server.
        if headers.getlist("host") not in [[host] for host in self._hosts]:
            return "this server can only be reached as 127.0.0.1 or localhost"
        if not {*headers.getlist("origin")} <= self._origins:
            return "pages of other origins may not use this server"
        if headers.get("sec-fetch-site") == "cross-site" and scope["path"] != "/":
            return "pages of other sites may not use this server"
        if scope["path"].startswith("/api") and not scope[TRUSTED]:
            return "the token is missing or wrong: use the address that kineme printed"
        return None

    def _has_token(self, scope: MutableMapping[str, Any], headers: Headers) -> bool:
        token = headers.get(TOKEN_HEADER)
        path = scope["path"]
        if token is None and (path in TOKEN_IN_URL or path.endswith(VIDEO)):
            token = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        # Compare in constant time, so that the duration does not reveal a partial match.
        return token is not None and secrets.compare_digest(token.encode(), self._token)


def is_trusted(request: Request) -> bool:
    """Return whether a request that passed the guard carries the token."""
    return bool(request.scope[TRUSTED])


class HeaderTimeoutProtocol(AutoHTTPProtocol):  # type: ignore[misc, valid-type]  # one of two classes
    """HTTP protocol of uvicorn that closes connections whose request headers are late."""

    _late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Start the timer: a new connection must send a request."""
        super().connection_made(transport)
        self._start_timer()

    def data_received(self, data: bytes) -> None:
        """Start the timer at the first byte of a request; stop it once the headers are complete."""
        if self._timer is None and self._is_idle():
            self._start_timer()
        super().data_received(data)
        if not self._is_idle():
            self._stop_timer()

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop_timer()
        super().connection_lost(exc)

    def _is_idle(self) -> bool:
        """Return whether no request is being answered."""
        return self.cycle is None or self.cycle.response_complete

    def _start_timer(self) -> None:
        self._timer = self.loop.call_later(HEADER_TIMEOUT_S, self._close_if_idle)

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _close_if_idle(self) -> None:
        self._timer = None
        if self._is_idle() and not self.transport.is_closing():
            self.transport.close()
