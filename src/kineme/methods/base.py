"""What every preset has, and how its constants are checked and changed."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from typing import Any, Self

from kineme.errors import ParameterError


@dataclass(frozen=True, kw_only=True)
class Preset:
    """What every preset has.

    Parameters
    ----------
    name : str
    working_fps : frames per second at which the recording is looked at
    offsets : seconds of the neighbouring frames stacked into one search vector
    max_lag : look for likeness no farther away than this, seconds; None for everywhere
    """

    name: str
    working_fps: float = 30.0
    offsets: tuple[float, ...]
    max_lag: float | None = None

    def frames(self, seconds: float) -> int:
        """Seconds in whole frames of the working rate."""
        return round(seconds * self.working_fps)

    def replace(self, **overrides: Any) -> Self:
        """The same preset with some constants changed.

        Raises
        ------
        ParameterError : a constant that does not exist, or a value it cannot take
        """
        known = [field.name for field in fields(self) if field.name != "name"]
        for name in overrides:
            if name not in known:
                raise ParameterError(
                    f"{self.name} has no parameter {name!r}; there are {', '.join(known)}"
                )
        return replace(self, **overrides)

    def _check(self, positive: Iterable[str], not_negative: Iterable[str]) -> None:
        for name in positive:
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                raise ParameterError(f"{name} must be a positive number, not {value}")
        for name in not_negative:
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0):
                raise ParameterError(f"{name} must be a number from 0, not {value}")
