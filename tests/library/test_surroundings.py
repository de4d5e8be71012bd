"""Builds among links, pipes and files of others: nothing of theirs is lost, and nothing hangs."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest
from library_folders import contents, write_channels

from kineme.errors import ReadError, WriteError
from kineme.library import Library, build

needs_links = pytest.mark.skipif(sys.platform == "win32", reason="needs links and pipes")


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """A folder with two recordings and their library."""
    (tmp_path / "takes").mkdir()
    for seed, name in enumerate(("a", "b")):
        write_channels(tmp_path / "takes" / f"{name}.csv", seed)
    build(tmp_path / "takes", tmp_path / "lib")
    return tmp_path


@needs_links
@pytest.mark.parametrize("name", ["tables", "pieces"])
@pytest.mark.parametrize("emptied", [False, True], ids=["kept", "new"])
def test_a_link_in_a_library_is_refused_and_its_target_kept(home, name, emptied) -> None:
    foreign = home / "foreign"
    foreign.mkdir()
    (foreign / "thesis.txt").write_text("years of work")
    (foreign / "0123456789abcdef").mkdir()
    (foreign / "0123456789abcdef" / "recordings.parquet").write_bytes(b"somebody's")
    before = contents(foreign)
    shutil.rmtree(home / "lib" / name)
    if emptied:
        (home / "lib" / "library.json").unlink()
    (home / "lib" / name).symlink_to(foreign, target_is_directory=True)
    write_channels(home / "takes" / "c.csv", 2)
    with pytest.raises(WriteError, match=f"{name}: is a link"):
        build(home / "takes", home / "lib")
    assert contents(foreign) == before


@needs_links
def test_a_link_in_place_of_the_tables_of_a_build_is_refused(home) -> None:
    (tables,) = (home / "lib" / "tables").iterdir()
    tables.rename(home / "elsewhere")
    tables.symlink_to(home / "elsewhere", target_is_directory=True)
    before = contents(home / "elsewhere")
    write_channels(home / "takes" / "c.csv", 2)
    with pytest.raises(WriteError, match="is a link"):
        build(home / "takes", home / "lib")
    assert contents(home / "elsewhere") == before


def test_what_others_keep_in_a_library_stays(home) -> None:
    lib = home / "lib"
    (tables,) = (lib / "tables").iterdir()
    others = [
        lib / "notes.txt",
        lib / "tables" / "notes.txt",
        lib / "tables" / "backup" / "copy.parquet",
        lib / "tables" / "@eaDir" / "thumb.jpg",
        tables / "mine.txt",
        lib / "pieces" / "@eaDir" / "thumb.jpg",
        lib / "pieces" / ".ipynb_checkpoints" / "a.npy",
        lib / "pieces" / "mine.npy",
        lib / "pieces" / "mine.parquet",
        lib / "pieces" / f"{'0' * 32}.npy" / "a folder of that name",
        lib / ".kineme-notes",
    ]
    for path in others:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("mine")
    old = {path.name for path in (lib / "pieces").iterdir() if path.suffix == ".parquet"}
    write_channels(home / "takes" / "a.csv", 7)  # another analysis, other tables
    built = build(home / "takes", lib)
    assert built.new == 1
    assert not built.failed
    assert [path.read_text() for path in others] == ["mine"] * len(others)
    # What kineme made and does not need any more is gone.
    now = {path.name for path in (lib / "pieces").iterdir() if path.suffix == ".parquet"}
    assert len(now - {"mine.parquet"}) == 2
    assert now != old
    assert sorted(path.name for path in tables.iterdir()) == ["mine.txt"]
    assert len(Library(lib).recordings["recording"]) == 2


@needs_links
def test_a_pipe_that_was_a_recording_is_refused_at_once(home) -> None:
    shutil.copy(home / "takes" / "a.csv", home / "late.csv")
    build(home / "late.csv", home / "lib")
    (home / "late.csv").unlink()
    os.mkfifo(home / "late.csv")
    failed = build((), home / "lib").failed
    assert "is a pipe or a device" in failed[home / "late.csv"]


@needs_links
def test_a_pipe_among_the_analyses_is_not_waited_for(home) -> None:
    for path in (home / "lib" / "pieces").glob("*.npy"):
        path.unlink()
        os.mkfifo(path)
    write_channels(home / "takes" / "c.csv", 2)
    with pytest.raises(ReadError, match=r"\.npy: is damaged: remove it and build"):
        build(home / "takes", home / "lib")
