"""Builds and searches on the workers of a dask scheduler."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from library_folders import contents

from kineme.errors import ParameterError
from kineme.library import Library, build

dask = pytest.importorskip("dask", reason="dask is not installed")
distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")
pytestmark = pytest.mark.filterwarnings("default")  # those of dask are not ours


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as own,
        distributed.Client(own, set_as_default=False) as client,
    ):
        yield client


def test_a_library_is_the_same_though_a_worker_was_killed(
    client: Any, built: Path, takes: Path, tmp_path: Path
) -> None:
    pids = list(client.run(os.getpid).values())

    def kill(told: str) -> None:
        if told.startswith("1 of"):
            os.kill(pids[0], signal.SIGKILL)

    made = build(takes, tmp_path / "library", client=client, progress=kill)
    assert [path.name for path in made.failed] == ["broken.bvh"]
    assert contents(tmp_path / "library") == contents(built)
    library = Library(built)
    hits = library.search("walk.bvh", 2.0, 3.0, top=5, client=client)
    assert hits == library.search("walk.bvh", 2.0, 3.0, top=5)


def test_a_task_that_ends_its_workers_costs_itself_only(client: Any) -> None:
    from kineme.library.executors import DaskCluster

    client.run_on_scheduler(_bear_deaths, most=0)
    assert list(DaskCluster(client).completed(os._exit, [1])) == [(1, None)]
    client.run_on_scheduler(_bear_deaths, most=3)
    assert dict(DaskCluster(client).completed(abs, [-2, -3])) == {-2: 2, -3: 3}


def _bear_deaths(dask_scheduler: Any, most: int) -> None:
    dask_scheduler.allowed_failures = most


def test_an_address_where_nobody_answers_is_said(takes: Path, tmp_path: Path) -> None:
    soon = dask.config.set({"distributed.comm.timeouts.connect": "200ms"})
    with soon, pytest.raises(ParameterError, match="no scheduler responds"):
        build(takes, tmp_path / "library", client="tcp://127.0.0.1:1")
    assert not (tmp_path / "library").exists()
