"""Every parameter of a preset is in the provenance of its results."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from types import NoneType
from typing import Any, Literal, get_args, get_origin

import pytest
from presets import OWN

import kineme
from kineme.methods import PRESETS, Preset
from kineme.methods.base import Constant


@pytest.fixture(scope="module")
def motion() -> kineme.Motion:
    """Return the first six seconds of the bundled recording."""
    return kineme.read(kineme.bundled_recording())[0:360]


@pytest.mark.parametrize("name", [*OWN, "sensors"])
def test_each_field_changed_is_in_the_provenance(name: str, motion: kineme.Motion) -> None:
    preset = PRESETS[name]
    known = {each.name: each for each in preset.constants()}
    assert {each.name for each in fields(preset)} == {"name", "help", "unit", *known}
    usual = parameters(motion, preset)
    assert usual == {"unit": preset.unit, **as_json(preset.parameters())}
    changed = {each.name: other_value(each) for each in known.values()}
    for each in known.values():
        assert changed[each.name] != each.value, each.name
    found = parameters(motion, preset.replace(**changed))  # all at once: a run for each takes long
    assert found == {"unit": preset.unit, **as_json(changed)}


def test_the_unit_and_the_name_are_there_too(motion: kineme.Motion) -> None:
    other = replace(PRESETS["krueger2017"].for_signals(), name="mine")
    signals = kineme.Signals(motion.positions[:, 0], motion.fps)
    provenance = kineme.segment(signals, preset=other).provenance
    assert provenance["preset"] == "mine"
    assert provenance["parameters"]["unit"] == "standard deviations"


def parameters(motion: kineme.Motion, preset: Preset) -> dict[str, Any]:
    found: dict[str, Any] = kineme.segment(motion, preset=preset).provenance["parameters"]
    return found


def as_json(value: Any) -> Any:
    """Convert tuples to lists, as in a stored provenance."""
    return json.loads(json.dumps(value))


def other_value(constant: Constant) -> Any:
    """Return another allowed value of the constant."""
    value, limits = constant.value, constant.limits
    hint = next(kind for kind in (*get_args(constant.hint), constant.hint) if kind is not NoneType)
    if get_origin(constant.hint) is Literal:
        return next(other for other in get_args(constant.hint) if other != value)
    if isinstance(value, bool):
        return not value
    if isinstance(value, tuple):
        longer = len(value) > 2 and Ellipsis in get_args(constant.hint)
        if not longer:
            larger = all(limits is None or limits.allow(each + 1) for each in value)
            return tuple(each + 1 if larger else 0.95 * each for each in value)
        if not isinstance(value[0], float):  # pairs of numbers
            return value[:-1]
        first = next(x for x in (0.95 * value[0], 0.5) if x != value[0])
        return (first, *value[1:])
    if value is None:
        return hint(4)
    near = (value - 1, value + 1) if hint is int else (0.95 * value, 0.5)
    allowed = (other for other in near if limits is None or limits.allow(other))
    return next(other for other in allowed if other != value)
