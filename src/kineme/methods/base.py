"""Interfaces that every method implements: `Preset` (its constants) and `Found` (its result).

A method is a subfolder of this package. It has a subclass of `Preset`, whose
``analyze(features, ...)`` returns a `Found`, and one or more presets with values.
All other code works with any method.

To add a method from another package, subclass `Preset` and register an instance
with `kineme.methods.register`, or declare it as an entry point in the group
``kineme.presets``.

`constant` creates a field of a preset with all that the command line, studio and docs
show of it, so a constant added to a preset appears in each of them.
"""

from __future__ import annotations

import math
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Hashable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import MISSING, dataclass, field, fields, replace
from difflib import get_close_matches
from functools import cache
from types import NoneType
from typing import (
    Any,
    ClassVar,
    Literal,
    NamedTuple,
    Protocol,
    Self,
    cast,
    get_args,
    get_origin,
    get_type_hints,
    runtime_checkable,
)

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import ParameterError

Progress = Callable[[str], None]
Columns = dict[str, NDArray[Any]]
Mirror = Callable[[NDArray[np.float64]], NDArray[np.float64]]
View = Literal["poses", "quaternions", "rotation vectors"]
Unit = Literal["body sizes", "metres", "standard deviations", "any"]
MAX_TIME = 3600.0
"""Largest value of a constant that is a time, s."""
MAX_LENGTH = 1e4
"""Largest value of a constant that is a length: metres, body sizes or standard deviations."""
MAX_COUNT = 1_000_000
"""Largest value of a constant that is a count."""


class Limits(NamedTuple):
    """Range of a number: from ``minimum`` (exclusive if ``above``) to ``maximum``."""

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
        """Describe the limits in words."""
        low = f"above {self.minimum:g}" if self.above else f"from {self.minimum:g}"
        return f"a number {low} to {self.maximum:g}"


TIME = Limits(0.0, MAX_TIME)
SOME_TIME = Limits(0.0, MAX_TIME, above=True)
LENGTH = Limits(0.0, MAX_LENGTH)
SOME_LENGTH = Limits(0.0, MAX_LENGTH, above=True)
COUNT = Limits(0, MAX_COUNT)
SOME = Limits(1, MAX_COUNT)
SHARE = Limits(0.0, 1.0)
SOME_SHARE = Limits(0.0, 1.0, above=True)
FACTOR = Limits(0.0, 1000.0)
SOME_FACTOR = Limits(0.0, 1000.0, above=True)


class Slider(NamedTuple):
    """Range and step of the slider that web pages show for a constant."""

    minimum: float
    maximum: float
    step: float


@dataclass(frozen=True)
class Constant:
    """A constant of a preset, as shown to users.

    Parameters
    ----------
    name : str
        Name of the field.
    help : str
        What it does, in a phrase.
    unit : str
        ``s``, ``Hz``, ``body sizes``, ``metres``, or empty.
    value : Any
        Its value in this preset.
    hint : Any
        Its type.
    limits : Limits, optional
        Range of a number.
    slider : Slider, optional
        Slider on web pages; None if pages do not show it.
    fine : bool
        Whether it rarely needs to be changed.
    default : Any
        Default of the preset's class; ``dataclasses.MISSING`` if the class has none.
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
        """Describe the allowed values in words; empty for free text.

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
    """Create a field of a preset, with its help, unit and limits.

    Parameters
    ----------
    text : str
        What it does, in a phrase.
    unit : str
        As in `Constant`.
    limits : Limits, optional
        Range of the number, or of each number of a tuple.
    slider : tuple of float, optional
        Minimum, maximum and step of the slider on web pages.
    fine : bool
        Whether it rarely needs to be changed.
    default : Any
        Default of the class; leave out if each preset sets its own value.
    """
    details = {
        "help": text,
        "unit": unit,
        "limits": limits,
        "slider": None if slider is None else Slider(*slider),
        "fine": fine,
    }
    return field(default=default, metadata={"constant": details})


def suggest_names(name: str, names: Collection[str]) -> str:
    """Return a hint for an unknown name: the most similar name, or else all names.

    Examples
    --------
    >>> suggest_names("min_acton", ["radius", "min_action"])
    'did you mean min_action?'
    >>> suggest_names("width", ["radius", "min_action"])
    'there are radius, min_action'
    """
    similar = get_close_matches(name, names, n=1)
    return f"did you mean {similar[0]}?" if similar else f"there are {', '.join(names)}"


def time_stages(
    timings: dict[str, float], progress: Progress | None
) -> Callable[[str], AbstractContextManager[None]]:
    """Return a context manager ``stage(name)`` that calls ``progress`` and records seconds."""

    @contextmanager
    def stage(name: str) -> Iterator[None]:
        if progress is not None:
            progress(name)
        start = time.perf_counter()
        yield
        timings[name] = time.perf_counter() - start

    return stage


RATE = Limits(0.1, 1000.0)
"""Limits of a sampling rate, Hz."""


class Found(Protocol):
    """Result of a method, in samples of its working rate.

    Every method provides these members. Results of its stages are further attributes.
    """

    @property
    def timings(self) -> dict[str, float]:
        """Seconds per stage."""

    def columns(self) -> Columns:
        """Return the columns of a segment table, with frames counted in samples.

        They are ``level``, ``kind``, ``start_frame``, ``stop_frame``, ``cluster`` and
        ``confidence``, and ``border_confidence`` if the method estimates it.
        """

    def doubts(self, columns: Columns, fps: float) -> list[str]:
        """Return a sentence for each result of low confidence, the lowest first.

        Parameters
        ----------
        columns : dict of str to array
            As returned by `columns`, in frames of the recording.
        fps : float
            Frame rate of the recording.
        """


