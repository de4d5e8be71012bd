"""Validate the arrays and fields of recordings, and convert between masks and spans of frames."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.checks import as_floats, is_number
from kineme.errors import MotionError, ParameterError

SLOWEST, FASTEST = 1e-9, 1e9
"""Limits of a frame rate, frames per second: one in thirty years; an oscilloscope's."""

Error = type[ParameterError | MotionError]


def freeze(
    values: ArrayLike, what: str, *, row: str = "frame", error: Error = ParameterError
) -> NDArray[np.float64]:
    """Return the values as a read-only view: float64, C-contiguous, finite.

    Raise ``error`` if they are not finite numbers.

    A contiguous float64 array is not copied. ``what`` names the values in messages, ``row`` the
    items along their first axis.
    """
    # A view, so that the caller's own array stays writable.
    array = np.ascontiguousarray(as_floats(values, what, error=error)).view()
    finite = np.isfinite(array)
    if not finite.all():
        reason = f"{what} hold values that are not finite (NaN or infinite)"
        if array.ndim:
            # The first row in which not all values are finite: `argmin` finds the first False.
            first = int(np.argmin(finite.reshape(len(array), -1).all(axis=1)))
            reason += f", first in {row} {first}"
        raise error(reason)
    array.flags.writeable = False
    return array


def as_rate(fps: object, *, error: Error = ParameterError) -> float:
    """Return the frame rate as a float; raise ``error`` unless it is one positive number."""
    if not (is_number(fps) and fps > 0):  # type: ignore[operator]
        raise error(f"the frame rate is {fps!r:.60}: it must be a positive number")
    if not SLOWEST <= fps <= FASTEST:  # type: ignore[operator]
        raise error(
            f"the frame rate is {fps:g} Hz, which is too high or too low: give frames per second"
        )
    return float(fps)  # type: ignore[arg-type]


def assign(instance: object, **values: object) -> None:
    """Set fields of a frozen dataclass in its ``__post_init__``."""
    for name, value in values.items():
        # A frozen dataclass refuses plain assignment.
        object.__setattr__(instance, name, value)


def find_spans(mask: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return the half-open spans (spans, 2) in which the mask is true.

    Examples
    --------
    >>> find_spans(np.array([True, False, True, True])).tolist()
    [[0, 1], [2, 4]]
    """
    # False at both ends closes every span; changes then come in pairs of start and stop.
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return edges.reshape(-1, 2)


def list_spans(mask: NDArray[np.bool_]) -> tuple[tuple[int, int], ...]:
    """Return the result of `find_spans` as pairs of numbers."""
    return tuple((start, stop) for start, stop in find_spans(mask).tolist())


def mark_spans(spans: Iterable[tuple[int, int]], n: int) -> NDArray[np.bool_]:
    """Return a mask (n,) of the frames inside any of the spans [start, stop)."""
    inside = np.zeros(n, np.bool_)
    for start, stop in spans:
        inside[start:stop] = True
    return inside


def to_samples(span: tuple[float, float], fps: float, n_samples: int) -> tuple[int, int]:
    """Return the samples [first, stop) of a span in seconds, at least one.

    For a span in frames, ``fps`` is the number of samples per frame.

    Examples
    --------
    >>> to_samples((0.5, 0.9), 30, 20), to_samples((100, 200), 0.25, 40)
    ((15, 20), (25, 40))
    """
    first = min(round(span[0] * fps), n_samples - 1)
    return first, min(max(round(span[1] * fps), first + 1), n_samples)
