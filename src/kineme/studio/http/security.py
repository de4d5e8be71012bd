"""Who may ask: pages of this very server, whoever holds its token, and who asks in time.

The server listens on this machine only. That keeps other machines out, but not
other pages in the same browser, nor names of other hosts made to point here.
So a request must name this server as its host, must not come from the page of
another origin, and, for anything but the page's own files, must carry the
token, which only the address printed at the start has. What is answered is
never stored, framed, sniffed or mixed with anything from elsewhere. Connections
on which no whole request comes are closed, so that nobody can hold them all open.
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
IN_ADDRESS = ("/", "/api/events")
VIDEO = "/video"
"""Paths that take the token in their address: browsers send no headers for these."""
TRUSTED = "kineme.trusted"
DEVELOPMENT = "http://127.0.0.1:5173"
"""Where ``npm run dev`` serves the pages from their sources."""

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
WITHIN = 20.0
"""Seconds in which the headers of a request are there once the first of their bytes is."""


def make_token() -> str:
    """Return a token that cannot be guessed."""
    return secrets.token_urlsafe(24)


class Guard:
    """An application behind these rules; in ``development`` its server may ask, too."""

    def __init__(self, app: ASGIApp, *, token: str, port: int, development: bool = False):
        self._app = app
        self._token = token.encode()
        hosts = [f"{name}:{port}" for name in ("127.0.0.1", "localhost")]
        self._origins = {f"http://{host}" for host in hosts}
        if development:
            self._origins.add(DEVELOPMENT)
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
                # The page's page files may be kept, if the browser asks each time for newer ones.
                page = not scope["path"].startswith("/api")
                headers.setdefault("cache-control", "no-cache" if page else "no-store")
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
        # Exactly one host header, with a name of this server.
        if headers.getlist("host") not in [[host] for host in self._hosts]:
            return "this server answers to 127.0.0.1 and localhost only"
        if not {*headers.getlist("origin")} <= self._origins:
            return "pages of other origins may not ask this server"
        if headers.get("sec-fetch-site") == "cross-site" and scope["path"] != "/":
            return "pages of other sites may not ask this server"
        if scope["path"].startswith("/api") and not scope[TRUSTED]:
            return "the token is missing or wrong: use the address that kineme printed"
        return None

    def _knows(self, scope: MutableMapping[str, Any], headers: Headers) -> bool:
        token = headers.get(TOKEN_HEADER)
        path = scope["path"]
        if token is None and (path in IN_ADDRESS or path.endswith(VIDEO)):
            token = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        # The comparison takes as long for a wrong token as for one that is nearly right.
        return token is not None and secrets.compare_digest(token.encode(), self._token)


def is_trusted(request: Request) -> bool:
    """Return whether a request that has passed the guard carries the token."""
    return bool(request.scope[TRUSTED])


class HeadersInTime(AutoHTTPProtocol):  # type: ignore[misc, valid-type]  # one of two classes
    """HTTP as uvicorn speaks it, whose requests have begun only for so long."""

    _late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """A new connection has to send a request, too."""
        super().connection_made(transport)
        self._wait()

    def data_received(self, data: bytes) -> None:
        """More of a request; body and answer of one with whole headers take their time."""
        if self._late is None and self._is_idle():
            self._wait()
        super().data_received(data)
        if not self._is_idle():
            self._stop_waiting()

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop_waiting()
        super().connection_lost(exc)

    def _is_idle(self) -> bool:
        """Return whether no request is being answered."""
        return self.cycle is None or self.cycle.response_complete

    def _wait(self) -> None:
        self._late = self.loop.call_later(WITHIN, self._close)

    def _stop_waiting(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _close(self) -> None:
        self._late = None
        if self._is_idle() and not self.transport.is_closing():
            self.transport.close()
