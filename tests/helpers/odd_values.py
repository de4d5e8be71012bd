"""Provide unusual values and a check of the errors that they raise."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kineme.errors import KinemeError

ODD = (
    0, -1, 1, 2, 3, 7, 1000, 2**31, 2**63, -(2**63), 10**400, 0.0, -0.0, 1e-300, 1e-9, 0.5, 1.5,
    1e3, 1e9, 1e300, float("nan"), float("inf"), -float("inf"), True, False, None, "", "odd", (),
    (1e9,), (0.0, 1e300), [1, 2], {}, object(), b"x", np.float64(1e300), np.zeros(3), 1j,
)  # fmt: skip


def surprise(work: Callable[[], object]) -> str:
    """Return what is wrong with the error of a call; empty for none or a one-line `KinemeError`."""
    try:
        work()
    except KinemeError as error:
        return "several lines" if "\n" in str(error) else ""
    except Exception as error:  # noqa: BLE001 (unexpected exceptions are the result)
        return f"{type(error).__name__}: {error}"
    return ""
