"""For all tests: where the real recordings are, and how laws are tried."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# How long an example takes is the machine's affair. All else is as hypothesis has it here;
# ``pytest --hypothesis-profile=thorough`` tries each law on ten times as many examples.
for profile, examples in (("kineme", 50), ("thorough", 500)):
    settings.register_profile(
        profile,
        settings(),
        deadline=None,
        suppress_health_check=[HealthCheck.too_slow],
        max_examples=examples,
    )
settings.load_profile("kineme")


def find_data_dir() -> Path | None:
    """The folder of recordings: ``KINEME_DATA``, else ``../shared/data``, else None."""
    named = os.environ.get("KINEME_DATA")
    folder = Path(named) if named else Path(__file__).resolve().parents[2] / "shared" / "data"
    return folder if folder.is_dir() else None


@pytest.fixture(scope="session")
def data_dir() -> Path:
    folder = find_data_dir()
    if folder is None:
        pytest.skip("no recordings: set KINEME_DATA to the folder that holds cmu86/ and the others")
    return folder
