"""For all tests: where recordings are, real ones and made ones, and how laws are tried."""

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

HERE = Path(__file__).parent


SLOWEST_FIRST = ("fuzz", "browser", "test_one_place.py", "test_docs.py", "cli", "studio", "methods")
"""Files and folders of these tests; else two workers would wait for the last file of one."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    def turn(item: pytest.Item) -> int:
        place = item.path.relative_to(HERE).parts[0]
        return SLOWEST_FIRST.index(place) if place in SLOWEST_FIRST else len(SLOWEST_FIRST)

    items.sort(key=turn)


COMPILE = "import importlib, sys; [importlib.import_module(name) for name in sys.argv[1:]]"


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes() -> None:
    """Compile all kernels before workers, and the servers they start, do it each for itself."""
    files = [
        path.relative_to(sources)
        for sources in (HERE.parent / "src", HERE.parent / "reproduction")
        for path in sorted(sources.rglob("_*kernels.py"))
    ]
    names = [".".join(path.with_suffix("").parts) for path in files]
    halves = [[sys.executable, "-c", COMPILE, *names[i::2]] for i in range(2)]
    for half in [subprocess.Popen(command) for command in halves]:
        half.wait()  # what cannot be compiled fails where it is tested


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


@pytest.fixture(scope="module")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of recordings with labels, which tests only read."""
    return make_corpus(tmp_path_factory.mktemp("corpus"))


@pytest.fixture
def set_threads(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Set how many threads compute what follows in this test."""

    def change(threads: int) -> None:
        monkeypatch.setattr(parallel, "_get_pool", cache(parallel._get_pool.__wrapped__))
        monkeypatch.setattr(parallel, "count_threads", lambda: threads)

    return change
