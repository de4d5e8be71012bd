"""Presets: every constant of each way to segment, in seconds and metres.

``kineme`` is the default; ``voegele2014`` and ``krueger2017`` are the published
methods. Seconds become frames of the working rate in one place,
``Preset.frames``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import is_dataclass
from typing import Any

from kineme._checks import check_type
from kineme.errors import ParameterError
from kineme.methods.base import Preset
from kineme.methods.recurrence.preset import KINEME, ActionPreset
from kineme.methods.region_growing.preset import (
    BASIC_STEPS,
    KRUEGER2017,
    VOEGELE2014,
    RegionPreset,
    Step,
)

__all__ = [
    "BASIC_STEPS",
    "DEFAULT",
    "KINEME",
    "KRUEGER2017",
    "PRESETS",
    "PUBLISHED",
    "VOEGELE2014",
    "ActionPreset",
    "Preset",
    "RegionPreset",
    "Step",
    "constant_help",
    "resolve_preset",
]

PUBLISHED: Mapping[str, RegionPreset] = {p.name: p for p in (VOEGELE2014, KRUEGER2017)}
PRESETS: Mapping[str, Preset] = {KINEME.name: KINEME, **PUBLISHED}
DEFAULT = KINEME.name


def resolve_preset(preset: str | Preset, **overrides: Any) -> Preset:
    """A preset by name or as it is, with some constants changed.

    Raises
    ------
    ParameterError : no preset has that name, or an override does not fit
    """
    if isinstance(preset, str):
        if preset not in PRESETS:
            raise ParameterError(f"no preset {preset!r}; there are {', '.join(PRESETS)}")
        preset = PRESETS[preset]
    check_type(preset, Preset, "preset", f"give one, or the name of one: {', '.join(PRESETS)}")
    for name in overrides:
        others = [other for other, known in PRESETS.items() if hasattr(known, name)]
        if others and not hasattr(preset, name):
            raise ParameterError(
                f"{preset.name} has no parameter {name!r}: it is one of {' and '.join(others)}, "
                f"so choose another preset or leave it out"
            )
    return preset.replace(**overrides)


def constant_help() -> dict[str, str]:
    """What the docstrings of the presets say of each constant."""
    kinds = (ActionPreset, RegionPreset)
    texts = [base.__doc__ or "" for kind in kinds for base in kind.__mro__ if is_dataclass(base)]
    entries = re.findall(r"^    (\w+) : (.+(?:\n        .+)*)", "\n".join(texts), re.MULTILINE)
    return {name: " ".join(text.replace("``", "").split()) for name, text in entries}
