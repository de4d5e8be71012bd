"""A recording whose repetitions are known."""

from __future__ import annotations

import pytest

from kineme.datasets import Action, synthesize
from kineme.datasets.synthetic import SyntheticRecording


@pytest.fixture(scope="session")
def walks() -> SyntheticRecording:
    """Walking, squats, walking again."""
    return synthesize([Action("walk", 6), Action("squat", 5), Action("walk", 5)], fps=60, seed=3)
