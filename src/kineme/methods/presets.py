"""Registry of presets: built-in ones, and those that other packages register.

``kineme`` is the default. For signals it is replaced by ``sensors``: the same method with
other constants. ``series`` adapts ``sensors`` to the pace of the signals.
``voegele2014`` and ``krueger2017`` are the published methods.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from kineme._util.checks import Registry
from kineme.errors import ParameterError
from kineme.methods.base import Preset, suggest_names
from kineme.methods.kineme.preset import KINEME, SENSORS
from kineme.methods.region_growing.preset import KRUEGER2017, VOEGELE2014, RegionGrowingPreset

DEFAULT = KINEME.name
FOR_SIGNALS = {KINEME.name: SENSORS.name}
"""Presets that replace others if the recording consists of signals, by name."""

PUBLISHED: Mapping[str, RegionGrowingPreset] = MappingProxyType(
    {preset.name: preset for preset in (VOEGELE2014, KRUEGER2017)}
)
PRESETS: Registry[Preset] = Registry(
    Preset,
    "preset",
    "kineme.presets",
    home="kineme.methods",
    builtins=(
        "kineme.preset:KINEME",
        "kineme.preset:SENSORS",
        "kineme.preset:SERIES",
        "region_growing.preset:VOEGELE2014",
        "region_growing.preset:KRUEGER2017",
    ),
)
"""Presets by name; the default is the first."""


def register(preset: Preset, *, replace: bool = False) -> None:
    """Register a preset under its name for `kineme.segment`, the command line and the studio.

    Parameters
    ----------
    preset : Preset
    replace : bool
        Whether it may replace a preset of the same name.

    Raises
    ------
    ParameterError
        A preset of this name exists, or the argument is not a Preset.
    """
    PRESETS.register(preset, replace=replace)


def resolve_preset(preset: str | Preset, *, signals: bool = False, **overrides: Any) -> Preset:
    """Return the preset, or the one with this name, with some constants changed.

    Parameters
    ----------
    preset : str or Preset
        For signals, the name ``kineme`` selects ``sensors``.
    signals : bool
        Whether it is for signals. Then its lengths, and those in `overrides`, are in standard
        deviations of channels.
    **overrides
        Constants to change.

    Returns
    -------
    Preset

    Raises
    ------
    ParameterError
        No preset has this name, or an override is not allowed.

    Examples
    --------
    >>> from kineme.methods import resolve_preset
    >>> resolve_preset("kineme", min_action=2.0).min_action
    2.0
    """
    if isinstance(preset, str):
        if preset not in PRESETS:
            raise ParameterError(f"no preset {preset!r:.60}; {suggest_names(preset, PRESETS)}")
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
    # A constant of another method gets a specific message.
    for name in overrides:
        others = [other for other, candidate in PRESETS.items() if hasattr(candidate, name)]
        if others and not hasattr(chosen, name):
            raise ParameterError(
                f"{chosen.name} has no parameter {name!r}: it belongs to "
                f"{' and '.join(others)}, so choose another preset or leave it out"
            )
    return (chosen.for_signals() if signals else chosen).replace(**overrides)
