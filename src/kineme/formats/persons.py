"""Choose the person to read from a file with several."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from kineme._util.checks import join_names
from kineme.errors import SeveralPeopleError


def choose_person(
    path: str | Path,
    people: Collection[str],
    person: str | None,
    what: str = "people",
    shown: Sequence[str] = (),
) -> str:
    """Return the requested person, or the only one; raise SeveralPeopleError if neither exists.

    ``shown`` are the people as listed in the message, ``what`` is the noun for them.
    """
    if person is None and len(people) == 1:
        return next(iter(people))
    if person is not None and person in people:
        return person
    question = (
        f"{len(people)} {what} are in it: choose one with person= (--person):"
        if person is None
        else f"there is no person {person!r}: choose from"
    )
    raise SeveralPeopleError(path, f"{question} {join_names(shown or [*people])}", people)
