"""A Rerun recording, read back with Rerun's own reader."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kineme
from kineme.datasets import bundled_recording, bundled_truth
from kineme.errors import ParameterError, WriteError
from kineme.interop.rerun_recording import write_rerun
from kineme.labels import read_segments
from kineme.labels.spans import format_text
from kineme.recordings.operations import cut

pytest.importorskip("rerun", reason="not installed: pip install 'kineme[rerun]'")


def read_columns(path, entity: str) -> dict[str, list]:
    """All columns of an entity, of its moments and of what is static."""
    from rerun.chunk import RrdReader

    found: dict[str, list] = {}
    for chunk in RrdReader(path).stream():
        if chunk.entity_path == entity:
            batch = chunk.to_record_batch()
            for name in batch.schema.names:
                if "RowId" not in name:
                    found.setdefault(name, []).extend(batch.column(name).to_pylist())
    return found


def test_skeleton_and_lanes_come_back(tmp_path) -> None:
    motion = kineme.read(bundled_recording())
    truth = read_segments(bundled_truth())
    path = tmp_path / "take.rrd"
    write_rerun(motion, truth, path)
    joints = read_columns(path, "/body/joints")
    positions = np.array(joints["Points3D:positions"])
    assert positions.shape == motion.positions.shape
    assert np.abs(positions - motion.positions).max() < 1e-6
    assert joints["Points3D:labels"] == [list(motion.skeleton.names)]
    bones = read_columns(path, "/body/bones")["LineStrips3D:strips"]
    pairs = [p for p in motion.skeleton.parents if p >= 0]
    assert np.array(bones[-1]).shape == (len(pairs), 2, 3)
    for level in ("activity", "primitive"):
        rows = truth.level(level)
        lane = read_columns(path, f"/segments/{level}")
        assert lane["frame"] == rows.start_frame.tolist()
        states = lane["StateChange:state"]
        assert len({state for (state,) in states}) == len(rows)
        assert lane["StateConfiguration:labels"] == [list(map(format_text, rows))]
    assert "known by construction" in read_columns(path, "/provenance")["TextDocument:text"][0][0]


def test_a_gap_has_no_skeleton(tmp_path) -> None:
    motion = cut(kineme.read(bundled_recording()), 0, 60)
    write_rerun(replace(motion, gaps=((20, 30),)), None, tmp_path / "take.rrd")
    frames = read_columns(tmp_path / "take.rrd", "/body/joints")["frame"]
    assert frames == [*range(20), *range(30, 60)]
    assert not read_columns(tmp_path / "take.rrd", "/segments/activity")


def test_what_does_not_fit_leaves_nothing(tmp_path) -> None:
    motion = kineme.read(bundled_recording())
    truth = read_segments(bundled_truth())
    with pytest.raises(ParameterError, match="the motion has 60"):
        write_rerun(cut(motion, 0, 60), truth, tmp_path / "take.rrd")
    with pytest.raises(WriteError, match="does not exist"):
        write_rerun(motion, truth, tmp_path / "nowhere" / "take.rrd")
    assert not list(tmp_path.iterdir())
