"""How many there are of something, as people say it."""

from __future__ import annotations

MANY = {"activity": "activities", "person": "people"}


def counted(n: int, one: str) -> str:
    """A number and a noun, which is given for one.

    Examples
    --------
    >>> counted(1, "gap"), counted(0, "gap"), counted(2, "activity")
    ('1 gap', '0 gaps', '2 activities')
    """
    return f"{n} {one if n == 1 else MANY.get(one, f'{one}s')}"
