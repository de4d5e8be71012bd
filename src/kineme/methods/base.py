"""What every method shares: `Preset`, the constants of a method, and `Found`, what it finds.

A method is a folder of this room: a class of presets with the function
``analyze(features, ...)``, which gives a `Found`, and one or more presets with
values. From there on nothing needs to know which method it was.

A third party's method is a class of presets of its own, and an object of it
registered by `kineme.methods.register`, or named in its package as an entry
point of the group ``kineme.presets``.
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
"""Hertz: of anything that moves."""


class Found(Protocol):
    """What a method found, in samples of its working rate.

    Every method has what is here. Its own stages are further attributes of its class.
    """

    @property
    def timings(self) -> dict[str, float]:
        """Seconds per stage."""

    def columns(self) -> Columns:
        """Columns of a segment table: ``level``, ``kind``, ``start_frame``, ``stop_frame``.

        Frames count samples. ``cluster`` and ``confidence`` go with them, and
        ``border_confidence`` where the method has probabilities of borders.
        """

    def doubts(self, columns: Columns, fps: float) -> list[str]:
        """Return a sentence for each result of low confidence, the lowest first.

        Parameters
        ----------
        columns : dict of str to array
            Those of `columns`, in frames of the recording.
        fps : float
            Of the recording.
        """


@runtime_checkable
class Leveled(Protocol):
    """What a method can give beside `Found`: the same at other levels of detail."""

    def levels(
        self, columns: Columns, details: tuple[float, ...] | None = None
    ) -> Mapping[float, Columns]:
        """Columns of a segment table by their detail: below 1 coarser, above 1 finer.

        A detail may be left out where it is like the next coarser one.

        Every border at one detail is one at any finer one, those of `columns` at detail 1
        among them.

        Parameters
        ----------
        columns : dict of str to array
            Those of `Found.columns`, which are detail 1.
        details : tuple of float, optional
            Which; by default those that the method offers.
        """


@dataclass(frozen=True, kw_only=True)
class Preset(ABC):
    """Named constants of a method, and the method itself.

    Attributes
    ----------
    name : str
        By which people choose it.
    help : str
        What it is for, in a sentence.
    """

    method: ClassVar[str]
    """Name of the method."""
    view: ClassVar[View] = "poses"
    """Features of a body: positions of five points, or rotations of joints."""

    units: ClassVar[tuple[Unit, ...]] = ("body sizes", "metres", "standard deviations", "any")
    """What its lengths can be in."""
    accepts_joints: ClassVar[bool] = False
    """Whether channels that are positions of joints become the distances between these.
    Then `analyze` takes ``joints``: whether the features are such distances."""

    name: str
    help: str
    unit: Unit
    """What its lengths are in."""
    working_fps: float = constant(
        "samples per second at which the recording is looked at",
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
        """Return what the method finds in features (samples, dims) at the working rate.

        Parameters
        ----------
        features : (samples, dims) array
            In the unit of the preset.
        mirror : callable, optional
            Exchanges left and right in such features.
        progress : callable, optional
            Called with the name of each stage before it runs.
        """

    def for_signals(self) -> Self:
        """Return the preset with its lengths in the unit of channels."""
        return self

    def signal_unit(self, features: NDArray[np.float64]) -> float:  # noqa: ARG002
        """Return how many standard deviations one unit of length is in these features."""
        return 1.0

    def rate_of(self, values: NDArray[np.float64], fps: float) -> float:  # noqa: ARG002
        """Return how many samples (samples, channels) count as a second: those taken in one."""
        return fps

    def at_most(self, fps: float) -> Self:  # noqa: ARG002 (most methods ask for no less)
        """Return the preset for a recording of that rate, which is the highest working rate."""
        return self

    def frames(self, seconds: float) -> int:
        """Seconds in whole samples of the working rate."""
        return round(seconds * self.working_fps)

    def constants(self) -> tuple[Constant, ...]:
        """Return each constant with its meaning, unit, value and limits."""
        return list_constants(self)

    def parameters(self) -> Mapping[str, Any]:
        """Return the value of each constant by name, for the provenance."""
        return collect_values(self)

    def replace(self, **overrides: Any) -> Self:
        """Return the same preset with some constants changed.

        Raises
        ------
        ParameterError
            A constant that does not exist, or a value it cannot take.

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
