"""Page for ``kineme live``: shows a stream while it is recorded, on this machine only."""

from __future__ import annotations

import asyncio
import threading
import webbrowser
from collections import deque
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from time import monotonic, sleep
from typing import Any

import numpy as np
import uvicorn
from numpy.typing import NDArray
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, StreamingResponse
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from kineme.studio.http.security import Guard, make_token
from kineme.studio.server import HOST, SHUTDOWN_S, make_server_config, open_socket
from kineme.web import STATIC
from kineme.web.encoding import to_json
from kineme.web.live_messages import LiveEvent, LiveHead, LiveUpdate

UPDATE_S = 0.2
"""Time between two updates of a page."""
CURVE_FPS = 25.0
"""Samples per second of the curves."""
MAX_CURVES = 6
"""The page draws the first channels only."""
CURVES_S = 20.0
"""Length of the curves that a page gets when it is opened."""
MAX_EVENTS = 5000
"""Events sent to a page that is opened late; about an hour."""
EVENT_DEFAULTS = {
    "start_s": 0.0, "stop_s": 0.0, "cluster": -1, "label": "",
    "number": 0, "repetitions": 0, "text": "",
}  # fmt: skip
"""Values of fields that an event does not have."""


class LivePage:
    """State of a stream for open pages: its recent events and frames.

    ``channels`` are empty for a body, which has ``parents`` of its joints instead.
    """

    def __init__(self, fps: float, channels: Sequence[str], parents: Sequence[int] = ()) -> None:
        self._fps, self._step = fps, max(1, round(fps / CURVE_FPS))
        self._head = LiveHead(
            channels=list(channels[:MAX_CURVES]),
            sample_fps=fps / self._step,
            bones=[(parent, joint) for joint, parent in enumerate(parents) if parent >= 0],
        )
        self.n_frames = 0
        self.has_ended = self.is_closed = False
        self._n_events = self._n_samples = 0
        self._events: deque[LiveEvent] = deque(maxlen=MAX_EVENTS)
        self._samples: deque[list[float | None]] = deque(maxlen=round(CURVES_S * CURVE_FPS))
        self._pose: list[float | None] = []
        self._last_frame_s, self._silent_s = monotonic(), 0.0
        self._lock = threading.Lock()

    def add(self, events: Sequence[dict[str, Any]], first: int, frames: NDArray[Any]) -> None:
        """Add events (as in JSON) and frames; ``first`` is the index of the first frame."""
        with self._lock:
            self._events += [LiveEvent(**{**EVENT_DEFAULTS, **event}) for event in events]
            self._n_events += len(events)
            self._last_frame_s = monotonic() if len(frames) else self._last_frame_s
            self._silent_s = monotonic() - self._last_frame_s
            if not len(frames):
                return
            if first > self.n_frames:  # frames are missing in between
                self._samples.clear()
            self.n_frames = first + len(frames)
            # Every step-th frame of the stream, wherever these frames begin.
            sampled = frames[-first % self._step :: self._step]
            self._n_samples = -(-self.n_frames // self._step)
            if not self._head.bones:
                self._samples += sampled[:, :MAX_CURVES].tolist()
            elif np.isfinite(frames[-1]).any():
                self._pose = _project_pose(frames[-1].reshape(-1, 3)).ravel().tolist()

    async def stream(self) -> AsyncIterator[str]:
        """Yield updates as ``text/event-stream``."""
        n_events, n_samples = 0, -1
        while not self.is_closed:
            update, n_events, n_samples = self._update(n_events, n_samples)
            yield f"data: {to_json(update).decode()}\n\n"
            await asyncio.sleep(UPDATE_S)

    def _update(self, n_events: int, n_samples: int) -> tuple[LiveUpdate, int, int]:
        """Return what is new since these counts of events and samples, and the present counts."""
        with self._lock:
            n_samples_kept = len(self._samples)
            n_new = min(self._n_samples - max(n_samples, 0), n_samples_kept)
            update = LiveUpdate(
                head=self._head if n_samples < 0 else None,
                now_s=self.n_frames / self._fps,
                silent_s=self._silent_s,
                has_ended=self.has_ended,
                events=_get_last(self._events, self._n_events - n_events),
                first_s=(self._n_samples - n_new) * self._step / self._fps,
                samples=_get_last(self._samples, n_new),
                pose=self._pose,
            )
            return update, self._n_events, self._n_samples


def _get_last(items: deque[Any], n: int) -> list[Any]:
    """Return the last ``n`` items of a deque."""
    return list(islice(items, max(len(items) - n, 0), None))


def _project_pose(pose: NDArray[Any]) -> NDArray[Any]:
    """Return a pose (joints, 2) seen from half left: right and up, centred."""
    # Rotate by 45 degrees about the vertical axis.
    right = (pose[:, 0] - pose[:, 2]) / np.sqrt(2)
    return np.round(np.column_stack([right - np.nanmean(right), pose[:, 1]]), 3)


@contextmanager
def serve_page(page: LivePage, announce: Callable[[str], None]) -> Iterator[None]:
    """Serve a page from a thread and open it in the browser."""

    async def show(_: Request) -> FileResponse:
        return FileResponse(STATIC / "live.html")

    async def tell(_: Request) -> StreamingResponse:
        return StreamingResponse(page.stream(), media_type="text/event-stream")

    with open_socket(0) as server_socket:
        token, port = make_token(), server_socket.getsockname()[1]
        assets = StaticFiles(directory=STATIC / "assets")
        routes = [Route("/", show), Route("/api/events", tell), Mount("/assets", assets)]
        server = uvicorn.Server(
            make_server_config(Guard(Starlette(routes=routes), token=token, port=port))
        )
        thread = threading.Thread(target=server.run, args=[[server_socket]], daemon=True)
        thread.start()
        address = f"http://{HOST}:{port}/?token={token}"
        announce(address)
        threading.Thread(target=webbrowser.open, args=[address], daemon=True).start()
        try:
            yield
        finally:
            sleep(2 * UPDATE_S)  # let pages receive the last update
            page.is_closed = server.should_exit = True
            thread.join(SHUTDOWN_S + 1)
