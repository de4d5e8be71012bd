"""The benchmark of sets: one vocabulary for clusters of single recordings; rivals as presets."""

from __future__ import annotations

import numpy as np

import kineme
from _one_mapping import described, one_vocabulary
from _rival_presets import RIVALS
from kineme.evaluation.comparison import best_mapping, compare
from kineme.methods.base import Preset

FPS = 20.0


def still_and_shaken(turns: list[bool]) -> tuple[kineme.Signals, kineme.Segmentation]:
    """Ten seconds each of lying still and being shaken, and the truth of it."""
    rng = np.random.default_rng(0)
    n = int(10 * FPS)
    rows = [[5.0, 0.0] + (3.0 if on else 0.1) * rng.standard_normal((n, 2)) for on in turns]
    edges = n * np.arange(len(turns) + 1)
    columns = {
        "level": ["activity"] * len(turns),
        "kind": ["activity"] * len(turns),
        "start_frame": edges[:-1],
        "stop_frame": edges[1:],
        "cluster": np.arange(len(turns)),
        "label": [str(on) for on in turns],
    }
    truth = kineme.Segmentation.from_columns(columns, n_frames=int(edges[-1]), fps=FPS)
    return kineme.Signals(np.concatenate(rows), FPS), truth


def test_clusters_of_single_recordings_become_one_vocabulary() -> None:
    pairs = [still_and_shaken(turns) for turns in ([True, False], [False, True], [False, True])]
    classes: dict[str, int] = {}
    compared = [compare(truth, truth, classes=classes) for _, truth in pairs]
    shared = one_vocabulary(compared, [described(*pair) for pair in pairs], len(classes))
    mapping = best_mapping(shared)
    for one in shared:
        assert [mapping[cluster] for cluster in one.found.tolist()] == one.truth.tolist()


def test_rivals_are_presets_that_name_their_package() -> None:
    assert all(isinstance(rival, Preset) and rival.package for rival in RIVALS)
    assert len({rival.name for rival in RIVALS}) == len(RIVALS)
