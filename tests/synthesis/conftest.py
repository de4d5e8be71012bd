"""The bundled recording and its motion graph, for all tests of synthesis."""

from __future__ import annotations

import pytest

import kineme
from kineme.datasets import bundled_recording
from kineme.datasets.bundled import bundled_truth
from kineme.recordings import Motion
from kineme.synthesis import MotionGraph, motion_graph


@pytest.fixture(scope="session")
def exercises() -> Motion:
    return kineme.read(bundled_recording(), unit="cm")


@pytest.fixture(scope="session")
def graph(exercises: Motion) -> MotionGraph:
    return motion_graph([exercises], [kineme.read_segments(bundled_truth())])
