"""The baselines are presets like any other: on bodies, on signals, and told what they need."""

from __future__ import annotations

import numpy as np
import pytest

import kineme
from kineme.datasets import random_recording
from kineme.errors import ParameterError
from kineme_reproduction.baselines.presets import BASELINES, ClassCountPreset

NAMES = [preset.name for preset in BASELINES]
TOLD = [preset.name for preset in BASELINES if isinstance(preset, ClassCountPreset)]


def told(name: str) -> dict[str, int]:
    return {"n_classes": 3} if name in TOLD else {}


@pytest.mark.parametrize("name", NAMES)
def test_a_baseline_segments_a_body_and_says_how_it_saw_it(name: str) -> None:
    motion = random_recording(3).motion[:3000]
    found = kineme.segment(motion, preset=name, **told(name))
    assert found.activities.stop_frame[-1] == motion.n_frames
    assert len(found.activities) > 1
    assert found.provenance["method"] == "baselines"
    assert "segmented by the positions of head, hands and feet" in found.provenance["notes"][-2]


@pytest.mark.parametrize("name", NAMES)
def test_a_baseline_segments_signals(name: str) -> None:
    time = np.arange(1200) / 60
    x = np.column_stack([np.sin(6 * time), np.where(time < 10, np.cos(6 * time), 0.1 * time)])
    x += np.random.default_rng(0).normal(0, 0.01, x.shape)
    found = kineme.segment(kineme.Signals(x, 60), preset=name, **told(name))
    assert found.activities.stop_frame[-1] == 1200


@pytest.mark.parametrize("name", TOLD)
def test_what_has_to_be_told_is_asked_for(name: str) -> None:
    with pytest.raises(ParameterError, match=f"{name} has to be told the number of actions"):
        kineme.segment(random_recording(3).motion, preset=name)


def test_uniform_cuts_are_as_far_apart_as_asked() -> None:
    motion = random_recording(3).motion
    found = kineme.segment(motion, preset="uniform", interval=2.0)
    gaps = np.diff(found.cuts()) / motion.fps
    np.testing.assert_allclose(gaps, 2.0, atol=1 / motion.fps)
