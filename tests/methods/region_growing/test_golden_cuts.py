"""Cuts and clusters against the authors' program, on five recordings (see benchmarks)."""

from __future__ import annotations

from pathlib import Path

import pytest

from agreement import TRIALS, compare

EXACT_2017 = [
    "2017_plain",
    "2017_evaluation_1",
    "2017_evaluation_2",
    "2017_mirrored",
    "2017_bundled as stored",
    "krueger2017 as stored",
]
BUNDLED_2017 = ["2017_bundled", "2017_bundled_mirrored", "krueger2017"]


@pytest.mark.parametrize("trial", TRIALS)
@pytest.mark.parametrize("configuration", EXACT_2017)
def test_2017_is_equal_to_the_authors_program(data_dir: Path, configuration, trial) -> None:
    for level, agreement in compare(data_dir, configuration, trial).items():
        assert agreement.total > 0
        assert agreement.differences == (), level


@pytest.mark.parametrize("configuration", BUNDLED_2017)
def test_with_bundling_of_our_own_cuts_are_within_a_frame(data_dir: Path, configuration) -> None:
    found = [compare(data_dir, configuration, trial) for trial in TRIALS]
    for level in ("activities", "primitives"):
        total = sum(agreements[level].total for agreements in found)
        assert sum(agreements[level].far for agreements in found) <= 0.05 * total


@pytest.mark.parametrize("trial", TRIALS)
@pytest.mark.parametrize("configuration", ["voegele2014", "voegele2014 as run"])
def test_2014_finds_the_activities_of_the_authors_program(
    data_dir: Path, configuration, trial
) -> None:
    assert compare(data_dir, configuration, trial)["activities"].differences == ()


def test_2014_is_near_the_reading_of_its_lost_functions(data_dir: Path) -> None:
    """With the constants of that run; both interpret the paper, so results need not be equal."""
    for level in ("primitives", "clusters"):
        found = [compare(data_dir, "voegele2014 as run", trial)[level] for trial in TRIALS]
        differing = sum(len(agreement.differences) for agreement in found)
        assert differing <= 0.06 * sum(agreement.total for agreement in found), level
