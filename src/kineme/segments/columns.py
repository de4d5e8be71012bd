"""From columns of any program to a segment table: names, types and shapes checked, rows ordered."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import ParameterError
from kineme.segments.table import Kind, Level, SegmentTable


def segment_table(columns: Mapping[str, ArrayLike], fps: float) -> SegmentTable:
    """A table from columns in any row order; see `Segmentation.from_columns`.

    Parameters
    ----------
    columns : mapping of str to array_like
        By name, one value for each segment.
    fps : float
        Frames per second.

    Returns
    -------
    SegmentTable

    Raises
    ------
    ParameterError
        A column is missing, of another length, or holds what it cannot.
    """
    missing = [c for c in ("level", "kind", "start_frame", "stop_frame") if c not in columns]
    if missing:
        raise ParameterError(f"a segment table needs the column {missing[0]!r}")
    n = np.size(columns["level"])
    level = _texts(columns["level"], "level", get_args(Level))
    start = _integers(columns["start_frame"], "start_frame")
    stop = _integers(columns["stop_frame"], "stop_frame")
    arrays: dict[str, NDArray[Any]] = {
        "level": level,
        "kind": _texts(columns["kind"], "kind", get_args(Kind)),
        "start_frame": start,
        "stop_frame": stop,
        "start_s": start / fps,
        "stop_s": stop / fps,
        "cluster": _integers(columns.get("cluster", np.full(n, -1)), "cluster"),
        "activity": np.zeros(n, np.int64),
        "label": _texts(columns.get("label", np.full(n, "")), "label"),
        "score": _shares(columns.get("score", np.full(n, np.nan)), "score"),
        "action": np.full(n, -1),
        "border_confidence": _shares(
            columns.get("border_confidence", np.full(n, np.nan)), "border_confidence"
        ),
    }
    if "activity" in columns:
        arrays["activity"] = _integers(columns["activity"], "activity")
    for name, array in arrays.items():
        if array.shape != (n,):
            raise ParameterError(f"column {name!r} has shape {array.shape}, 'level' has ({n},)")
    if "activity" not in columns:
        parents = np.sort(start[level == "activity"])
        arrays["activity"] = np.searchsorted(parents, start, side="right") - 1
    arrays["action"] = _actions(arrays)
    order = np.lexsort((stop, start, level))
    return SegmentTable(**{name: array[order] for name, array in arrays.items()})


def _actions(arrays: Mapping[str, NDArray[Any]]) -> NDArray[np.int64]:
    """The cluster of the activity that each row lies in, -1 where there is none."""
    activities = np.flatnonzero(arrays["level"] == "activity")
    activities = activities[np.argsort(arrays["start_frame"][activities], kind="stable")]
    clusters = np.append(arrays["cluster"][activities], -1)
    starts = arrays["start_frame"][activities]
    enclosing = np.searchsorted(starts, arrays["start_frame"], side="right") - 1
    actions: NDArray[np.int64] = clusters[enclosing]
    return actions


def _integers(values: ArrayLike, name: str) -> NDArray[np.int64]:
    array = _array(values, name)
    if array.size and array.dtype.kind not in "iu":
        raise ParameterError(f"column {name!r} must hold whole numbers, not {array.dtype}")
    if array.size and int(array.max()) > np.iinfo(np.int64).max:
        raise ParameterError(f"column {name!r} holds {array.max()}, which is too large")
    return array.astype(np.int64)


def _shares(values: ArrayLike, name: str) -> NDArray[np.float64]:
    scores = _array(values, name)
    if scores.dtype.kind not in "iuf" or np.isinf(scores).any():
        raise ParameterError(f"column {name!r} must be finite, or nan where nothing is known")
    return scores.astype(np.float64)


def _texts(values: ArrayLike, name: str, allowed: tuple[str, ...] = ()) -> NDArray[np.str_]:
    texts = _array(values, name)
    held = texts.ravel().tolist()
    other = next((value for value in held if not isinstance(value, str)), "")
    if other != "":
        raise ParameterError(f"column {name!r} must hold texts, not {other!r:.60}")
    for text in set(held):
        if allowed and text not in allowed:
            raise ParameterError(f"{name} must be {' or '.join(allowed)}, not {text!r}")
        if any(unicodedata.category(letter) in ("Cc", "Cs", "Zl", "Zp") for letter in text):
            raise ParameterError(f"{name} {text!r} must be one line of plain text")
    return texts.astype(np.str_)


def _array(values: ArrayLike, name: str) -> NDArray[Any]:
    try:
        return np.asarray(values)
    except ValueError as error:
        raise ParameterError(f"column {name!r} must hold one value per row") from error
