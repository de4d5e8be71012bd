"""What a user may say about a file that is read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike

from kineme._checks import as_texts, check_path, is_number, is_one_of
from kineme.errors import ParameterError
from kineme.formats.units import AXES, UNITS

AnyPath = str | PathLike[str]


@dataclass(frozen=True)
class ReadOptions:
    """What the user knows better than the file; None where the file is right.

    Parameters
    ----------
    skeleton : str or PathLike, optional
        The ASF file of an AMC, if it is not found beside it.
    fps : float, optional
        Frames per second.
    unit : str or float, optional
        "m", "cm", "mm", "inch", "cmu" (1/0.45 inch) or the metres in one unit.
    up : str, optional
        The file's vertical axis, "x", "y", "z", "-x", "-y" or "-z".
    person : str, optional
        Which of several people in a file, by name or number.
    confidence : float, optional
        From which a keypoint counts as seen.
    columns : sequence of str, optional
        Take these columns or analog channels as signals, by name or pattern (``acc_*``), in this
        order; all if it is empty.
    emg : bool
        Take channels as signals; of the analog channels of a C3D those of muscles.
    take : str, optional
        Which of several animations in a file, by name or number.

    Raises
    ------
    ParameterError
        A value that an option does not take.
    """

    skeleton: AnyPath | None = None
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
        if self.columns is not None:
            object.__setattr__(self, "columns", as_texts(self.columns, "columns"))
        if self.fps is not None and not (is_number(self.fps) and self.fps > 0):
            raise ParameterError(f"fps is {self.fps!r:.60}: give frames per second, above 0")
        if isinstance(self.unit, str):
            if self.unit not in UNITS:
                names = ", ".join(UNITS)
                raise ParameterError(f"unit is {self.unit!r}: give metres or one of {names}")
        elif self.unit is not None and not (is_number(self.unit) and self.unit > 0):
            raise ParameterError(f"unit is {self.unit!r:.60}: give the metres in one unit, above 0")
        if self.up is not None and not is_one_of(self.up, AXES):
            raise ParameterError(f"up is {self.up!r}: give one of {', '.join(AXES)}")
        if self.confidence is not None and not is_number(self.confidence):
            raise ParameterError(
                f"confidence is {self.confidence!r:.60}: give a number, such as 0.5"
            )

    @property
    def channels(self) -> bool:
        """Whether channels are asked for, whatever else a file holds."""
        return self.columns is not None or self.emg
