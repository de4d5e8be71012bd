"""The `kineme` method on recordings: results match the truth; size and frame rate do not matter."""

from __future__ import annotations

from functools import cache
from itertools import groupby
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kineme
from kineme.datasets import bundled_recording, bundled_truth, random_recording
from kineme.evaluation import evaluate_segmentation
from kineme.methods.segmenter import segment
from kineme.recordings import Motion
from kineme.recordings.operations import resample, scale
from kineme.segments.segmentation import Segmentation
from kineme_reproduction.benchmark import mean
from kineme_reproduction.trials import find_folder, load_trials


@cache
def recording(seed: int) -> Motion:
    return random_recording(seed).motion


@cache
def found_in(seed: int) -> Segmentation:
    return segment(recording(seed))


def counts(found: Segmentation) -> list[int]:
    inside = found.primitives.kind == "primitive"
    parents = found.primitives.activity[inside].tolist()
    return [len(list(run)) for _, run in groupby(parents)]


def test_the_bundled_recording_is_found_as_it_was_made() -> None:
    truth = kineme.read_segments(bundled_truth())
    found = segment(kineme.read(bundled_recording()))
    for part in (truth, found):
        activities = part.activities
        moving = activities.kind == "activity"
        assert activities.cluster[moving].tolist() == [0, 1, 0, 2, 3, 4, 5]
        assert np.abs(np.subtract(counts(part), [5, 4, 4, 5, 4, 6, 4])).max() <= 1


def test_real_recordings_are_found_as_people_annotated_them(data_dir: Path) -> None:
    """Return the five available trials of subject 86, of fourteen in the paper."""
    names = ["86_01", "86_09", "86_10", "86_11", "86_14"]
    scores = []
    for trial in load_trials(find_folder(data_dir), names):
        found = segment(trial.motion)
        scores.append(evaluate_segmentation(trial.truth, found))
        assert scores[-1]["one_to_one_agreed"] >= 0.6, trial.name
        assert 0.75 <= scores[-1]["cluster_ratio"] <= 1.4, trial.name
        assert 0.6 <= scores[-1]["border_ratio"] <= 1.4, trial.name
        assert scores[-1]["border_f1"] >= 0.6, trial.name
    means = mean(scores)
    assert means["border_f1"] >= 0.8
    assert means["one_to_one_agreed"] >= 0.85
    assert means["cluster_ratio"] <= 1.4


@given(st.integers(0, 3), st.floats(0.5, 2))
@settings(max_examples=8)
def test_the_size_of_a_body_changes_no_cut(seed, factor) -> None:
    found, expected = segment(scale(recording(seed), factor)), found_in(seed)
    for name in ("start_frame", "stop_frame", "kind", "cluster"):
        np.testing.assert_array_equal(
            getattr(found.table, name), getattr(expected.table, name), name
        )


@pytest.mark.parametrize("fps", [60.0, 240.0])
def test_the_frame_rate_of_the_source_changes_no_border(fps: float) -> None:
    for seed in range(4):
        found, expected = segment(resample(recording(seed), fps)), found_in(seed)
        assert found.activities.cluster.tolist() == expected.activities.cluster.tolist()
        for name in ("start_s", "stop_s"):
            np.testing.assert_allclose(
                getattr(found.activities, name), getattr(expected.activities, name), atol=0.1
            )
        assert counts(found) == counts(expected)
