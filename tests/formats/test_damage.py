"""Damaged files of every format are read, or refused with an error of the package."""

from __future__ import annotations

import io
import tracemalloc
import warnings
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from format_samples import AMC, ASF, BVH
from hypothesis import given, settings
from hypothesis import strategies as st
from keypoint_samples import (
    COCO,
    as_json,
    coco,
    marks,
    mmpose,
    openpose,
    pixels,
    sleap_csv,
    sleap_h5,
    standing,
    world_landmarks,
)
from marker_samples import PLUG_IN_GAIT, c3d_bytes, walking
from test_gltf import changed
from test_mat import as_hdf5, cells, mat, qtm
from test_tables import JOINTS, TIMES, TRC, body, table

import kineme
from _damage import damage_bytes
from _fbx import make_walker
from _restructure import change_structure
from kineme.errors import KinemeError, KinemeWarning
from kineme.formats import supported_formats

POINTS = np.ones((4, 18, 3)) * np.arange(18)[:, None]
SUFFIXES = sorted({suffix for known in supported_formats() for suffix in known.suffixes})


def written(write, **arrays: object) -> bytes:
    file = io.BytesIO()
    write(file, **arrays)
    return file.getvalue()


def parquet() -> bytes:
    import pyarrow as pa
    from pyarrow import parquet

    table = pa.table({"a_x": [1.0], "a_y": [1.0], "a_z": [1.0]})
    return written(lambda file: parquet.write_table(table, file))


def glb() -> bytes:
    with TemporaryDirectory() as folder:
        return changed().save(Path(folder) / "a.glb").read_bytes()


def hdf5() -> bytes:
    with TemporaryDirectory() as folder:
        return as_hdf5({"take": qtm(POINTS)}, Path(folder))


NEXUS = "Trajectories\n100\n,,A,,\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n1,0,1,2,3\n2,0,1,2,4\n"
MEDIAPIPE = [{"landmarks": marks(pose), "frame": i} for i, pose in enumerate(world_landmarks(3))]
SOUND = {
    "a.bvh": BVH.encode(),
    "a.amc": AMC.encode(),
    "b.asf": ASF.encode(),  # beside a sound AMC
    "table.csv": table(body(4), time=TIMES).encode(),
    "nexus.csv": NEXUS.encode(),
    "sleap.csv": sleap_csv({"a": pixels(standing(COCO, 3))}, COCO).encode(),
    "a.mot": b"Coordinates\nendheader\ntime a b\n0 1 2\n",
    "a.trc": TRC.encode(),
    "a.npy": written(lambda file: np.save(file, body(4))),
    "a.npz": written(np.savez, positions=body(4), fps=30.0, names=np.array(JOINTS)),
    "poses.npz": written(
        np.savez_compressed, poses=np.zeros((3, 72)), trans=np.zeros((3, 3)), fps=30.0
    ),
    "a.mat": mat(False, positions=POINTS, names=cells([f"m{i}" for i in range(18)]), fps=30),
    "packed.mat": mat(True, take={"a": POINTS[:, 0], "b": POINTS[:, 1], "fps": 30}),
    "qtm.mat": mat(False, take=qtm(POINTS)),
    "a.c3d": c3d_bytes(walking()[:5, :8], PLUG_IN_GAIT[:8]),
    "a.fbx": make_walker().binary(),
    "plain.fbx": make_walker().binary(7700, packed=False),
    "text.fbx": make_walker().text(),
    "a.glb": glb(),
    "openpose.json": as_json(openpose(18, 3)),
    "coco.json": as_json(coco(3)),
    "results.json": as_json(coco(3, results=True, track_id=1)),
    "mmpose.json": as_json(mmpose()["instance_info"][:3]),
    "mediapipe.json": as_json(MEDIAPIPE),
}
if find_spec("h5py"):
    SOUND["a.h5"] = sleap_h5(pixels(standing(COCO, 4))[None], COCO, ["a"], new=False)
    SOUND["hdf5.mat"] = hdf5()
if find_spec("pyarrow"):
    SOUND["a.parquet"] = parquet()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("damaged")
    (folder / "a.asf").write_text(ASF)
    (folder / "b.amc").write_text(AMC)
    return folder


def survives(folder: Path, name: str, data: bytes) -> None:
    (folder / name).write_bytes(data)
    path = folder / ("b.amc" if name == "b.asf" else name)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", KinemeWarning)
        try:
            assert kineme.read(path, fps=30).n_frames > 0
        except KinemeError as error:
            assert "\n" not in str(error)


@pytest.mark.parametrize("name", SOUND)
@settings(max_examples=25)
@given(seed=st.integers(0, 2**32 - 1), meaning=st.booleans())
def test_damage_to_bytes_and_to_what_they_mean(
    folder: Path, name: str, seed: int, meaning: bool
) -> None:
    sound = SOUND[name]
    data = change_structure(Path(name), sound, seed) if meaning else damage_bytes(sound, seed)
    survives(folder, name, data)


@given(st.binary(max_size=300), st.sampled_from(SUFFIXES))
def test_any_bytes(folder: Path, data: bytes, suffix: str) -> None:
    survives(folder, f"any{suffix}", data)


def test_cells_that_claim_to_be_many(folder: Path) -> None:
    few, many = (np.array(shape, "<i4").tobytes() for shape in ([1, 18], [2**30, 2**30]))
    data = SOUND["a.mat"].replace(few, many)
    assert data != SOUND["a.mat"]
    tracemalloc.start()
    survives(folder, "many.mat", data)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 5_000_000
