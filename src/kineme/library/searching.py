"""Where recordings are like examples, and not like counter-examples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from typing import NamedTuple

import numpy as np

from kineme._util.arrays import Float32s, Ints
from kineme._util.checks import is_number
from kineme.errors import ParameterError
from kineme.recordings import Motion, Signals
from kineme.transfer.subsequences import Matches, search

REFUSED = 0.5
"""Share of a match that one of a counter-example covers where it takes its place."""


class Named(str):
    """The name of a recording of the library, even where a file is called so."""

    __slots__ = ()


@dataclass(frozen=True)
class Example:
    """A span of a recording that is searched for.

    Parameters
    ----------
    recording : path-like, Motion or Signals
        A file, else the name of a recording of the library, or a recording in hand.
    start_s, stop_s : float, optional
        Seconds; from the beginning and to the end by default.

    Examples
    --------
    >>> Example("walk.bvh", 2.1, 3.4).stop_s
    3.4
    """

    recording: str | PathLike[str] | Motion | Signals
    start_s: float = 0.0
    stop_s: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.recording, str | PathLike | Motion | Signals):
            raise ParameterError(
                f"an example is a file, a name or a recording, not {self.recording!r:.60}"
            )
        stop = np.inf if self.stop_s is None else self.stop_s
        numbers = is_number(self.start_s) and (self.stop_s is None or is_number(stop))
        if not numbers or not 0 <= self.start_s < stop:
            raise ParameterError(
                f"an example lasts from one second to a later one, not from {self.start_s!r:.20} "
                f"to {self.stop_s!r:.20}"
            )


class Hit(NamedTuple):
    """A span of a recording that is like an example.

    Attributes
    ----------
    recording : str
    start_s, stop_s : float
    distance : float
        0 is equal.
    cluster : int
        Of the segment that covers most of it, -1 in none.
    label : str
        The name of that cluster.

    Examples
    --------
    >>> hit = Hit("walk.bvh", 2.0, 3.2, 0.4, 7, "step")
    >>> round(hit.stop_s - hit.start_s, 1), hit.label
    (1.2, 'step')
    """

    recording: str
    start_s: float
    stop_s: float
    distance: float
    cluster: int
    label: str


def spans_like(
    features: Float32s,
    examples: Sequence[Float32s],
    counterexamples: Sequence[Float32s],
    *,
    threshold: float,
    top: int | None,
) -> Matches:
    """Spans of a recording that are like one of the examples, apart from each other.

    A span goes that is more like a counter-example.
    """
    found = _union(features, examples, threshold, None if counterexamples else top)
    if counterexamples and len(found.starts):
        others = _union(features, counterexamples, threshold, None)
        first = np.maximum(found.starts[:, None], others.starts[None])
        shared = np.minimum(found.stops[:, None], others.stops[None]) - first
        covers = shared >= REFUSED * (found.stops - found.starts)[:, None]
        nearer = others.distances[None] < found.distances[:, None]
        rows = np.flatnonzero(~(covers & nearer).any(axis=1))
        found = _select_rows(found, rows)
    return _select_rows(found, slice(top))


def best(
    found: Sequence[Matches], *, top: int | None, most: int | None
) -> list[tuple[int, tuple[int, int, float]]]:
    """Which recording, and start, stop and distance, of the nearest spans; ``most`` of each."""
    spans = [
        (distance, i, start, stop)
        for i, each in enumerate(found)
        for start, stop, distance in zip(*(column[:most].tolist() for column in each), strict=True)
    ]
    return [(i, (start, stop, distance)) for distance, i, start, stop in sorted(spans)[:top]]


def _union(
    features: Float32s, examples: Sequence[Float32s], threshold: float, top: int | None
) -> Matches:
    """Return the spans that are like any of the examples, apart from each other, the best first."""
    found = [search(example, features, threshold=threshold, top=top) for example in examples]
    if len(found) == 1:
        return found[0]
    starts, stops, distances = (np.concatenate(column) for column in zip(*found, strict=True))
    covered = np.zeros(len(features), np.bool_)
    chosen = []
    for i in np.lexsort((starts, distances)).tolist():
        span = slice(starts[i], stops[i])
        if not covered[span].any():
            covered[span] = True
            chosen.append(i)
    return Matches(starts[chosen], stops[chosen], distances[chosen])


def _select_rows(found: Matches, rows: slice | Ints) -> Matches:
    return Matches(found.starts[rows], found.stops[rows], found.distances[rows])
