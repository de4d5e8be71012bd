"""Provide fixtures for all tests, and profiles for hypothesis."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from kineme._util import parallel
from labelled_corpus import make_corpus

# No deadline, as run times vary. ``pytest --hypothesis-profile=thorough`` tries ten
# times as many examples.
for profile, examples in (("kineme", 50), ("thorough", 500)):
    settings.register_profile(
        profile,
        settings(),
        deadline=None,
        suppress_health_check=[HealthCheck.too_slow],
        max_examples=examples,
    )
settings.load_profile("kineme")

HERE = Path(__file__).parent


SLOWEST_FIRST = ("fuzz", "browser", "test_one_place.py", "test_docs.py", "cli", "studio", "methods")
"""Slow tests, started first so that parallel workers end at about the same time."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    def turn(item: pytest.Item) -> int:
        place = item.path.relative_to(HERE).parts[0]
        return SLOWEST_FIRST.index(place) if place in SLOWEST_FIRST else len(SLOWEST_FIRST)

    items.sort(key=turn)


COMPILE = "import importlib, sys; [importlib.import_module(name) for name in sys.argv[1:]]"


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes() -> None:
    """Compile all kernels once, before workers and their servers start."""
    files = [
        path.relative_to(sources)
        for sources in (HERE.parent / "src", HERE.parent / "reproduction")
        for path in sorted(sources.rglob("_*kernels.py"))
    ]
    names = [".".join(path.with_suffix("").parts) for path in files]
    halves = [[sys.executable, "-c", COMPILE, *names[i::2]] for i in range(2)]
    for half in [subprocess.Popen(command) for command in halves]:
        half.wait()  # kernels that fail to compile fail in their tests


def find_data_dir() -> Path | None:
    """Return the folder of recordings: ``KINEME_DATA``, else ``../shared/data``, else None."""
    named = os.environ.get("KINEME_DATA")
    folder = Path(named) if named else Path(__file__).resolve().parents[2] / "shared" / "data"
    return folder if folder.is_dir() else None


@pytest.fixture(scope="session")
def data_dir() -> Path:
    folder = find_data_dir()
    if folder is None:
        pytest.skip("no recordings: set KINEME_DATA to the folder that holds cmu86/ and the others")
    return folder


@pytest.fixture(scope="module")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder of labelled recordings that tests must not change."""
    return make_corpus(tmp_path_factory.mktemp("corpus"))


@pytest.fixture
def set_threads(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Return a function that sets the number of threads for the rest of the test."""

    def change(threads: int) -> None:
        monkeypatch.setattr(parallel, "_get_pool", cache(parallel._get_pool.__wrapped__))
        monkeypatch.setattr(parallel, "count_threads", lambda: threads)

    return change
