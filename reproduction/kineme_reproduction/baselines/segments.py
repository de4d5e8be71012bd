"""Segments: what every method of this folder returns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Segments:
    """A recording in consecutive segments, each in a cluster.

    Segment i is the span ``[starts[i], stops[i])``, in frames of the array the
    method was given.

    Parameters
    ----------
    cuts : ndarray
        First frames of all segments but the first, ascending.
    clusters : ndarray
        One number per segment, so one more than cuts; equal numbers are equal movements. A method
        that finds no clusters numbers the segments.
    n_frames : int
        Length of the recording.
    objective : float, optional
        What the method minimised, nan where it minimises nothing.
    """

    cuts: Ints
    clusters: Ints
    n_frames: int
    objective: float = float("nan")

    @property
    def starts(self) -> Ints:
        """First frame of each segment."""
        return np.concatenate([[0], self.cuts])

    @property
    def stops(self) -> Ints:
        """One past the last frame of each segment."""
        return np.concatenate([self.cuts, [self.n_frames]])

    def per_frame(self) -> Ints:
        """The cluster of every frame."""
        return np.repeat(self.clusters, self.stops - self.starts)


def unclustered(cuts: list[int] | Ints, n_frames: int) -> Segments:
    """Make segments from cuts only: each is its own cluster."""
    return Segments(np.asarray(cuts, np.int64), np.arange(len(cuts) + 1), n_frames)
