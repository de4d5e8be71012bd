"""Constants: the fields of a preset, each with its meaning, unit and limits.

A field made by `constant` carries all that command line, studio and docs show of
it, so that a constant added to a preset appears in each of them. `check`
compares a preset with its own fields: types, limits, choices. `suggest_names` names
the constant nearest to a wrong name.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Hashable, Mapping
from dataclasses import MISSING, dataclass, field, fields
from difflib import get_close_matches
from functools import cache
from types import NoneType
from typing import Any, Literal, NamedTuple, cast, get_args, get_origin, get_type_hints

import numpy as np

from kineme.errors import ParameterError

HOUR = 3600.0
"""Seconds: no time that a method looks at is longer."""
LONGEST = 1e4
"""Metres, body sizes or standard deviations: no distance between two samples is larger."""
MOST = 1_000_000
"""Of whatever is counted."""


class Limits(NamedTuple):
    """Values that a number may take: from ``minimum``, or above it, to ``maximum``."""

    minimum: float
    maximum: float
    above: bool = False

    def allow(self, value: object) -> bool:
        """Return whether ``value`` is a number within the limits."""
        if isinstance(value, bool) or not isinstance(value, int | float | np.number):
            return False
        try:
            number = float(value)
        except OverflowError:
            return False
        if not math.isfinite(number):
            return False
        return self.minimum <= number <= self.maximum and not (
            self.above and number == self.minimum
        )

    def describe(self) -> str:
        """Return the limits in words."""
        low = f"above {self.minimum:g}" if self.above else f"from {self.minimum:g}"
        return f"a number {low} to {self.maximum:g}"


TIME = Limits(0.0, HOUR)
SOME_TIME = Limits(0.0, HOUR, above=True)
LENGTH = Limits(0.0, LONGEST)
SOME_LENGTH = Limits(0.0, LONGEST, above=True)
COUNT = Limits(0, MOST)
SOME = Limits(1, MOST)
SHARE = Limits(0.0, 1.0)
SOME_SHARE = Limits(0.0, 1.0, above=True)
FACTOR = Limits(0.0, 1000.0)
SOME_FACTOR = Limits(0.0, 1000.0, above=True)


class Slider(NamedTuple):
    """Range within which a page offers to change a constant, and in which steps."""

    minimum: float
    maximum: float
    step: float


@dataclass(frozen=True)
class Constant:
    """One constant of a preset, as people are shown it.

    Parameters
    ----------
    name : str
        Of the field.
    help : str
        What it does, in a phrase.
    unit : str
        ``s``, ``Hz``, ``body sizes``, ``metres``, or empty.
    value : Any
        Of the preset at hand.
    hint : Any
        Its type.
    limits : Limits, optional
        Of numbers.
    slider : Slider, optional
        For the few that pages offer.
    fine : bool
        Whether it is one that hardly anybody needs to change.
    default : Any
        Of all presets of its class; ``dataclasses.MISSING`` where each has its own.
    """

    name: str
    help: str
    unit: str
    value: Any
    hint: Any
    limits: Limits | None
    slider: Slider | None
    fine: bool
    default: Any = MISSING

    @property
    def allowed(self) -> str:
        """Return the values that it may take, in words; empty for a text.

        Examples
        --------
        >>> import kineme
        >>> constants = {each.name: each for each in kineme.PRESETS["voegele2014"].constants()}
        >>> [constants[name].allowed for name in ("radius", "growth", "max_lag")]
        ['above 0 to 10000', 'squares, scan_lines', 'above 0 to 3600, none']
        """
        members = get_args(self.hint)
        optional = NoneType in members
        hint = next((each for each in members if each is not NoneType), None)
        hint = hint if optional else self.hint
        if get_origin(hint) is Literal:
            words = ", ".join(get_args(hint))
        elif hint is bool:
            words = "yes, no"
        elif self.limits is None:
            words = ""
        else:
            above = "above " if self.limits.above else ""
            words = f"{above}{self.limits.minimum:.9g} to {self.limits.maximum:.9g}"
        return ", ".join(filter(None, (words, "none" if optional else "")))


def constant(
    text: str,
    *,
    unit: str = "",
    limits: Limits | None = None,
    slider: tuple[float, float, float] | None = None,
    fine: bool = False,
    default: Any = MISSING,
) -> Any:
    """Return a field of a preset, with its help, unit and limits.

    Parameters
    ----------
    text : str
        What it does, in a phrase.
    unit : str
        As in `Constant`.
    limits : Limits, optional
        Of a number, or of each in a tuple.
    slider : tuple of float, optional
        Smallest and largest value that a page offers, and the step.
    fine : bool
        Whether hardly anybody needs to change it.
    default : Any
        Of all presets of the class; none if each has its own.
    """
    details = {
        "help": text,
        "unit": unit,
        "limits": limits,
        "slider": None if slider is None else Slider(*slider),
        "fine": fine,
    }
    return field(default=default, metadata={"constant": details})


def list_constants(preset: Any) -> tuple[Constant, ...]:
    """Return the constants of a preset, in the order of its fields."""
    hints = _hints(preset.__class__)
    defaults = {each.name: each.default for each in fields(preset)}
    return tuple(
        Constant(
            name, value=getattr(preset, name), hint=hints[name], default=defaults[name], **details
        )
        for name, details in _details(preset.__class__).items()
    )


def collect_values(preset: Any) -> dict[str, Any]:
    """Return the value of each constant of a preset by name."""
    return {name: getattr(preset, name) for name in _details(preset.__class__)}


def check(preset: Any) -> None:
    """ParameterError for the first constant whose value it cannot take; a count of 3.0 is 3."""
    for each in list_constants(preset):
        _check(each.name, each.value, each.hint, each.limits, each.unit)
        if each.hint is int and type(each.value) is not int:
            object.__setattr__(preset, each.name, int(each.value))


def suggest_names(name: str, names: Collection[str]) -> str:
    """Return the hint for a name that is none of these: the nearest, or all there are.

    Examples
    --------
    >>> suggest_names("min_acton", ["radius", "min_action"])
    'did you mean min_action?'
    >>> suggest_names("width", ["radius", "min_action"])
    'there are radius, min_action'
    """
    near = get_close_matches(name, names, n=1)
    return f"did you mean {near[0]}?" if near else f"there are {', '.join(names)}"


def _check(name: str, value: Any, hint: Any, limits: Limits | None, unit: str) -> None:
    members = get_args(hint)
    if NoneType in members:
        if value is None:
            return
        hint = next(member for member in members if member is not NoneType)
        members = get_args(hint)
    if get_origin(hint) is Literal:
        if not (isinstance(value, str) and value in members):
            raise ParameterError(f"{name} must be {' or '.join(members)}, not {value!r:.60}")
    elif get_origin(hint) is tuple:
        _check_tuple(name, value, hint, limits, unit)
    elif hint is bool:
        if not isinstance(value, bool):
            raise ParameterError(f"{name} must be true or false, not {value!r:.60}")
    elif limits is not None:
        if hint is int and isinstance(value, float) and not value.is_integer():
            raise ParameterError(f"{name} must be a whole number, not {value!r:.60}")
        if not limits.allow(value):
            allowed = f"{limits.describe()} {unit}".rstrip()
            raise ParameterError(f"{name} must be {allowed}, not {value!r:.60}")


def _check_tuple(name: str, value: Any, hint: Any, limits: Limits | None, unit: str) -> None:
    members = get_args(hint)
    if not isinstance(value, tuple) or not value:
        raise ParameterError(f"{name} must be a tuple of numbers, not {value!r:.60}")
    fixed = Ellipsis not in members
    if fixed and len(value) != len(members):
        raise ParameterError(f"{name} must be {len(members)} numbers, not {value!r:.60}")
    for each in value:
        _check(f"each of {name}", each, members[0], limits, unit)


@cache
def _details(kind: Hashable) -> Mapping[str, Mapping[str, Any]]:
    return {
        each.name: each.metadata["constant"]
        for each in fields(cast(Any, kind))
        if "constant" in each.metadata
    }


@cache
def _hints(kind: Hashable) -> dict[str, Any]:
    return get_type_hints(cast(Any, kind))
