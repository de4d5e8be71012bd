"""Server-sent events: tell every open page which table has changed and which file was added."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator
from contextlib import suppress

from kineme.web.encoding import to_json
from kineme.web.messages import Changed

HEARTBEAT_S = 15.0
"""Time between two keep-alive comments, which reveal a dead connection."""
MAX_QUEUE = 256
"""Events queued for a page; a page that falls further behind reloads its state later."""


class Hub:
    """Take events from any thread and send them to all pages."""

    def __init__(self) -> None:
        self._loop: asyncio.AbstractEventLoop | None = None
        self._pages: set[asyncio.Queue[Changed | None]] = set()
        self._closed = False
        self.has_listener = threading.Event()
        """Set once a page listens, which is after it has listed the recordings."""

    def tell(self, recording: str, revision: int) -> None:
        """Send every page the new revision of a table; 0 means that the recording is new."""
        if self._loop is not None:
            event = Changed(recording=recording, revision=revision)
            with suppress(RuntimeError):  # the server has ended
                self._loop.call_soon_threadsafe(self._broadcast, event)

    def close(self) -> None:
        """End every stream, so that the server can shut down."""
        self._closed = True
        self._broadcast(None)

    async def stream(self) -> AsyncIterator[str]:
        """Yield the events as ``text/event-stream``."""
        self._loop = asyncio.get_running_loop()
        queue: asyncio.Queue[Changed | None] = asyncio.Queue(MAX_QUEUE)
        self._pages.add(queue)
        self.has_listener.set()
        try:
            yield ": welcome\n\n"
            while not self._closed:
                try:
                    event = await asyncio.wait_for(queue.get(), HEARTBEAT_S)
                except TimeoutError:
                    yield ": still here\n\n"
                    continue
                if event is None:
                    return
                yield f"data: {to_json(event).decode()}\n\n"
        finally:
            self._pages.discard(queue)

    def _broadcast(self, event: Changed | None) -> None:
        for queue in self._pages:
            with suppress(asyncio.QueueFull):
                queue.put_nowait(event)
