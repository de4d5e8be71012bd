"""Neighbours against the authors' program, on our own features of five recordings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.methods.prepare import compute_motion_features
from kineme.methods.region_growing.neighbors import neighbor_graph
from kineme.methods.region_growing.preset import KRUEGER2017, VOEGELE2014, RegionGrowingPreset

TOLERANCE_CM = 0.05  # to which the features of rebuilt recordings agree


@pytest.mark.parametrize("trial", ["86_01", "86_09", "86_10", "86_11", "86_14"])
@pytest.mark.parametrize(
    ("reference", "preset"),
    [("2014_paper", VOEGELE2014), ("2017_plain", KRUEGER2017.replace(radius=0.302 * 5**0.5))],
    ids=["2014", "2017"],
)
def test_equal_to_the_authors_program(
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
