"""What the columns of a table tell of its times, see `kineme.recordings.times` and `.regular`."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme._util.checks import join_names
from kineme.errors import ParameterError
from kineme.formats.files import FileContent
from kineme.recordings import Note
from kineme.recordings.arrays import find_spans
from kineme.recordings.regular import Timing, place_rows
from kineme.recordings.times import UNITS_NAMED, as_seconds, find_time_unit, is_rate, is_time

_SLOWEST = 1.0  # frames per second: at or below, times of no stated unit are hardly seconds


def find_table_timing(
    content: FileContent,
    columns: Mapping[str, ArrayLike],
    fps: float | None = None,
    values: Floats | None = None,
) -> Timing:
    """Return the rate of a table and the frame of each row; ``fps`` stands in place of its times.

    ``values``, (rows, channels), tell sensors of several rates apart. ReadError where no column
    tells the rate, or one contradicts itself.
    """
    if fps:
        return Timing(fps)
    for column in columns:
        if is_rate(column):
            return Timing(_check_rate(content, read_column(content, columns, column)))
    clocks = [column for column in columns if is_time(column)]
    stopped = [column for column in clocks if len(clocks) > 1 and _is_stopped(columns[column])]
    # Of several clocks those count that run; a single one is refused with the reason.
    for column in [name for name in clocks if name not in stopped] or clocks:
        unit = find_time_unit(column)
        try:
            times, guessed = as_seconds(columns[column], unit)
        except (ValueError, TypeError) as error:
            raise content.error(f"column {column!r} does not tell times: {error}") from None
        times = read_column(content, {column: times}, column)
        timing = find_timing(content, times, values)
        notes = list(timing.notes)
        if guessed:
            remark = f"{column} is taken in {UNITS_NAMED[guessed]}, by its steps"
            notes.insert(0, Note(remark, "warning"))
        elif timing.fps <= _SLOWEST and not unit:
            raise content.error(
                f"its times are {1 / timing.fps:g} apart; if these are not seconds, give fps "
                f"(--fps; {1e3 * timing.fps:g} for milliseconds)"
            )
        if stopped:
            remark = f"no time in {join_names(stopped)}: {column} taken"
            notes.insert(0, Note(remark, "warning"))
        return timing.noted(notes)
    raise content.error("no column 'time' or 'fps' found: give fps= (--fps)")


def find_timing(content: FileContent, times: Floats, values: Floats | None = None) -> Timing:
    """Return what `place_rows` finds; ReadError where times tell nothing."""
    try:
        return place_rows(times, values)
    except ParameterError as error:
        raise content.error(str(error)) from None


def place_points(timing: Timing, points: Floats) -> tuple[Floats, tuple[tuple[int, int], ...]]:
    """Return points (rows, points, axes) in frames, and the gaps in which there are no rows.

    NaN where single points are missing for long. Rows that are frames are left as they are, with
    their holes.
    """
    if timing.order is None:
        return points, timing.gaps
    found = timing.resample(points.reshape(len(points), -1))
    gaps = timing.gaps
    if found.missing is not None:
        pause = np.asarray(found.missing.all(axis=1))
        found.values[found.missing & ~pause[:, None]] = np.nan
        for start, stop in gaps:
            pause[start:stop] = True
        gaps = tuple((start, stop) for start, stop in find_spans(pause).tolist())
    return found.values.reshape(-1, *points.shape[1:]), gaps


def read_column(
    content: FileContent, columns: Mapping[str, ArrayLike], name: str, rows: int | None = None
) -> Floats:
    """(rows,): a column as numbers; ReadError where it holds others, or is of another length."""
    try:
        values = np.asarray(columns[name], np.float64)
    except (ValueError, TypeError):
        raise content.error(f"column {name!r} does not hold numbers") from None
    if values.ndim != 1 or len(values) == 0 or len(values) != (rows or len(values)):
        raise content.error(f"column {name!r} has shape {values.shape}, not one value per row")
    return values


def _is_stopped(cells: ArrayLike) -> bool:
    """Return whether a column of times is empty, or the same in all of several rows."""
    texts = {str(cell).strip() for cell in np.asarray(cells).ravel()}
    return texts <= {"", "nan", "None"} or (len(texts) == 1 and np.size(cells) > 1)


def _check_rate(content: FileContent, rates: Floats) -> float:
    rate = float(rates[0])
    if not (np.isfinite(rate) and rate > 0) or np.ptp(rates) > 0:
        raise content.error(
            f"the frame rate is not one positive number ({rate:g} first): give fps= (--fps)"
        )
    return rate
