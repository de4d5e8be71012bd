"""Levels of detail: the tables of one recording from coarse to fine, each nested in the next.

Detail 1 is the default result of a method; less is coarser, more is finer. A border of a
level at one detail is also a border at all finer ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import format_count, is_number
from kineme.errors import ParameterError
from kineme.segments.table import Level, SegmentTable

DEFAULT_DETAIL = 1.0


@dataclass(frozen=True, repr=False)
class Hierarchy:
    """Tables of one recording by detail, one of which is selected.

    Parameters
    ----------
    details : tuple of float
        Ascending and above 0.
    tables : tuple of SegmentTable
        One for each detail; the borders of each are also borders of the next.
    detail : float
        The selected detail, one of `details`.

    Raises
    ------
    ParameterError
        Details are out of order, or a finer table lacks a border.

    Examples
    --------
    >>> import kineme
    >>> found = kineme.segment(kineme.read(kineme.bundled_recording()))
    >>> found.hierarchy
    <Hierarchy of 6 details from 0.125 to 8, 1 is shown>
    """

    details: tuple[float, ...]
    tables: tuple[SegmentTable, ...]
    detail: float = DEFAULT_DETAIL

    def __post_init__(self) -> None:
        _check_details(self.details, self.detail)
        if len(self.tables) != len(self.details):
            raise ParameterError(
                f"{len(self.tables)} tables for {len(self.details)} details: give one for each"
            )
        steps = zip(pairwise(self.details), pairwise(self.tables), strict=True)
        for (less, more), (coarse, fine) in steps:
            for level in ("activity", "primitive"):
                # Borders of the coarser table that the finer one lacks.
                lost = np.setdiff1d(_find_starts(coarse, level), _find_starts(fine, level))
                if len(lost):
                    raise ParameterError(
                        f"the {level} border at frame {lost[0]} exists at detail {less:g}, "
                        f"but not at {more:g}: finer tables must have the borders of "
                        "coarser ones"
                    )

    @classmethod
    def of(cls, tables: Mapping[float, SegmentTable]) -> Hierarchy:
        """Return the hierarchy of tables by detail, without tables that equal the next coarser one.

        Parameters
        ----------
        tables : mapping of float to SegmentTable
            With a table of detail 1, which is selected and never left out.
        """
        kept_details = [DEFAULT_DETAIL]
        for detail in sorted(each for each in tables if each > DEFAULT_DETAIL):
            if not _have_same_spans(tables[detail], tables[kept_details[-1]]):
                kept_details.append(detail)
        for detail in sorted((each for each in tables if each < DEFAULT_DETAIL), reverse=True):
            if not _have_same_spans(tables[detail], tables[kept_details[0]]):
                kept_details.insert(0, detail)
            elif kept_details[0] < DEFAULT_DETAIL:  # keep the coarsest of equal ones, and 1
                kept_details[0] = detail
        return cls(tuple(kept_details), tuple(tables[detail] for detail in kept_details))

    @property
    def table(self) -> SegmentTable:
        """Return the selected table."""
        return self.tables[self.details.index(self.detail)]

    def at(self, detail: float) -> Hierarchy:
        """Select the finest table that is not finer than ``detail``.

        Parameters
        ----------
        detail : float
            Above 0; below all details, the coarsest table is selected.

        Raises
        ------
        ParameterError
            `detail` is not a number above 0.
        """
        check_detail(detail)
        # The factor tolerates rounding errors of the requested detail.
        index = np.searchsorted(self.details, detail * (1 + 1e-9), side="right") - 1
        return Hierarchy(self.details, self.tables, self.details[max(0, int(index))])

    def borders(self, level: Level = "activity") -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Return the borders of the finest table, and the coarsest detail that has each.

        Returns
        -------
        frames : (borders,) array of int
        details : (borders,) array of float
        """
        frames = _find_starts(self.tables[-1], level)
        details = np.full(len(frames), self.details[-1])
        # From fine to coarse, so that the coarsest detail is stored last.
        for detail, table in zip(self.details[::-1], self.tables[::-1], strict=True):
            details[np.isin(frames, _find_starts(table, level))] = detail
        return frames, details

    def __repr__(self) -> str:
        n = len(self.details)
        details_text = (
            f"{format_count(n, 'detail')} from {self.details[0]:g} to {self.details[-1]:g}"
        )
        return f"<Hierarchy of {details_text}, {self.detail:g} is shown>"


def check_detail(detail: object) -> None:
    """Raise ParameterError unless the value is a number above 0."""
    if isinstance(detail, bool) or not (is_number(detail) and detail > 0):  # type: ignore[operator]
        raise ParameterError(
            f"detail must be a number above 0 (1 is the default, less is coarser), "
            f"not {detail!r:.60}"
        )


def _check_details(details: tuple[float, ...], present: float) -> None:
    for each in details:
        check_detail(each)
    if any(less >= more for less, more in pairwise(details)):
        raise ParameterError(f"details must increase, not be {', '.join(map(str, details))}")
    if present not in details:
        raise ParameterError(
            f"detail {present!r:.60} is not one of {', '.join(f'{each:g}' for each in details)}"
        )


def _find_starts(table: SegmentTable, level: Level) -> NDArray[np.int64]:
    """Return the starts of segments of a level, without the first, which is no border."""
    return np.sort(table.start_frame[table.level == level])[1:]


def _have_same_spans(a: SegmentTable, b: SegmentTable) -> bool:
    """Return whether two tables have equal segments and clusters, apart from cluster numbers."""
    same = all(
        np.array_equal(getattr(a, name), getattr(b, name))
        for name in ("level", "kind", "start_frame", "stop_frame")
    )
    if not same:
        return False
    first, second = a.cluster.tolist(), b.cluster.tolist()
    # Clusters map one to one if there are as many pairs of numbers as numbers on each side.
    return len({*zip(first, second, strict=True)}) == len({*first}) == len({*second})
