"""What every preset has, and how its constants are checked and changed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from typing import Any, Literal, Self

from kineme._checks import is_number
from kineme.errors import ParameterError

Unit = Literal["metres", "sizes", "standard deviations"]


@dataclass(frozen=True, kw_only=True)
class Preset:
    """What every preset has.

    Parameters
    ----------
    name : str
    unit : what the lengths are in: ``metres``, ``standard deviations`` of channels, or ``sizes``
        of what is recorded, the body's or, of signals, five times the distance at which they recur
    working_fps : frames per second at which the recording is looked at
    offsets : seconds of the neighbouring frames stacked into one search vector
    max_lag : look for likeness no farther away than this, seconds; None for everywhere
    """

    name: str
    unit: Unit = "metres"
    working_fps: float = 30.0
    offsets: tuple[float, ...]
    max_lag: float | None = None

    def frames(self, seconds: float) -> int:
        """Seconds in whole frames of the working rate."""
        return round(seconds * self.working_fps)

    @classmethod
    def constants(cls) -> tuple[str, ...]:
        """The names of the constants: all fields but the name and the unit."""
        return tuple(field.name for field in fields(cls) if field.name not in ("name", "unit"))

    def replace(self, **overrides: Any) -> Self:
        """The same preset with some constants changed.

        Raises
        ------
        ParameterError : a constant that does not exist, or a value it cannot take
        """
        known = self.constants()
        for name in overrides:
            if name not in known:
                raise ParameterError(
                    f"{self.name} has no parameter {name!r}; there are {', '.join(known)}"
                )
        return replace(self, **overrides)

    def _check(self, positive: Iterable[str], not_negative: Iterable[str]) -> None:
        if not _are_numbers(self.offsets):
            raise ParameterError(f"offsets must be seconds, at least one, not {self.offsets!r:.60}")
        optional = [field.name for field in fields(self) if "None" in str(field.type)]
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type == "bool" and not isinstance(value, bool):
                raise ParameterError(f"{field.name} is on or off, True or False, not {value!r:.60}")
        for name in positive:
            value = getattr(self, name)
            if value is None and name in optional:
                continue
            if not (is_number(value) and value > 0):
                raise ParameterError(f"{name} must be a positive number, not {value!r}")
        for name in not_negative:
            value = getattr(self, name)
            if not (is_number(value) and value >= 0):
                raise ParameterError(f"{name} must be a number from 0, not {value!r}")


def _are_numbers(values: object) -> bool:
    return isinstance(values, tuple | list) and bool(values) and all(map(is_number, values))
