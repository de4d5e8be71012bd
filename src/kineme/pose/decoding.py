"""Decode the frames of a video, upright and with their times.

Times come from the container, so they are right for variable frame rates as well. The rotation
flag of phones is applied. Frames with more pixels than estimators can use are scaled down. Only
one frame is in memory at a time.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.checks import require_extra
from kineme._util.files import shorten_error
from kineme.errors import ReadError
from kineme.pose.estimators import Picture

MAX_SIDE = 1280
"""Pixels of the longer side above which a frame is scaled down."""
TRUNCATED_S = 1.0
"""Seconds that may be missing at the end of a video before it counts as truncated."""
USUAL_FPS = 30.0
"""Frame rate of videos whose container does not state one."""


@dataclass(frozen=True)
class Frame:
    """One frame of a video."""

    time: float  # in seconds
    picture: Picture
    scale: float  # pixels of the video per pixel of the picture


class OpenVideo:
    """A video that is open for decoding. `open_video` returns one."""

    def __init__(self, path: Path, container: Any, stream: Any) -> None:
        self._path, self._container, self._stream = path, container, stream

    @property
    def duration(self) -> float:
        """Return the duration of the video stream in seconds; 0 if it is unknown."""
        duration = self._stream.duration
        if duration:
            return float(duration * self._stream.time_base)
        # Matroska states the duration of the whole file only, and sound may be longer.
        has_one_stream = len(self._container.streams) == 1
        return (self._container.duration or 0) / 1_000_000 if has_one_stream else 0.0

    @property
    def start_time(self) -> float:
        """Return the second at which players start: that of the first frame or sound."""
        return (self._container.start_time or 0) / 1_000_000  # from FFmpeg's microseconds

    def find_step(self, rate: float) -> float:
        """Return the shortest time between frames to use, in seconds.

        Every n-th frame is used, with the largest n that leaves at least ``rate`` per second.
        """
        fps = float(self._stream.average_rate or USUAL_FPS)
        n = max(1, int(fps / rate + 0.05))  # so that 24.7 counts as 25, and 24 does not
        return (n - 0.5) / fps  # half a frame less, as times are rounded

    def frames(self, step: float = 0.0, after: float | None = None) -> Iterator[Frame]:
        """Yield frames at least ``step`` seconds apart, from the first one after ``after``.

        Raises ReadError if the video is damaged or ends too early.
        """
        begin = float((self._stream.start_time or 0) * self._stream.time_base)
        used = last = after
        if after is not None:  # seek to the keyframe before it
            self._container.seek(int(after / self._stream.time_base), stream=self._stream)
        for decoded in self._decode():
            last = decoded.time
            if last is None:
                raise ReadError(
                    self._path, "does not state the times of its frames: convert it to .mp4"
                )
            # The seek ends at a keyframe before `after`: `last - used` is negative there.
            if used is None or last - used >= max(step, 1e-6):
                used = last
                yield _convert_frame(decoded)
        if last is None:
            raise ReadError(self._path, "has no frames")
        if self.duration and last - begin < self.duration - TRUNCATED_S:
            raise ReadError(
                self._path,
                f"ends after {last - begin:.1f} s of {self.duration:.1f} s: copy it again",
            )

    def _decode(self) -> Iterator[Any]:
        import av

        try:
            yield from self._container.decode(self._stream)
        except (av.FFmpegError, OSError) as error:
            reason = f"is damaged, its frames cannot be decoded: {_shorten_reason(error)}"
            raise ReadError(self._path, reason) from error


@contextmanager
def open_video(path: Path) -> Iterator[OpenVideo]:
    """Open a video for the block; raise ReadError if it has no video stream or is damaged."""
    with require_extra("av", "video"):
        import av
    try:
        container = av.open(str(path))
    except (av.FFmpegError, OSError) as error:
        reason = f"is not a video, or only part of one: {_shorten_reason(error)}"
        raise ReadError(path, reason) from error
    with container:
        if not container.streams.video:
            sound_only = "is not a video: it has sound but no pictures"
            truncated = "has no pictures: it may be incomplete, so copy it again"
            raise ReadError(path, sound_only if container.streams.audio else truncated)
        stream = container.streams.video[0]
        stream.thread_type = "AUTO"
        yield OpenVideo(path, container, stream)


def _convert_frame(decoded: Any) -> Frame:
    """Return a decoded frame as RGB, upright, and scaled down if it is large."""
    scale = max(1.0, max(decoded.width, decoded.height) / MAX_SIDE)
    size = {"width": round(decoded.width / scale), "height": round(decoded.height / scale)}
    picture = decoded.reformat(format="rgb24", **size).to_ndarray()
    # PyAV's rotation is counterclockwise, as are the quarter turns of numpy.
    rotated = np.rot90(picture, round(decoded.rotation / 90))
    return Frame(float(decoded.time), np.ascontiguousarray(rotated), scale)


def _shorten_reason(error: Exception) -> str:
    """Return FFmpeg's message without its number and the path."""
    return shorten_error(error).split("] ", 1)[-1].split(": '", 1)[0].lower()
