"""Neighbours, cuts and clusters against the authors' program, on five recordings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kineme
from agreement import TRIALS, compare
from kineme.methods.prepare import compute_motion_features
from kineme.methods.region_growing.neighbors import neighbor_graph
from kineme.methods.region_growing.preset import KRUEGER2017, VOEGELE2014, RegionGrowingPreset

TOLERANCE_CM = 0.05  # to which the features of rebuilt recordings agree


@pytest.mark.parametrize("trial", TRIALS)
@pytest.mark.parametrize(
    ("reference", "preset"),
    [("2014_paper", VOEGELE2014), ("2017_plain", KRUEGER2017.replace(radius=0.302 * 5**0.5))],
    ids=["2014", "2017"],
)
def test_neighbors_are_those_of_the_authors_program(
    data_dir: Path, reference: str, preset: RegionGrowingPreset, trial: str
) -> None:
    motion = kineme.read(data_dir / "cmu86" / f"{trial}.amc")
    features = 100 * compute_motion_features(motion, preset)
    radius = 100 * preset.radius
    graph = neighbor_graph(features, radius=radius, k=preset.max_neighbors)
    with np.load(data_dir / "cmu86" / "reference" / f"{reference}_{trial}.npz") as stored:
        indices = stored["neighbour_index"].T.astype(int) - 1  # from 1; 0 is none
        their_distances = stored["neighbour_distance"].T
    assert len(graph) == len(indices)
    differing = 0
    for i, (frames, distances) in enumerate(graph):
        theirs = indices[i][indices[i] >= 0]
        differing += len(set(frames) ^ set(theirs))
        farthest = distances[-1] if len(frames) == preset.max_neighbors else radius
        for j in set(frames) ^ set(theirs):
            distance = np.linalg.norm(features[i] - features[j])
            assert distance == pytest.approx(farthest, abs=TOLERANCE_CM), (i, j)
        both, ours_at, theirs_at = np.intersect1d(frames, theirs, return_indices=True)
        np.testing.assert_allclose(
            distances[ours_at], their_distances[i][theirs_at], atol=TOLERANCE_CM
        )
        assert i in both
    assert differing <= graph.n_entries / 500


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
