"""Errors of other packages on damaged files become errors of this package."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from format_samples import AMC, ASF, BVH
from keypoint_samples import as_json, make_world_landmarks, to_marks

import kineme
from kineme.errors import ReadError
from kineme.synthesis.graph import read_graph

DIGITS = "9" * 5000
"""More than Python makes an integer of."""

HUGE = 1.7e308
NODE = {"source": 0, "start": 0, "stop": 9, "cluster": 0, "label": ""}
GRAPH = {
    "schema": "kineme.motion-graph/1", "fps": 60.0, "threshold": 0.1, "window": 0.3,
    "sources": [{"path": "a.bvh", "sha256": "0" * 64, "n_frames": 9, "options": {}}],
    "nodes": [NODE], "edges": [],
}  # fmt: skip
ROW = {
    "level": "activity", "kind": "activity", "start_frame": 0, "stop_frame": 9, "start_s": 0.0,
    "stop_s": 0.3, "cluster": 0, "activity": 0, "confidence": None,
}  # fmt: skip


def make_lzma() -> bytes:
    """An archive whose member claims LZMA and is not."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("positions.npy", np.random.default_rng(0).bytes(2000))
    data = bytearray(file.getvalue())
    data[100:900] = b"\xff" * 800
    return bytes(data)


def make_mat() -> bytes:
    """A MATLAB array whose flags are floats, and no numbers."""
    flags = (9).to_bytes(4, "little") + (8).to_bytes(4, "little") + np.array([np.nan]).tobytes()
    element = (14).to_bytes(4, "little") + len(flags).to_bytes(4, "little") + flags
    return b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM" + element


def make_poses(fps: float) -> bytes:
    frames = [{"pose_world_landmarks": to_marks(pose)} for pose in make_world_landmarks(5)]
    return as_json({"fps": fps, "frames": frames})


def make_gap() -> bytes:
    rows = [f"{i / 30:.4f},{(HUGE if i < 9 else -HUGE) if i in (8, 11) else ''}" for i in range(30)]
    return "\n".join(["time_s,gyro_x", *rows]).encode()


def to_arrow(**columns: object) -> bytes:
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    file = io.BytesIO()
    parquet.write_table(pa.table(columns), file)
    return file.getvalue()


def to_graph(**changed: object) -> bytes:
    return json.dumps(GRAPH | changed).encode()


def to_table(**changed: object) -> bytes:
    head = {"schema": "kineme.segments/2", "fps": 30.0, "n_frames": 9}
    return json.dumps(head | {"segments": [ROW | {"label": "a"} | changed]}).encode()


def to_base(head: object) -> bytes:
    file = io.BytesIO()
    np.savez(file, head=np.array(json.dumps(head)), features=np.zeros((2, 3)))
    return file.getvalue()


def edit_bvh(old: str, new: str) -> Callable[[], bytes]:
    return lambda: BVH.replace(old, new).encode()


RECORDINGS: dict[str, tuple[str, Callable[[], bytes]]] = {
    "npz with damaged LZMA": ("a.npz", make_lzma),
    "digits in a frame of BVH": ("a.bvh", edit_bvh("1 91 1 11", f"1 {DIGITS} 1 1")),
    "digits in the frames of BVH": ("a.bvh", edit_bvh("Frames: ", f"Frames: {DIGITS}")),
    "digits in the channels of BVH": ("a.bvh", edit_bvh("CHANNELS 6", f"CHANNELS {DIGITS}")),
    "digits in a frame of AMC": ("a.amc", lambda: AMC.replace("\n1\n", f"\n{DIGITS}\n").encode()),
    "digits in TRC": ("a.trc", lambda: f"PathFileType\t4\nDataRate\n{DIGITS}\t1\n".encode()),
    "MAT with flags of NaN": ("a.mat", make_mat),
    "MediaPipe at 2**64 Hz": ("a.json", lambda: make_poses(2**64)),
    "MediaPipe at no number of Hz": ("a.json", lambda: make_poses(float("nan"))),
    "a gap between 1.7e308 and -1.7e308": ("a.csv", make_gap),
    "Parquet of texts": ("a.parquet", lambda: to_arrow(time_s=["a", "b"], gyro_x=["c", "d"])),
    "Parquet of lists": ("a.parquet", lambda: to_arrow(gyro_x=[[1.0], [2.0]], gyro_y=[[1.0], []])),
    "a header of 140,000 characters": ("a.csv", lambda: b"time_s," + b"x" * 140_000 + b"\n0,1"),
    "a header of an open quote": ("a.csv", lambda: b'time_s,"' + b"x,\n" * 70_000),
}
Read = Callable[[Path], object]
read_table, read_knowledge = kineme.read_segments, kineme.KnowledgeBase.load
TRUTH = f"start_frame,stop_frame,label\n0,{DIGITS},a\n".encode()
FAST = {"schema": "kineme.knowledge/2", "fps": 2**64}
OTHERS: dict[str, tuple[str, Callable[[], bytes], Read]] = {
    "digits in a truth": ("a.csv", lambda: TRUTH, read_table),
    "a dict for a label": ("a.json", lambda: to_table(label={}), read_table),
    "a cluster of 2**63": ("a.json", lambda: to_table(cluster=2**63), read_table),
    "a table of 1e300 frames": ("a.json", lambda: to_table(stop_frame=1e300), read_table),
    "a graph of texts": ("a.json", lambda: to_graph(fps="fast"), read_graph),
    "a graph at 2**64 Hz": ("a.json", lambda: to_graph(fps=2**64), read_graph),
    "a graph of digits": (
        "a.json",
        lambda: to_graph().replace(b"60.0", DIGITS.encode()),
        read_graph,
    ),
    "nodes that are no list": ("a.json", lambda: to_graph(nodes=3), read_graph),
    "a node that is none": ("a.json", lambda: to_graph(nodes=[None]), read_graph),
    "a node of 2**63": ("a.json", lambda: to_graph(nodes=[NODE | {"stop": 2**63}]), read_graph),
    "knowledge that is a list": ("a.npz", lambda: to_base([]), read_knowledge),
    "knowledge at 2**64 Hz": ("a.npz", lambda: to_base(FAST), read_knowledge),
}


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("kind", RECORDINGS)
def test_recordings(tmp_path: Path, kind: str) -> None:
    name, content = RECORDINGS[kind]
    (tmp_path / "a.asf").write_text(ASF)
    check_refusal(tmp_path / name, content(), kineme.read)


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("kind", OTHERS)
def test_labels_graphs_and_knowledge(tmp_path: Path, kind: str) -> None:
    name, content, read = OTHERS[kind]
    check_refusal(tmp_path / name, content(), read)


def check_refusal(path: Path, content: bytes, read: Callable[[Path], object]) -> None:
    path.write_bytes(content)
    with pytest.raises(ReadError) as caught:
        read(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400
    assert "may be damaged" not in str(caught.value)
