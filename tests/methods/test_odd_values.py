"""Every constant of every preset takes an odd value, and gives a result, or says why not."""

from __future__ import annotations

import numpy as np
import pytest

import kineme
from kineme.errors import KinemeError
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
        for value in ODD:
            try:
                changed = preset.replace(**{constant.name: value})
                kineme.segment(signals, preset=changed)
            except KinemeError as error:
                if "\n" in str(error):
                    surprises.append(f"{constant.name}={value!r:.20}: several lines")
            except Exception as error:  # noqa: BLE001 (which is what is looked for)
                surprises.append(f"{constant.name}={value!r:.20}: {type(error).__name__}: {error}")
    assert not surprises, "\n".join(surprises)
