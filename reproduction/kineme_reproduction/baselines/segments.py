"""Segments, which every method of this folder returns, and those of uniform cuts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kineme._util.arrays import Ints
from kineme.errors import ParameterError


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


def cut_uniformly(n_frames: int, *, fps: float, seconds: float) -> Segments:
    """Cut at regular intervals, each at the nearest frame; find no clusters.

    Raises
    ------
    ParameterError
        The cuts would be less than a frame apart.
    """
    step = seconds * fps
    if not step >= 1:
        raise ParameterError(
            f"cuts every {seconds:g} s are less than a frame apart at {fps:g} fps: use at least "
            f"{1 / fps:.4g} s"
        )
    cuts = np.rint(np.arange(1, int(n_frames / step) + 2) * step).astype(np.int64)
    return unclustered(cuts[cuts < n_frames], n_frames)
