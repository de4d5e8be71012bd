"""What is asked of a segmentation, beside the recording: one object for all options."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from kineme._checks import is_number
from kineme.errors import ParameterError
from kineme.methods.base import Preset
from kineme.methods.presets import DEFAULT, resolve_preset

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from kineme.features.effectors import Names


@dataclass(frozen=True, kw_only=True, eq=False)
class SegmentOptions:
    """How a recording is segmented; `kineme.segment` takes the same as keywords.

    Parameters
    ----------
    preset : str or Preset
        ``kineme``, or another of `kineme.PRESETS`.
    constants : Mapping of str to object
        Of the preset, to change.
    effectors : joints, optional
        Of a motion, to take for head, hands and feet where names do not tell.
    emg : bool
        Of signals: take the envelopes of muscle signals.
    features : (rows, dims) array, optional
        To look at in place of the recording's own.
    feature_fps : float, optional
        Rows of `features` per second; that of the recording by default.
    unit : float, optional
        The length in signals or features that counts as one unit of the preset's lengths.
    standardize : bool, optional
        Whether each channel is divided by its standard deviation: those of signals are by
        default, features are not.

    Raises
    ------
    ParameterError
        A unit or rate that is no number above 0, or a detail, which a result is asked for.
    """

    preset: str | Preset = DEFAULT
    constants: Mapping[str, Any] = field(default_factory=dict)
    effectors: Names | None = None
    emg: bool = False
    features: ArrayLike | None = None
    feature_fps: float | None = None
    unit: float | None = None
    standardize: bool | None = None

    def __post_init__(self) -> None:
        if "detail" in self.constants:
            raise ParameterError("detail is asked of what comes out: segment(...).at_detail(0.5)")
        for name, value in (("unit", self.unit), ("feature_fps", self.feature_fps)):
            if value is not None and not (is_number(value) and value > 0):
                raise ParameterError(f"{name} must be a number above 0, not {value!r:.60}")

    @classmethod
    def of(cls, **keywords: Any) -> SegmentOptions:
        """Options as `kineme.segment` takes them: what is none of the others is a constant.

        Examples
        --------
        >>> SegmentOptions.of(emg=True, min_action=2.0).constants
        {'min_action': 2.0}
        """
        options = {each.name for each in fields(cls)} - {"constants"}
        constants = {name: value for name, value in keywords.items() if name not in options}
        given = {name: value for name, value in keywords.items() if name in options}
        return cls(constants=constants, **given)

    def resolved(self, *, signals: bool = False) -> Preset:
        """Return the preset with its constants, for a motion or for signals.

        Features of another making are averaged over time only where `smoothing` says so.

        Raises
        ------
        ParameterError
            There is no such preset or constant, or it cannot take the value.
        """
        constants = dict(self.constants)
        if self.features is not None:
            constants.setdefault("smoothing", 0.0)
        return resolve_preset(self.preset, signals=signals, **constants)
