"""News for every open page: which table has changed, which file has come."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator
from contextlib import suppress

from kineme.web.encoding import to_json
from kineme.web.messages import Changed

HEARTBEAT = 15.0  # seconds; without it nobody would notice a line that is dead
LONGEST = 256
"""News that wait for a page; one that takes none for so long is asleep and asks anew later."""


class Hub:
    """Where news come in, from any thread, and go out to the pages."""

    def __init__(self) -> None:
        self._loop: asyncio.AbstractEventLoop | None = None
        self._pages: set[asyncio.Queue[Changed | None]] = set()
        self._closed = False
        self.listened = threading.Event()
        """Set once a page listens, which it does when it has listed the recordings."""

    def tell(self, recording: str, revision: int) -> None:
        """Send every page the revision of a recording's table; 0: the recording is new."""
        if self._loop is not None:
            news = Changed(recording=recording, revision=revision)
            with suppress(RuntimeError):  # the server has ended
                self._loop.call_soon_threadsafe(self._spread, news)

    def close(self) -> None:
        """End every stream, so that the server can."""
        self._closed = True
        self._spread(None)

    async def stream(self) -> AsyncIterator[str]:
        """Yield the news as ``text/event-stream``."""
        self._loop = asyncio.get_running_loop()
        queue: asyncio.Queue[Changed | None] = asyncio.Queue(LONGEST)
        self._pages.add(queue)
        self.listened.set()
        try:
            yield ": welcome\n\n"
            while not self._closed:
                try:
                    news = await asyncio.wait_for(queue.get(), HEARTBEAT)
                except TimeoutError:
                    yield ": still here\n\n"
                    continue
                if news is None:
                    return
                yield f"data: {to_json(news).decode()}\n\n"
        finally:
            self._pages.discard(queue)

    def _spread(self, news: Changed | None) -> None:
        for queue in self._pages:
            with suppress(asyncio.QueueFull):
                queue.put_nowait(news)
