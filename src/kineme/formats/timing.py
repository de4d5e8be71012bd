"""Find the timing of a table from its columns, see `kineme.recordings.times` and `.regular`."""

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

_MIN_RATE = 1.0  # frames per second; times without a unit that give less are not seconds


def find_table_timing(
    content: FileContent,
    columns: Mapping[str, ArrayLike],
    fps: float | None = None,
    values: Floats | None = None,
) -> Timing:
    """Return the rate of a table and the frame of each row; ``fps`` overrides its times.

    ``values`` (rows, channels) help to separate sensors of different rates. Raise ReadError if no
    column defines the rate, or if one is inconsistent.
    """
    if fps:
        return Timing(fps)
    for column in columns:
        if is_rate(column):
            return Timing(_check_rate(content, read_column(content, columns, column)))
    clocks = [column for column in columns if is_time(column)]
    stopped = [column for column in clocks if len(clocks) > 1 and _is_stopped(columns[column])]
    # Use the first clock that runs; a single stopped one is refused with the reason.
    for column in [name for name in clocks if name not in stopped] or clocks:
        unit = find_time_unit(column)
        try:
            times, guessed_unit = as_seconds(columns[column], unit)
        except (ValueError, TypeError) as error:
            raise content.error(f"column {column!r} cannot be read as times: {error}") from None
        times = read_column(content, {column: times}, column)
        timing = find_timing(content, times, values)
        notes = list(timing.notes)
        if guessed_unit:
            remark = f"{column} is read in {UNITS_NAMED[guessed_unit]}, inferred from its steps"
            notes.insert(0, Note(remark, "warning"))
        elif timing.fps <= _MIN_RATE and not unit:
            raise content.error(
                f"its times are {1 / timing.fps:g} apart; if these are not seconds, give fps "
                f"(--fps; {1e3 * timing.fps:g} for milliseconds)"
            )
        if stopped:
            remark = f"{join_names(stopped)} does not advance: {column} used for times"
            notes.insert(0, Note(remark, "warning"))
        return timing.noted(notes)
    raise content.error("no column 'time' or 'fps' found: give fps= (--fps)")


def find_timing(content: FileContent, times: Floats, values: Floats | None = None) -> Timing:
    """Return the result of `place_rows`; raise ReadError if the times define no rate."""
    try:
        return place_rows(times, values)
    except ParameterError as error:
        raise content.error(str(error)) from None


def place_points(timing: Timing, points: Floats) -> tuple[Floats, tuple[tuple[int, int], ...]]:
    """Return points (rows, points, axes) as frames, and the gaps without rows.

    Points that are missing for long become NaN. If rows are frames already, they stay unchanged.
    """
    if timing.order is None:
        return points, timing.gaps
    resampled = timing.resample(points.reshape(len(points), -1))
    gaps = timing.gaps
    if resampled.missing is not None:
        is_empty = np.asarray(resampled.missing.all(axis=1))
        resampled.values[resampled.missing & ~is_empty[:, None]] = np.nan
        for start, stop in gaps:
            is_empty[start:stop] = True
        gaps = tuple((start, stop) for start, stop in find_spans(is_empty).tolist())
    return resampled.values.reshape(-1, *points.shape[1:]), gaps


def read_column(
    content: FileContent, columns: Mapping[str, ArrayLike], name: str, rows: int | None = None
) -> Floats:
    """Return a column as numbers (rows,); raise ReadError if it has other values or length."""
    try:
        values = np.asarray(columns[name], np.float64)
    except (ValueError, TypeError):
        raise content.error(f"column {name!r} does not hold numbers") from None
    if values.ndim != 1 or len(values) == 0 or len(values) != (rows or len(values)):
        raise content.error(f"column {name!r} has shape {values.shape}, not one value per row")
    return values


def _is_stopped(cells: ArrayLike) -> bool:
    """Return whether a column of times is empty, or constant over several rows."""
    texts = {str(cell).strip() for cell in np.asarray(cells).ravel()}
    return texts <= {"", "nan", "None"} or (len(texts) == 1 and np.size(cells) > 1)


def _check_rate(content: FileContent, rates: Floats) -> float:
    rate = float(rates[0])
    if not (np.isfinite(rate) and rate > 0) or np.ptp(rates) > 0:
        raise content.error(
            f"the frame rate is not one positive number ({rate:g} first): give fps= (--fps)"
        )
    return rate
