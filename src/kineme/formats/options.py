"""Define the options for reading files, and choose the person to read from a file with several."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from os import fspath
from pathlib import Path

from kineme._util.checks import as_texts, check_flag, check_path, is_number, is_one_of, join_names
from kineme.errors import ParameterError, SeveralPeopleError
from kineme.formats.units import AXES, UNITS


@dataclass(frozen=True)
class ReadOptions:
    """Options that override what a file states; None keeps the file's value.

    They are the keywords of `kineme.read`, which documents them and takes them as
    ``read(path, **vars(options))``.

    Raises
    ------
    ParameterError
        A value that an option does not accept.

    Examples
    --------
    >>> ReadOptions(unit="mm").channels, ReadOptions(columns=["acc_*"]).channels
    (False, True)
    """

    skeleton: str | None = None
    fps: float | None = None
    unit: str | float | None = None
    up: str | None = None
    person: str | None = None
    confidence: float | None = None
    columns: Sequence[str] | None = None
    emg: bool = False
    take: str | None = None

    def __post_init__(self) -> None:
        if self.skeleton is not None:
            check_path(self.skeleton, "skeleton")
            object.__setattr__(self, "skeleton", fspath(self.skeleton))
        for name, value in (("person", self.person), ("take", self.take)):
            if value is not None and not isinstance(value, str):
                raise ParameterError(f"{name} is {value!r:.60}: give a name, or a number as text")
        check_flag(self.emg, "emg")
        if self.columns is not None:
            object.__setattr__(self, "columns", as_texts(self.columns, "columns"))
        if self.fps is not None and not (is_number(self.fps) and self.fps > 0):
            raise ParameterError(f"fps is {self.fps!r:.60}: give frames per second, above 0")
        if isinstance(self.unit, str):
            if self.unit not in UNITS:
                names = ", ".join(UNITS)
                raise ParameterError(f"unit is {self.unit!r:.60}: give metres or one of {names}")
        elif self.unit is not None and not (is_number(self.unit) and self.unit > 0):
            raise ParameterError(f"unit is {self.unit!r:.60}: give the metres in one unit, above 0")
        if self.up is not None and not is_one_of(self.up, AXES):
            raise ParameterError(f"up is {self.up!r:.60}: give one of {', '.join(AXES)}")
        if self.confidence is not None and not is_number(self.confidence):
            raise ParameterError(
                f"confidence is {self.confidence!r:.60}: give a number, such as 0.5"
            )

    @property
    def channels(self) -> bool:
        """Whether channels are requested, regardless of what else a file holds."""
        return self.columns is not None or self.emg


def choose_person(
    path: str | Path,
    people: Collection[str],
    person: str | None,
    what: str = "people",
    shown: Sequence[str] = (),
) -> str:
    """Return the requested person, or the only one; raise SeveralPeopleError if neither exists.

    The case of a name does not matter if it is unique without. Where no name is a number, numbers
    count people from 0. ``shown`` are the people as listed in the message, ``what`` is the noun.
    """
    keys = {name: name for name in people}
    if not any(map(str.isdecimal, people)):
        keys |= {str(number): name for number, name in enumerate(people)}
    if person in keys:
        return keys[person]
    alike = [name for name in people if person is None or name.casefold() == person.casefold()]
    if len(alike) == 1:
        return alike[0]
    question = (
        f"{len(people)} {what} are in it: choose one with person= (--person):"
        if person is None
        else f"there is no person {person!r}: choose from"
    )
    raise SeveralPeopleError(path, f"{question} {join_names(shown or [*people])}", people)
