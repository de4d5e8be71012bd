"""All takes of a scene in one call."""

from __future__ import annotations

from pathlib import Path

import kineme as package
from kineme.formats.scenes.fbx_writer import write_takes


def test_each_take_has_its_table_and_its_clips(kineme, tmp_path: Path) -> None:
    motion = package.read(package.bundled_recording())
    write_takes({"walk": motion[:240], "jump": motion[600:900]}, tmp_path / "two.fbx")
    done = kineme("segment", "two.fbx", "--take", "all", "-o", "tables", "-q")
    assert (done.returncode, done.stderr) == (0, "")
    tables = sorted(path.name for path in (tmp_path / "tables").glob("*.csv"))
    assert tables == ["two_jump.csv", "two_walk.csv"]
    stops = [package.read_segments(tmp_path / "tables" / name).n_frames for name in tables]
    assert stops == [300, 240]
    tables = ("--take", "all", "--segments", "tables", "-q")
    done = kineme("split", "two.fbx", *tables, "-o", "clips.glb")
    assert (done.returncode, done.stderr) == (0, "")
    assert sorted(path.name for path in tmp_path.glob("clips*")) == [
        "clips.glb",
        "clips.manifest.csv",
        "clips.manifest.json",
    ]
    takes = {name.split("_")[0] for name in package.formats.list_takes(tmp_path / "clips.glb")}
    assert takes == {"walk", "jump"}
