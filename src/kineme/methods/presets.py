"""The presets there are: ours, and those that other packages register.

``kineme`` is the default, and stands for ``sensors``, the same method with other
constants, where it is given signals; ``voegele2014`` and ``krueger2017`` are the
published methods; the others are what results are compared with.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

from kineme._plugins import plugins
from kineme.errors import ParameterError
from kineme.methods.base import Preset
from kineme.methods.baselines.presets import BASELINES
from kineme.methods.constants import unknown
from kineme.methods.kineme.preset import KINEME, SENSORS
from kineme.methods.region_growing.preset import KRUEGER2017, VOEGELE2014, RegionGrowingPreset

GROUP = "kineme.presets"
"""The entry points by which other packages name theirs."""
DEFAULT = KINEME.name
FOR_SIGNALS = {KINEME.name: SENSORS.name}
"""What a name stands for where it is given with signals."""

PUBLISHED: Mapping[str, RegionGrowingPreset] = MappingProxyType(
    {preset.name: preset for preset in (VOEGELE2014, KRUEGER2017)}
)
_known: dict[str, Preset] = {
    preset.name: preset for preset in (KINEME, SENSORS, *PUBLISHED.values(), *BASELINES)
}
_looked_up: list[bool] = []


def register(preset: Preset) -> None:
    """Make a preset known by its name: to `kineme.segment`, the command line and the studio.

    Parameters
    ----------
    preset : Preset
        In place of one of that name that was known before.

    Raises
    ------
    ParameterError
        Something else than a preset.
    """
    if not isinstance(preset, Preset):
        raise ParameterError(f"register takes a preset, not {type(preset).__name__}")
    _known[preset.name] = preset


class _Presets(Mapping[str, Preset]):
    """The presets by name, the default first; those of other packages are looked up when used."""

    def __getitem__(self, name: str) -> Preset:
        _look_up()
        return _known[name]

    def __iter__(self) -> Iterator[str]:
        _look_up()
        return iter(_known)

    def __len__(self) -> int:
        _look_up()
        return len(_known)

    def __repr__(self) -> str:
        return f"<presets {', '.join(self)}>"


PRESETS: Mapping[str, Preset] = _Presets()


def resolve_preset(preset: str | Preset, *, signals: bool = False, **overrides: Any) -> Preset:
    """A preset by name or as it is, with some constants changed.

    Parameters
    ----------
    preset : str or Preset
        By name it may be another for signals: ``sensors`` for ``kineme``.
    signals : bool
        Whether it is for channels: its lengths become standard deviations of them, and so
        those in `overrides` are taken.
    **overrides
        Constants to change.

    Returns
    -------
    Preset

    Raises
    ------
    ParameterError
        No preset has that name, or an override does not fit.

    Examples
    --------
    >>> from kineme.methods import resolve_preset
    >>> resolve_preset("kineme", min_action=2.0).min_action
    2.0
    """
    if isinstance(preset, str):
        if preset not in PRESETS:
            raise ParameterError(f"no preset {preset!r:.60}; {unknown(preset, PRESETS)}")
        chosen = PRESETS[preset]
        if signals and preset in FOR_SIGNALS:
            chosen = PRESETS[FOR_SIGNALS[preset]]
    elif isinstance(preset, Preset):
        chosen = preset
    else:
        raise ParameterError(
            f"a preset is a name or a Preset, not {type(preset).__name__}: "
            f"there are {', '.join(PRESETS)}"
        )
    for name in overrides:
        others = [other for other, known in PRESETS.items() if hasattr(known, name)]
        if others and not hasattr(chosen, name):
            raise ParameterError(
                f"{chosen.name} has no parameter {name!r}: it is one of {' and '.join(others)}, "
                f"so choose another preset or leave it out"
            )
    return (chosen.for_signals() if signals else chosen).replace(**overrides)


def _look_up() -> None:
    """Register what installed packages name as theirs, once, even where they look in turn."""
    if _looked_up:
        return
    _looked_up.append(True)
    for preset in plugins(GROUP):
        register(preset)
