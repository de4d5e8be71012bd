"""Constants of presets: odd values give a result or say why not; all are in the provenance."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from functools import partial
from types import NoneType
from typing import Any, Literal, get_args, get_origin

import numpy as np
import pytest
from presets import OWN

import kineme
from kineme.errors import ParameterError
from kineme.methods import PRESETS, Preset, resolve_preset
from kineme.methods.base import Constant
from odd_values import ODD, surprise


def recording() -> kineme.Signals:
    times = np.arange(120) / 20
    return kineme.Signals(np.sin(times[:, None] * (4.0, 6.0)), 20)


@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
@pytest.mark.parametrize("name", [name for name in PRESETS if name != "kineme"])
def test_every_constant_with_odd_values(name: str) -> None:
    preset, signals = PRESETS[name], recording()
    surprises = []
    for constant in preset.constants():
        taken: list[Preset] = []
        for value in ODD:
            replace = partial(preset.replace, **{constant.name: value})
            said = surprise(lambda take=taken.append, replace=replace: take(replace()))
            surprises.append((constant.name, value, said))
        for each in extremes(taken, constant.name):
            said = surprise(lambda each=each: kineme.segment(signals, preset=each))
            surprises.append((constant.name, getattr(each, constant.name), said))
    assert not [each for each in surprises if each[-1]]


def extremes(taken: list[Preset], name: str) -> list[Preset]:
    """Choose presets with the least and the greatest value of a number, and all others."""
    numbers, others = [], []
    for preset in taken:
        value = getattr(preset, name)
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        (numbers if number else others).append(preset)
    numbers.sort(key=lambda preset: getattr(preset, name))
    return others + (numbers if len(numbers) < 3 else [numbers[0], numbers[-1]])


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


NAN = float("nan")


@pytest.mark.parametrize(
    ("preset", "name", "value"),
    [("kineme", "rate", 0), ("kineme", "averaging", -1.0), ("kineme", "segment_cost", NAN),
     ("kineme", "segment_cost", -0.1), ("kineme", "max_clusters", 0),
     ("kineme", "two_movements", 1.5), ("kineme", "chance_count", 0),
     ("kineme", "min_recurrence", 0), ("kineme", "bands", (0.0, -1.0)), ("kineme", "radius", 0.64),
     ("krueger2017", "radius", 0), ("krueger2017", "radius", NAN),
     ("krueger2017", "path_separation", 0), ("krueger2017", "path_separation", -1.0),
     ("krueger2017", "path_separation", NAN), ("krueger2017", "growth_gap", -1),
     ("krueger2017", "coverage", 1.5), ("krueger2017", "symmetry", 0),
     ("krueger2017", "bundling", 0), ("krueger2017", "max_slope", 0.5),
     ("krueger2017", "connection", "loose"), ("krueger2017", "raduis", 1.0),
     ("krueger2017", "name", "mine")],
)  # fmt: skip
def test_a_constant_out_of_range_is_named(preset: str, name: str, value: object) -> None:
    with pytest.raises(ParameterError, match=name):
        resolve_preset(preset, **{name: value})


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
