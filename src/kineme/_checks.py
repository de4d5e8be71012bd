"""What public functions check of the arrays they are given."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from numbers import Real
from operator import index
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import MissingDependencyError, MotionError, ParameterError

MOST_FRAMES_MORE = 1000
"""Frames at a new rate for one of the old, at most; beyond that the old one is wrong."""


@contextmanager
def needed(package: str, extra: str) -> Iterator[None]:
    """MissingDependencyError where the imports in it fail; the extra installs the package."""
    try:
        yield
    except ImportError as error:
        raise MissingDependencyError(package, extra) from error


def check_rates(old: float, new: float) -> None:
    """ParameterError where the frames at a new rate would be beyond all measure."""
    if new > MOST_FRAMES_MORE * old:
        raise ParameterError(
            f"frames {1 / old:g} s apart are too far for {new:g} a second: is the frame rate right?"
        )


def is_number(value: object) -> bool:
    """Return whether it is one finite number, as large as a float can be."""
    try:
        return isinstance(value, Real) and math.isfinite(value)
    except OverflowError:
        return False


def is_text(name: str) -> bool:
    """Whether a name can be written as UTF-8; that of a file or a joint may hold half a pair."""
    return not any("\ud800" <= letter <= "\udfff" for letter in name)


def check_flag(value: object, name: str) -> None:
    """ParameterError unless the value is True or False."""
    if not isinstance(value, bool | np.bool_):
        raise ParameterError(f"{name} must be True or False, not {value!r:.60}")


def is_one_of(value: object, choices: Collection[str]) -> bool:
    """Return whether it is one of the known texts; anything at all may be asked about."""
    return isinstance(value, str) and value in choices


def check_one_of(value: object, choices: Collection[str], what: str) -> None:
    """ParameterError unless it is one of the known texts."""
    if not is_one_of(value, choices):
        raise ParameterError(f"{what} must be one of {', '.join(choices)}, not {value!r:.60}")


def check_type(
    value: object,
    kind: type | tuple[type, ...],
    caller: str,
    advice: str,
    *,
    error: type[ParameterError | MotionError] = ParameterError,
) -> None:
    """``error`` with advice where a public function was given something else."""
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        expected = " or ".join(kind.__name__ for kind in kinds)
        if not expected.endswith("s"):  # Signals are many
            expected = f"{'an' if expected[0] in 'AEIOU' else 'a'} {expected}"
        raise error(f"{caller} takes {expected}, not {type(value).__name__}: {advice}")


def check_path(path: object, caller: str) -> None:
    """ParameterError where a public function was given no path."""
    check_type(path, (str, PathLike), caller, "give the path of a file")


def check_suffixes(suffixes: object, name: str) -> None:
    """ParameterError unless a format's suffixes are as paths are compared with them."""
    if not (
        isinstance(suffixes, tuple)
        and suffixes
        and all(isinstance(s, str) and s.startswith(".") and s == s.lower() for s in suffixes)
    ):
        raise ParameterError(
            f"suffixes of {name!r:.60} must be a tuple in lower case with the dot, such as "
            f"('.xyz',), not {suffixes!r:.60}"
        )


def as_indices(values: Any, name: str) -> list[int]:
    """Return the values as whole numbers; ParameterError where they are not."""
    try:
        return [index(value) for value in values]
    except TypeError:
        raise ParameterError(f"{name} must be whole numbers, not {values!r:.60}") from None


def as_texts(
    values: Any, name: str, *, error: type[ParameterError | MotionError] = ParameterError
) -> tuple[str, ...]:
    """Return the values as texts; ``error`` where they are one text or something else."""
    if isinstance(values, Iterable) and not isinstance(values, str):
        found = tuple(values)
        if all(isinstance(value, str) for value in found):
            return found
    raise error(f"{name} must be a list of texts, not {values!r:.60}")


def as_spans(
    gaps: Any, *, error: type[ParameterError | MotionError] = ParameterError
) -> tuple[tuple[int, int], ...]:
    """Return the gaps as pairs of frames (start, stop); ``error`` where they are not."""
    try:
        return tuple((index(start), index(stop)) for start, stop in gaps)
    except (TypeError, ValueError):
        raise error(f"gaps are pairs of frames (start, stop), not {gaps!r:.60}") from None


def as_floats(
    values: Any, name: str, *, error: type[ParameterError | MotionError] = ParameterError
) -> NDArray[np.float64]:
    """Return the values as a float64 array, of any shape; ``error`` where they are not numbers."""
    try:
        given = np.asarray(values)
        if given.dtype.kind != "c":  # numpy would drop the imaginary parts
            return np.asarray(given, np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    shown = repr(values) if isinstance(values, str) else type(values).__name__
    if isinstance(values, np.ndarray):
        shown = f"{values.dtype} values"
    raise error(f"{name} must be an array of numbers, not {shown:.60}") from None


def as_features(values: ArrayLike, name: str = "features") -> NDArray[np.float64]:
    """The values as float64 (frames, dims) without gaps in memory; ParameterError unless finite."""
    # Compiled code is typed for arrays that may be written to, whether it does or not.
    array = np.require(as_floats(values, name), requirements=("C", "W"))
    if array.ndim != 2 or 0 in array.shape:
        raise ParameterError(
            f"{name} must be frames x dims with at least one of each, not of shape {array.shape}"
        )
    if not np.isfinite(array).all():
        frame = int(np.argmin(np.isfinite(array).all(axis=1)))
        raise ParameterError(f"{name} hold a value that is not finite, first in frame {frame}")
    return array
