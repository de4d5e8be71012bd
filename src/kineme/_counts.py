"""How many there are of something, and which, as people say it."""

from __future__ import annotations

from collections.abc import Sequence

MANY = {"activity": "activities", "person": "people"}


def counted(n: int, one: str) -> str:
    """Return a number and a noun, which is given for one.

    Examples
    --------
    >>> counted(1, "gap"), counted(0, "gap"), counted(2, "activity")
    ('1 gap', '0 gaps', '2 activities')
    """
    return f"{n} {one if n == 1 else MANY.get(one, f'{one}s')}"


def listed(names: Sequence[str], most: int = 8) -> str:
    """Return the first names, and how many more there are.

    Examples
    --------
    >>> listed(["hip", "knee", "toe"], most=2), listed(["hip", "knee"])
    ('hip, knee and 1 more', 'hip, knee')
    """
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")
