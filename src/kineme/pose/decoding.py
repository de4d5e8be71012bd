"""Frames of a video, upright and with their times, one after the other.

Times are those that the container gives to its frames, so they are right at variable frame rates,
too. A rotation that a phone notes beside the frames is applied. Larger pictures than an estimator
can use are made smaller. Nothing but one frame at a time is held in memory.
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

LONGEST_SIDE = 1280
"""Pixels of a picture, which is made smaller where it has more."""
SHORTEST_STEP_S = 0.025
"""Seconds between frames that are taken: of 50 and 60 frames a second each second one."""
MISSING_S = 1.0
"""Seconds by which the frames may end before the video does, else it broke off."""


@dataclass(frozen=True)
class Frame:
    """A picture of a video."""

    time: float  # in seconds
    picture: Picture
    scale: float  # pixels of the video in one of the picture


class OpenVideo:
    """A video whose frames can be decoded; `open_video` opens it."""

    def __init__(self, path: Path, container: Any, stream: Any) -> None:
        self._path, self._container, self._stream = path, container, stream

    @property
    def duration(self) -> float:
        """Return the length of the pictures in seconds; 0 where the video does not tell it."""
        told = self._stream.duration
        if told:
            return float(told * self._stream.time_base)
        # Matroska tells that of all; sound may go on for longer than the pictures.
        alone = len(self._container.streams) == 1
        return (self._container.duration or 0) / 1_000_000 if alone else 0.0

    @property
    def begins(self) -> float:
        """Return the time at which players begin: that of the first picture or sound."""
        return (self._container.start_time or 0) / 1_000_000  # in FFmpeg's microseconds

    def frames(self, after: float | None = None) -> Iterator[Frame]:
        """Yield the frames after a time; ReadError where the video ends too early.

        Frames that follow the one before by less than `SHORTEST_STEP_S` are left out.
        """
        begin = float((self._stream.start_time or 0) * self._stream.time_base)
        last = after
        if after is not None:  # back to the frame from which the one after it can be decoded
            self._container.seek(int(after / self._stream.time_base), stream=self._stream)
        for decoded in self._decoded():
            time = decoded.time
            if time is None:
                raise ReadError(self._path, "does not tell the times of its frames: convert it")
            if last is None or time - last >= SHORTEST_STEP_S - 1e-6:
                last = time
                yield _upright(decoded)
        if last is None:
            raise ReadError(self._path, "holds no frames")
        if self.duration and last - begin < self.duration - MISSING_S:
            raise ReadError(
                self._path,
                f"breaks off after {last - begin:.1f} s of {self.duration:.1f} s: copy it again",
            )

    def _decoded(self) -> Iterator[Any]:
        import av

        try:
            yield from self._container.decode(self._stream)
        except (av.FFmpegError, OSError) as error:
            reason = f"is damaged, its frames cannot be decoded: {_reason(error)}"
            raise ReadError(self._path, reason) from error


@contextmanager
def open_video(path: Path) -> Iterator[OpenVideo]:
    """Open a video as long as the block; ReadError where it holds no pictures or is damaged."""
    with require_extra("av", "video"):
        import av
    try:
        container = av.open(str(path))
    except (av.FFmpegError, OSError) as error:
        reason = f"is no video, or only a part of one: {_reason(error)}"
        raise ReadError(path, reason) from error
    with container:
        if not container.streams.video:
            sound = "is no video: it holds sound, but no pictures"
            lost = "holds no pictures: it may be a part of a video only, so copy it again"
            raise ReadError(path, sound if container.streams.audio else lost)
        stream = container.streams.video[0]
        stream.thread_type = "AUTO"
        yield OpenVideo(path, container, stream)


def _upright(decoded: Any) -> Frame:
    scale = max(1.0, max(decoded.width, decoded.height) / LONGEST_SIDE)
    size = {"width": round(decoded.width / scale), "height": round(decoded.height / scale)}
    picture = decoded.reformat(format="rgb24", **size).to_ndarray()
    # The rotation is counterclockwise, and so are the quarter turns of numpy.
    turned = np.rot90(picture, round(decoded.rotation / 90))
    return Frame(float(decoded.time), np.ascontiguousarray(turned), scale)


def _reason(error: Exception) -> str:
    """Return what FFmpeg says without its number and the path, which are no help."""
    return shorten_error(error).split("] ", 1)[-1].split(": '", 1)[0].lower()