@runtime_checkable
class Leveled(Protocol):
    """Optional extension of `Found`: the result at other levels of detail."""

    def levels(
        self, columns: Columns, details: tuple[float, ...] | None = None
    ) -> Mapping[float, Columns]:
        """Return the columns of a segment table by detail: below 1 coarser, above 1 finer.

        A detail may be missing if its result equals that of the next coarser one.
        Every border at one detail is also a border at all finer ones.

        Parameters
        ----------
        columns : dict of str to array
            As returned by `Found.columns`: the result at detail 1.
        details : tuple of float, optional
            Details to return; by default those that the method offers.
        """


@dataclass(frozen=True, kw_only=True)
class Preset(ABC):
    """Named constants of a method, and the method itself.

    Attributes
    ----------
    name : str
        Name that selects it.
    help : str
        Its purpose, in one sentence.
    """

    method: ClassVar[str]
    """Name of the method."""
    view: ClassVar[View] = "poses"
    """Features computed from a body: positions of five points, or rotations of joints."""

    units: ClassVar[tuple[Unit, ...]] = ("body sizes", "metres", "standard deviations", "any")
    """Allowed units of its lengths."""
    accepts_joints: ClassVar[bool] = False
    """Whether channels that are positions of joints are replaced by distances between joints.
    If so, `analyze` accepts ``joints``, which is True for such features."""

    name: str
    help: str
    unit: Unit
    """Unit of its lengths."""
    working_fps: float = constant(
        "samples per second to which the recording is resampled",
        unit="Hz",
        limits=RATE,
        default=30.0,
    )
    offsets: tuple[float, ...] = constant(
        "neighbouring samples that are stacked into one feature", unit="s",
        limits=Limits(-60.0, 60.0), default=(0.0,),
    )  # fmt: skip
    smoothing: float = constant(
        "channels of signals are averaged over this", unit="s", limits=TIME, default=0.1
    )

    def __post_init__(self) -> None:
        for each in self.constants():
            _check_value(each.name, each.value, each.hint, each.limits, each.unit)
            if each.hint is int and type(each.value) is not int:
                object.__setattr__(self, each.name, int(each.value))  # a count such as 3.0
        if self.unit not in self.units:
            raise ParameterError(
                f"unit must be {' or '.join(self.units)} in {self.name}, not {self.unit!r:.60}"
            )

    @abstractmethod
    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,
        progress: Progress | None = None,
    ) -> Found:
        """Segment features (samples, dims) at the working rate.

        Parameters
        ----------
        features : (samples, dims) array
            In the unit of the preset.
        mirror : callable, optional
            Swaps left and right in these features.
        progress : callable, optional
            Called with the name of each stage before it runs.
        """

    def for_signals(self) -> Self:
        """Return the preset with its lengths converted to the unit of channels."""
        return self

    def rate_of(self, values: NDArray[np.float64], fps: float) -> float:  # noqa: ARG002
        """Return the rate at which to treat values (samples, channels): by default ``fps``."""
        return fps

    def at_most(self, fps: float) -> Self:  # noqa: ARG002 (most methods keep their rate)
        """Return the preset with a working rate of at most ``fps``, the recording's rate."""
        return self

    def frames(self, seconds: float) -> int:
        """Convert seconds to a whole number of samples at the working rate."""
        return round(seconds * self.working_fps)

    def constants(self) -> tuple[Constant, ...]:
        """Return the constants in the order of the fields, with meaning, unit, value and limits."""
        hints = _get_type_hints(type(self))
        defaults = {each.name: each.default for each in fields(self)}
        return tuple(
            Constant(
                name, value=getattr(self, name), hint=hints[name], default=defaults[name], **details
            )
            for name, details in _get_details(type(self)).items()
        )

    def parameters(self) -> Mapping[str, Any]:
        """Return the value of each constant by name, for the provenance."""
        return {name: getattr(self, name) for name in _get_details(type(self))}

    def replace(self, **overrides: Any) -> Self:
        """Return a copy of the preset with some constants changed.

        Raises
        ------
        ParameterError
            A constant does not exist, or its value is not allowed.

        Examples
        --------
        >>> import kineme
        >>> kineme.PRESETS["kineme"].replace(min_action=2.0).min_action
        2.0
        """
        names = list(self.parameters())
        for name in overrides:
            if name not in names:
                raise ParameterError(
                    f"{self.name} has no parameter {name!r:.60}; {suggest_names(name, names)}"
                )
        return replace(self, **overrides) if overrides else self


def _check_value(name: str, value: Any, hint: Any, limits: Limits | None, unit: str) -> None:
    """Raise ParameterError if the value does not fit the type hint and limits."""
    members = get_args(hint)
    # `T | None`: None is valid, any other value is checked as a `T`.
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
    is_fixed_length = Ellipsis not in members
    if is_fixed_length and len(value) != len(members):
        raise ParameterError(f"{name} must be {len(members)} numbers, not {value!r:.60}")
    for each in value:
        _check_value(f"each of {name}", each, members[0], limits, unit)


@cache
def _get_details(kind: Hashable) -> Mapping[str, Mapping[str, Any]]:
    """Return what `constant` declares of each field of a preset class."""
    return {
        each.name: each.metadata["constant"]
        for each in fields(cast(Any, kind))
        if "constant" in each.metadata
    }


@cache
def _get_type_hints(kind: Hashable) -> dict[str, Any]:
    return get_type_hints(cast(Any, kind))
