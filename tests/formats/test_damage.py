"""Damaged files of every format are read, or refused with an error of the package."""

from __future__ import annotations

import io
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
    make_coco,
    make_mmpose,
    make_openpose,
    make_person,
    make_world_landmarks,
    project,
    to_marks,
    to_sleap_csv,
    to_sleap_h5,
)
from marker_samples import PLUG_IN_GAIT, make_walk, to_c3d
from test_gltf import make_changed
from test_mat import as_hdf5, to_cells, to_mat, to_qtm
from test_tables import JOINTS, TIMES, TRC, make_body, tabulate

import kineme
from _damage import damage_bytes
from _fbx import make_walker
from _restructure import change_structure
from growth import measure_peak
from kineme.errors import KinemeError, KinemeWarning
from kineme.formats import supported_formats

POINTS = np.ones((4, 18, 3)) * np.arange(18)[:, None]
SUFFIXES = sorted({suffix for known in supported_formats() for suffix in known.suffixes})


def to_bytes(write, **arrays: object) -> bytes:
    file = io.BytesIO()
    write(file, **arrays)
    return file.getvalue()


def make_parquet() -> bytes:
    import pyarrow as pa
    from pyarrow import parquet

    table = pa.table({"a_x": [1.0], "a_y": [1.0], "a_z": [1.0]})
    return to_bytes(lambda file: parquet.write_table(table, file))


def make_glb() -> bytes:
    with TemporaryDirectory() as folder:
        return make_changed().save(Path(folder) / "a.glb").read_bytes()


def make_hdf5() -> bytes:
    with TemporaryDirectory() as folder:
        return as_hdf5({"take": to_qtm(POINTS)}, Path(folder))


NEXUS = "Trajectories\n100\n,,A,,\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n1,0,1,2,3\n2,0,1,2,4\n"
MEDIAPIPE = [
    {"landmarks": to_marks(pose), "frame": i} for i, pose in enumerate(make_world_landmarks(3))
]
SOUND = {
    "a.bvh": BVH.encode(),
    "a.amc": AMC.encode(),
    "b.asf": ASF.encode(),  # beside a sound AMC
    "table.csv": tabulate(make_body(4), time=TIMES).encode(),
    "nexus.csv": NEXUS.encode(),
    "sleap.csv": to_sleap_csv({"a": project(make_person(COCO, 3))}, COCO).encode(),
    "a.mot": b"Coordinates\nendheader\ntime a b\n0 1 2\n",
    "a.trc": TRC.encode(),
    "a.npy": to_bytes(lambda file: np.save(file, make_body(4))),
    "a.npz": to_bytes(np.savez, positions=make_body(4), fps=30.0, names=np.array(JOINTS)),
    "poses.npz": to_bytes(
        np.savez_compressed, poses=np.zeros((3, 72)), trans=np.zeros((3, 3)), fps=30.0
    ),
    "a.mat": to_mat(False, positions=POINTS, names=to_cells([f"m{i}" for i in range(18)]), fps=30),
    "packed.mat": to_mat(True, take={"a": POINTS[:, 0], "b": POINTS[:, 1], "fps": 30}),
    "qtm.mat": to_mat(False, take=to_qtm(POINTS)),
    "a.c3d": to_c3d(make_walk()[:5, :8], PLUG_IN_GAIT[:8]),
    "a.fbx": make_walker().binary(),
    "plain.fbx": make_walker().binary(7700, packed=False),
    "text.fbx": make_walker().text(),
    "a.glb": make_glb(),
    "openpose.json": as_json(make_openpose(18, 3)),
    "coco.json": as_json(make_coco(3, track_id=1)),
    "mmpose.json": as_json(make_mmpose()["instance_info"][:3]),
    "mediapipe.json": as_json(MEDIAPIPE),
}
if find_spec("h5py"):
    SOUND["a.h5"] = to_sleap_h5(project(make_person(COCO, 4))[None], COCO, ["a"], new=False)
    SOUND["hdf5.mat"] = make_hdf5()
if find_spec("pyarrow"):
    SOUND["a.parquet"] = make_parquet()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("damaged")
    (folder / "a.asf").write_text(ASF)
    (folder / "b.amc").write_text(AMC)
    return folder


def check_survival(folder: Path, name: str, data: bytes) -> None:
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
    check_survival(folder, name, data)


@given(st.binary(max_size=300), st.sampled_from(SUFFIXES))
def test_any_bytes(folder: Path, data: bytes, suffix: str) -> None:
    check_survival(folder, f"any{suffix}", data)


def test_cells_that_claim_to_be_many(folder: Path) -> None:
    few, many = (np.array(shape, "<i4").tobytes() for shape in ([1, 18], [2**30, 2**30]))
    data = SOUND["a.mat"].replace(few, many)
    assert data != SOUND["a.mat"]
    assert measure_peak(lambda: check_survival(folder, "many.mat", data)) < 5_000_000
