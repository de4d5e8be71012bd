"""For the tests of labels: where laws write their examples."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for all examples of all laws of a file: each writes over the one before."""
    return tmp_path_factory.mktemp("tables")
