"""Every constant of every preset takes an odd value, and gives a result, or says why not.

The constants of `kineme` are those of `sensors`, which channels are segmented by.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

import kineme
from kineme.methods.base import Preset
from kineme.methods.presets import PRESETS
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
