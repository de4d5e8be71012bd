"""Signals: channels over time, with their names and frame rate."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import as_floats, as_texts, format_count
from kineme.errors import ParameterError
from kineme.recordings.arrays import as_rate, assign, freeze
from kineme.recordings.column_names import name_column
from kineme.recordings.notebook import draw_channels
from kineme.recordings.provenance import Provenance
from kineme.recordings.recording import Recording, Spans, as_gaps

LARGEST = 1e30
"""Largest absolute value in any unit; squares and sums of such values are finite."""


@dataclass(frozen=True, eq=False, repr=False)
class Signals(Recording):
    """Channels of one recording, sampled at the same times.

    Parameters
    ----------
    values : array_like, shape (frames, channels)
        Finite, in any units; one channel may be a vector. A data frame provides names.
    fps : float
        Frames per second.
    names : sequence of str, optional
        One per channel, unique; by default those of a data frame's columns, else numbers from 1.
    gaps : sequence of (int, int)
        Frames [start, stop) in which nothing was recorded. The values in them have no meaning.
    provenance : Provenance
        Source of the signals, and what was inferred from it.

    Raises
    ------
    ParameterError
        Shapes do not match, no frames or channels, values that are not finite, or gaps that
        are out of order or cover everything.

    Examples
    --------
    >>> signals = Signals([[0.0, 9.8], [0.1, 9.7]], 50, ["x", "y"])
    >>> signals
    <Signals of 2 frames (0.0 s) at 50 Hz: 2 channels>
    >>> signals.select(["y"]).values.tolist()
    [[9.8], [9.7]]
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
        # The default names count from 1.
        columns = getattr(self.values, "columns", range(1, values.shape[1] + 1))
        assign(self, values=freeze(values, "signals"), fps=as_rate(self.fps))
        if (largest := float(np.abs(values).max())) > LARGEST:
            raise ParameterError(
                f"signals reach {largest:.3g}, too large for a sensor: correct the values"
            )
        names = as_texts(self.names, "names of channels") or tuple(map(name_column, columns))
        if len(names) != values.shape[1] or len(set(names)) < len(names):
            raise ParameterError(
                f"names ({', '.join(names)}) for {values.shape[1]} channels: give a different one "
                "for each"
            )
        assign(self, names=names, gaps=as_gaps(self.gaps, len(values)))
        if not self.spans():
            raise ParameterError("the gaps cover the whole recording")

    def __repr__(self) -> str:
        return (
            f"<Signals of {format_count(self.n_frames, 'frame')} ({self.duration:.1f} s) at "
            f"{self.fps:g} Hz: {format_count(self.n_channels, 'channel')}>"
        )

    @property
    def n_frames(self) -> int:
        return len(self.values)

    @property
    def n_channels(self) -> int:
        return len(self.names)

    def select(self, names: Iterable[str]) -> Signals:
        """Return these channels in this order; raise ParameterError for an unknown name."""
        selection = as_texts(names, "names of channels")
        for name in selection:
            if name not in self.names:
                raise ParameterError(f"no channel {name!r}; there are {', '.join(self.names)}")
        at = [self.names.index(name) for name in selection]
        return replace(self, values=self.values[:, at], names=selection)

    def _sliced(self, start: int, stop: int, gaps: Spans, provenance: Provenance) -> Signals:
        return replace(self, values=self.values[start:stop], gaps=gaps, provenance=provenance)

    def _facts(self) -> list[tuple[str, str]]:
        shown = ", ".join(self.names[:8]) + (", …" if self.n_channels > 8 else "")
        return [("channels", f"{self.n_channels}: {shown}")]

    def _picture(self) -> str:
        return draw_channels(self.values)
