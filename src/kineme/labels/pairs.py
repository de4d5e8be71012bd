"""Tables and the files beside them: whether the two were written together.

A table and its side file are renamed one after the other. A writer that is killed between
the two leaves files of different recordings beside each other, so the side file names the
SHA-256 of its table's cuts, and reading compares the two.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from hashlib import sha256
from math import isclose
from pathlib import Path
from typing import Any

from kineme.errors import ReadError

KEY = "cuts_sha256"
"""Where a side file has the digest of its table's cuts."""

SAME = 5e-4
"""Share by which two frame rates differ that are one, once spreadsheets rounded the seconds."""


def digest(cuts: Iterable[tuple[object, object, object]]) -> str:
    """What a side file says of its table: level, first frame and end of every row, in any order.

    Labels are not in it, so that people may edit them.
    """
    lines = sorted(",".join(map(str, cut)) for cut in cuts)
    return sha256("\n".join(lines).encode()).hexdigest()


def differences(
    path: Path,
    beside: Path,
    side: Mapping[str, Any],
    found: str,
    *,
    head_rate: float | None,
    row_rate: float | None,
) -> tuple[str, ...]:
    """Return what to say of a table and its side file that were not written together.

    ``found`` is the `digest` of the table; side files that are older than it have none, and are
    believed. The rates are those in the side file and of frames and seconds in the table.
    """
    if KEY not in side:
        return ()
    rates = [rate for rate in (head_rate, row_rate) if rate is not None]
    if len(rates) == 2 and not isclose(*rates, rel_tol=SAME):
        raise ReadError(
            path,
            f"is of {row_rate:g} frames per second, but {beside.name} speaks of {head_rate:g}, "
            "and was written with another table: remove that file, or write both again",
        )
    if side[KEY] == found:
        return ()
    note = (
        f"{path.name} is not the table that {beside.name} was written with: its cuts were moved "
        "since, or writing broke off between the two"
    )
    return (note,)
