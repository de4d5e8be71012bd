"""What requests send, read no farther than they may be long, and no longer than it comes."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

from starlette.requests import Request

from kineme.studio.http.uploads import TooLargeError

SLOWEST = 60.0
"""Seconds between two pieces of a request."""
MOST_JSON = 1_000_000
"""Bytes of a request that is no upload."""


class TooSlowError(Exception):
    """A request of which nothing more came."""


async def chunks(request: Request) -> AsyncIterator[bytes]:
    """What is sent, piece by piece; TooSlowError where the next one does not come."""
    sent = request.stream()
    while True:
        try:
            async with asyncio.timeout(SLOWEST):
                chunk = await anext(sent)
        except StopAsyncIteration:
            return
        except TimeoutError:
            raise TooSlowError(f"nothing came for {SLOWEST:g} s: send it again") from None
        yield chunk


async def body(request: Request) -> bytes:
    """What was sent, which is read no farther than a request may be long."""
    sent = bytearray()
    async for chunk in chunks(request):
        sent += chunk
        if len(sent) > MOST_JSON:
            raise TooLargeError(f"a request has at most {MOST_JSON} bytes")
    return bytes(sent)
