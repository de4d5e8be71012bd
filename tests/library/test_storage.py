"""Recordings and libraries at URLs."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from library_folders import contents

from kineme.errors import ParameterError, ReadError
from kineme.library import Library, build

fsspec = pytest.importorskip("fsspec", reason="fsspec is not installed")
pytest.importorskip("upath", reason="universal_pathlib is not installed")


@pytest.fixture
def store(
    takes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[fsspec.AbstractFileSystem]:
    monkeypatch.setenv("KINEME_CACHE", str(tmp_path / "cache"))
    memory = fsspec.filesystem("memory")
    memory.put(str(takes), "/data/takes", recursive=True)
    yield memory
    memory.rm("/data", recursive=True)


def test_a_library_in_a_store_is_the_same_as_on_a_disk(
    store: fsspec.AbstractFileSystem, built: Path, tmp_path: Path
) -> None:
    made = build("memory://data/takes", "memory://data/lib")
    assert [str(path) for path in made.failed] == ["memory://data/takes/broken.bvh"]
    store.get("/data/lib", str(tmp_path / "lib"), recursive=True)
    pieces = {name: held for name, held in contents(built).items() if "pieces" in name}
    assert {k: v for k, v in contents(tmp_path / "lib").items() if "pieces" in k} == pieces

    library, local = Library("memory://data/lib"), Library(built)
    hits = library.search("walk.bvh", 2.0, 3.0, top=5)
    assert hits == local.search("walk.bvh", 2.0, 3.0, top=5)
    assert library.search("memory://data/takes/walk.bvh", 2.0, 3.0, top=5) == hits
    library.name(hits[0].cluster, "walk")
    assert Library("memory://data/lib").search("walk.bvh", 2.0, 3.0, top=1)[0].label == "walk"

    store.rm("/data/takes/jacks.bvh")
    again = build((), "memory://data/lib")
    assert (again.new, again.removed) == (0, 1)
    assert Library("memory://data/lib").recordings["recording"] == ["walk.bvh", "wrist.csv"]
    assert len(store.ls("/data/lib/tables")) == 1


def test_takes_in_a_store_fill_a_library_here(
    store: fsspec.AbstractFileSystem, tmp_path: Path
) -> None:
    build("memory://data/takes/wrist.csv", tmp_path / "lib")
    library = Library(tmp_path / "lib")
    assert library.recordings["path"] == ["memory://data/takes/wrist.csv"]
    assert library.read("wrist.csv").provenance.path == "memory://data/takes/wrist.csv"
    shutil.rmtree(tmp_path / "lib")


def test_what_no_store_holds_is_one_sentence(store: fsspec.AbstractFileSystem) -> None:
    with pytest.raises(ReadError, match="is not a library"):
        Library("memory://data/nothing")
    with pytest.raises(ParameterError, match="cannot be reached"):
        Library("nowhere://bucket/lib")
