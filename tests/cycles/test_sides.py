"""Left beside right, in the same repetitions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kineme
from kineme.cycles import Cycles, compare_sides
from kineme.cycles.sides import MEASURES, sides_of
from kineme.datasets.synthetic import SyntheticRecording


@pytest.fixture(scope="module")
def cycles(walks: SyntheticRecording) -> Cycles:
    return kineme.cycles(walks.motion, walks.truth, channels=["knee_*", "trunk_lean"])


def test_channels_of_two_sides_are_told_by_their_names() -> None:
    names = ("knee_l", "knee_r", "LeftFoot.speed", "RightFoot.speed", "left_gyr", "trunk_lean",
             "total", "totar", "hip_r")  # fmt: skip
    assert sides_of(names) == [("knee_l", "knee_r"), ("LeftFoot.speed", "RightFoot.speed")]


def test_what_differs_by_a_tenth_has_that_index(cycles: Cycles) -> None:
    left = cycles.columns["knee_l.range"]
    sides = compare_sides(replace(cycles, columns={**cycles.columns, "knee_r.range": 0.9 * left}))
    of_range = sides["measure"] == "range"
    assert sides["symmetry_index"][of_range] == pytest.approx(100 * 0.1 / 0.95)
    assert np.isnan(sides["symmetry_index"][~of_range]).all()
    assert (sides["low"][of_range] > 0).all()


def test_turned_sides_differ_the_other_way(cycles: Cycles) -> None:
    turned = {"knee_l": "knee_r", "knee_r": "knee_l"}
    columns = {
        ".".join([turned.get(name.split(".")[0], name.split(".")[0]), *name.split(".")[1:]]): values
        for name, values in cycles.columns.items()
    }
    there, back = compare_sides(cycles), compare_sides(replace(cycles, columns=columns))
    assert len(there["n"]) == len(MEASURES) * len(cycles.groups)
    assert there["difference"] == pytest.approx(-back["difference"], nan_ok=True)
    assert there["low"] == pytest.approx(-back["high"], nan_ok=True)


def test_one_cycle_has_no_bounds_and_none_no_means(cycles: Cycles) -> None:
    first = np.flatnonzero(cycles.used())[0]
    alone = compare_sides(cycles.select(np.arange(len(cycles)) == first))
    assert (alone["n"] == 1).all()
    assert np.isnan(alone["low"]).all()
    none = compare_sides(cycles.exclude(range(len(cycles))))
    assert (none["n"] == 0).all()
    assert np.isnan(none["left"]).all()
