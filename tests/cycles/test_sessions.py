"""Two sessions side by side: what changed, and how sure that is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import ttest_ind

import kineme
from kineme.cycles import Cycles, compare_curves, compare_sessions
from kineme.errors import ParameterError


@pytest.fixture(scope="module")
def cycles(walks) -> Cycles:
    return kineme.cycles(walks.motion, walks.truth, channels=["knee_*"])


def test_a_session_beside_itself_has_not_changed(cycles) -> None:
    table = compare_sessions(cycles, cycles)
    np.testing.assert_array_equal(np.nan_to_num(table["difference"]), 0)
    assert table["first_n"].tolist() == table["second_n"].tolist()
    curves = compare_curves(cycles, cycles)
    np.testing.assert_allclose(curves["difference"], 0)
    assert len(curves["percent"]) == 2 * 2 * 101


def test_differences_and_bounds_are_those_of_welch(cycles) -> None:
    duration = cycles.columns["duration_s"]
    slow = duration * np.where(np.arange(len(cycles)) % 2, 1.2, 1.3)
    later = replace(cycles, columns={**cycles.columns, "duration_s": slow})
    table = compare_sessions(cycles, later)
    row = np.flatnonzero((table["group"] == "squat") & (table["measure"] == "duration_s"))[0]
    used = cycles.used() & (cycles.columns["group"] == "squat")
    test = ttest_ind(slow[used], duration[used], equal_var=False)
    bounds = test.confidence_interval()
    assert table["difference"][row] == pytest.approx(slow[used].mean() - duration[used].mean())
    assert table["low"][row] == pytest.approx(bounds.low)
    assert table["high"][row] == pytest.approx(bounds.high)


def test_curves_are_compared_group_by_group_whatever_their_order(cycles) -> None:
    later = replace(cycles, curves=cycles.curves + 5)
    turned = later.select(np.ones(len(later), bool))
    order = np.argsort(turned.columns["group"], kind="stable")  # squats first
    columns = {name: column[order] for name, column in turned.columns.items()}
    turned = replace(turned, columns=columns, curves=turned.curves[order])
    assert turned.groups != cycles.groups
    np.testing.assert_allclose(compare_curves(cycles, turned)["difference"], 5)
    table = compare_sessions(cycles, turned)
    assert np.nan_to_num(table["difference"]).tolist() == [0] * len(table["difference"])


def test_what_cannot_be_compared_is_refused(walks, cycles) -> None:
    other = kineme.cycles(walks.motion, walks.truth, channels=["hip_l"])
    with pytest.raises(ParameterError, match="the same channels"):
        compare_sessions(cycles, other)
    with pytest.raises(ParameterError, match="no group is in both sessions: walk and squat"):
        compare_sessions(*(cycles.select(cycles.columns["group"] == g) for g in ("walk", "squat")))
    with pytest.raises(ParameterError, match="curves of 101 and of 51 points"):
        compare_curves(
            cycles, kineme.cycles(walks.motion, walks.truth, channels=["knee_*"], points=51)
        )
    with pytest.raises(ParameterError, match="a mask of 16"):
        cycles.select(np.array([1]))
