"""Writing that breaks off: nothing torn, nothing left behind, one error."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import pytest

from kineme._util import files as _files
from kineme._util.files import atomic_folder, atomic_write
from kineme.errors import WriteError

HOUR = 3600


@pytest.mark.parametrize(("age_s", "kept"), [(2 * HOUR, False), (HOUR / 2, True)])
def test_drafts_of_killed_writers_are_swept(tmp_path: Path, age_s: float, kept: bool) -> None:
    file, folder = (tmp_path / f".kineme-0123456789ab{suffix}" for suffix in (".csv", ""))
    file.write_text("half")
    folder.mkdir()
    (folder / "half.bvh").write_text("half")
    for left in (file, folder):
        os.utime(left, (time.time() - age_s,) * 2)
    with atomic_write(tmp_path / "a.csv") as path:
        path.write_text("whole")
    assert file.exists() == folder.exists() == kept
    assert (tmp_path / "a.csv").read_text() == "whole"


@pytest.mark.skipif(sys.platform == "win32", reason="open files are not removed there")
def test_drafts_that_are_still_written_are_left_alone(tmp_path: Path) -> None:
    with atomic_write(tmp_path / "a.csv") as file, atomic_folder(tmp_path / "clips") as folder:
        for slow in (file, folder):
            os.utime(slow, (time.time() - 2 * HOUR,) * 2)
        _files._cleaned.clear()
        with atomic_folder(tmp_path / "quick"):
            pass
        file.write_text("a")
        (folder / "a.bvh").write_text("a")
    assert {path.name for path in tmp_path.iterdir()} == {"a.csv", "clips", "quick"}
    assert (tmp_path / "clips" / "a.bvh").read_text() == "a"


def test_a_place_that_may_not_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(_files.os, "open", refuse)
    monkeypatch.setattr(Path, "unlink", refuse)
    with (
        pytest.raises(WriteError, match="cannot be written: Read-only file system"),
        atomic_write(tmp_path / "a.csv"),
    ):
        pass


def test_file_and_folder_are_on_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    monkeypatch.setattr(_files, "_flush_to_disk", lambda place: done.append(place.name))
    with atomic_write(tmp_path / "a.csv") as path:
        path.write_text("whole")
    assert done[1:] == [tmp_path.name]
    assert done[0].startswith(".kineme-")


@pytest.mark.parametrize("name", ["a\0b.csv", "x" * 300 + ".csv"])
def test_names_that_no_file_has(tmp_path: Path, name: str) -> None:
    with (
        pytest.raises(WriteError, match="cannot be written"),
        atomic_write(tmp_path / name) as path,
    ):
        path.write_text("whole")


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_a_link_is_refused_and_what_it_leads_to_stays(tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_text("mine")
    for name, target in (("link.csv", "mine.csv"), ("dangling.csv", "nowhere.csv")):
        (tmp_path / name).symlink_to(tmp_path / target)
        with (
            pytest.raises(WriteError, match="is a link"),
            atomic_write(tmp_path / name) as path,
        ):
            path.write_text("whole")
    assert (tmp_path / "mine.csv").read_text() == "mine"
    assert not (tmp_path / "nowhere.csv").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_a_link_made_while_a_file_is_written_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_text("mine")
    with atomic_write(tmp_path / "a.csv") as path:
        path.write_text("whole")
        (tmp_path / "a.csv").symlink_to(tmp_path / "mine.csv")
    assert (tmp_path / "mine.csv").read_text() == "mine"
    assert (tmp_path / "a.csv").read_text() == "whole"


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_a_folder_that_a_link_leads_to_may_be_written(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    (tmp_path / "data").symlink_to(tmp_path / "disk")
    with atomic_write(tmp_path / "data" / "a.csv") as path:
        path.write_text("whole")
    assert (tmp_path / "disk" / "a.csv").read_text() == "whole"
