"""Interfaces that every method implements: `Preset` (its constants) and `Found` (its result).

A method is a subfolder of this package. It has a subclass of `Preset`, whose
``analyze(features, ...)`` returns a `Found`, and one or more presets with values.
All other code works with any method.

To add a method from another package, subclass `Preset` and register an instance
with `kineme.methods.register`, or declare it as an entry point in the group
``kineme.presets``.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Protocol, Self, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import ParameterError
from kineme.methods.constants import (
    TIME,
    Constant,
    Limits,
    check,
    collect_values,
    constant,
    list_constants,
    suggest_names,
)

if TYPE_CHECKING:
    from kineme.methods.stages import Progress

Columns = dict[str, NDArray[Any]]
Mirror = Callable[[NDArray[np.float64]], NDArray[np.float64]]
View = Literal["poses", "quaternions", "rotation vectors"]
Unit = Literal["body sizes", "metres", "standard deviations", "any"]

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
        check(self)
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

    def signal_unit(self, features: NDArray[np.float64]) -> float:  # noqa: ARG002
        """Return the number of standard deviations in one unit of length for these features."""
        return 1.0

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
        """Return each constant with its meaning, unit, value and limits."""
        return list_constants(self)

    def parameters(self) -> Mapping[str, Any]:
        """Return the value of each constant by name, for the provenance."""
        return collect_values(self)

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
