"""Every constant of every preset takes an odd value, and gives a result, or says why not."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

import kineme
from kineme.errors import KinemeError
from kineme.methods.base import Preset
from kineme.methods.presets import PRESETS

ODD = (
    0, -1, 1, 2, 3, 7, 1000, 2**31, 2**63, -(2**63), 10**400, 0.0, -0.0, 1e-300, 1e-9, 0.5, 1.5,
    1e3, 1e9, 1e300, float("nan"), float("inf"), -float("inf"), True, False, None, "", "odd", (),
    (1e9,), (0.0, 1e300), [1, 2], {}, object(), np.float64(1e300), np.zeros(3),
)  # fmt: skip


def recording() -> kineme.Signals:
    times = np.arange(120) / 20
    return kineme.Signals(np.sin(times[:, None] * (4.0, 6.0)), 20)


@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
@pytest.mark.parametrize("name", list(PRESETS))
def test_every_constant_with_odd_values(name: str) -> None:
    preset, signals = PRESETS[name], recording()
    surprises = []
    for constant in preset.constants():
        taken: list[Preset] = []
        for value in ODD:
            with noted(surprises, constant.name, value):
                taken.append(preset.replace(**{constant.name: value}))
        for changed in extremes(taken, constant.name):
            with noted(surprises, constant.name, getattr(changed, constant.name)):
                kineme.segment(signals, preset=changed)
    assert not surprises, "\n".join(surprises)


def extremes(taken: list[Preset], name: str) -> list[Preset]:
    """Of the presets with a number there the least two and the greatest two; all others."""
    numbers, others = [], []
    for preset in taken:
        value = getattr(preset, name)
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        (numbers if number else others).append(preset)
    numbers.sort(key=lambda preset: getattr(preset, name))
    return others + (numbers if len(numbers) < 5 else numbers[:2] + numbers[-2:])


@contextmanager
def noted(surprises: list[str], name: str, value: object) -> Iterator[None]:
    """Keep what is raised, but for an error of the package in one line."""
    try:
        yield
    except KinemeError as error:
        if "\n" in str(error):
            surprises.append(f"{name}={value!r:.20}: several lines")
    except Exception as error:  # noqa: BLE001 (which is what is looked for)
        surprises.append(f"{name}={value!r:.20}: {type(error).__name__}: {error}")
