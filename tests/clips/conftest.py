"""The bundled recording and its truth, which tests only read."""

from __future__ import annotations

import pytest

import kineme
from kineme.recordings import Motion


@pytest.fixture(scope="session")
def motion() -> Motion:
    return kineme.read(kineme.bundled_recording())


@pytest.fixture(scope="session")
def truth() -> kineme.Segmentation:
    return kineme.read_segments(kineme.bundled_recording().with_suffix(".json"))


@pytest.fixture(scope="session")
def repetitions(motion: Motion, truth: kineme.Segmentation) -> list[Motion]:
    rows = truth.primitives
    return [motion[row.start_frame : row.stop_frame] for row in rows if row.kind == "primitive"]
