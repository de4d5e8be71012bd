"""Signals: channels over time, with their names and frame rate."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from kineme._checks import as_floats, as_spans, as_texts, is_number
from kineme.errors import ParameterError
from kineme.recordings.motion import Provenance

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Signals:
    """Channels of one recording, taken at the same times.

    Parameters
    ----------
    values : (frames, channels), finite, in any units
    fps : frames per second
    names : one per channel, unique; numbers from 1 by default
    gaps : stretches [start, stop) in which nothing was recorded, whatever the values there
    provenance : Provenance

    Raises
    ------
    ParameterError : shapes disagree, no frames or channels, values that are not finite
    """

    values: Floats
    fps: float
    names: Sequence[str] = ()
    gaps: Sequence[tuple[int, int]] = ()
    provenance: Provenance = field(default_factory=Provenance)

    def __post_init__(self) -> None:
        values = np.array(as_floats(self.values, "signals"))
        if values.ndim == 1:
            values = values[:, None]
        if values.ndim != 2 or 0 in values.shape:
            raise ParameterError(f"signals are frames x channels, not of shape {values.shape}")
        if not np.isfinite(values).all():
            frame = int(np.argmin(np.isfinite(values).all(axis=1)))
            raise ParameterError(f"signals hold a value that is not finite, first in frame {frame}")
        if not (is_number(self.fps) and self.fps > 0):
            raise ParameterError(f"the frame rate is {self.fps!r}: it must be a positive number")
        names = as_texts(self.names, "names of channels") or tuple(
            str(i) for i in range(1, values.shape[1] + 1)
        )
        if len(names) != values.shape[1] or len(set(names)) < len(names):
            raise ParameterError(
                f"{values.shape[1]} channels need as many different names, not {', '.join(names)}"
            )
        values.flags.writeable = False
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "fps", float(self.fps))
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "gaps", _checked(self.gaps, len(values)))

    @property
    def n_frames(self) -> int:
        return len(self.values)

    @property
    def n_channels(self) -> int:
        return len(self.names)

    @property
    def duration(self) -> float:
        """Seconds: frames / fps."""
        return self.n_frames / self.fps

    def select(self, names: Iterable[str]) -> Signals:
        """Some of the channels, in the order given; ParameterError if one is not there."""
        wanted = list(names)
        for name in wanted:
            if name not in self.names:
                raise ParameterError(f"no channel {name!r}; there are {', '.join(self.names)}")
        at = [self.names.index(name) for name in wanted]
        return replace(self, values=self.values[:, at], names=wanted)

    def noted(self, *sentences: str) -> Signals:
        """The same with sentences added to the provenance."""
        return replace(self, provenance=self.provenance.noted(*sentences))

    def stretches(self) -> list[tuple[int, int]]:
        """What the gaps leave of the recording: frames [start, stop)."""
        starts = [0, *(stop for _, stop in self.gaps)]
        stops = [*(start for start, _ in self.gaps), self.n_frames]
        return [(a, b) for a, b in zip(starts, stops, strict=True) if a < b]


def _checked(gaps: Sequence[tuple[int, int]], n_frames: int) -> tuple[tuple[int, int], ...]:
    found = as_spans(gaps)
    borders = [0, *(frame for gap in found for frame in gap), n_frames]
    if sorted(borders) != borders or any(start == stop for start, stop in found):
        raise ParameterError(f"gaps must be stretches in time order inside {n_frames} frames")
    if sum(stop - start for start, stop in found) == n_frames:
        raise ParameterError("the gaps leave nothing of the recording")
    return found
