"""Damaged keypoints, MAT and HDF5 files: one clear error, whatever is wrong with them."""

from __future__ import annotations

import json
import tempfile
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pytest
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
from test_mat import as_hdf5, cells, mat, qtm

import kineme
from kineme.errors import KinemeError, KinemeWarning

POINTS = np.ones((4, 18, 3)) * np.arange(18)[:, None]


def survives(name: str, data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", KinemeWarning)
        path = Path(folder) / name
        path.write_bytes(data)
        try:
            assert kineme.read(path, fps=30).n_frames > 0
        except KinemeError as error:
            assert "\n" not in str(error)


def spoilt(draw: st.DrawFn, sound: bytes, words: list[bytes]) -> bytes:
    data = bytearray(sound)
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(data)))
        stop = min(len(data), start + draw(st.integers(0, 30)))
        new = st.one_of(st.binary(max_size=6), st.sampled_from(words), st.just(b""))
        data[start:stop] = draw(new)
    return bytes(data[: draw(st.one_of(st.just(len(data)), st.integers(0, len(data))))])


JSON_WORDS = [b"NaN", b"1e999", b"null", b"[", b"]", b"{}", b'"x"', b"-1", b"99999999999", b"true"]
MARKS = [{"landmarks": marks(pose), "frame": i} for i, pose in enumerate(world_landmarks(3))]
TEXTS = {
    "openpose.json": as_json(openpose(18, 3)),
    "coco.json": as_json(coco(3)),
    "mmpose.json": as_json(mmpose()["instance_info"][:3]),
    "results.json": as_json(coco(3, results=True, track_id=1)),
    "mediapipe.json": as_json(MARKS),
    "sleap.csv": sleap_csv({"a": pixels(standing(COCO, 3))}, COCO).encode(),
}


@settings(max_examples=60)
@given(st.data())
def test_bytes_of_text(data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(TEXTS)))
    survives(name, spoilt(data.draw, TEXTS[name], JSON_WORDS))


ANYTHING = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=5,
)


def places(value: object, path: tuple = ()) -> list[tuple]:
    """Where in a JSON value something else could stand; of long lists the ends."""
    keys: list = []
    if isinstance(value, dict):
        keys = list(value)
    elif isinstance(value, list):
        keys = sorted({0, 1, len(value) - 1} & set(range(len(value))))
    return [path, *(p for key in keys for p in places(value[key], (*path, key)))]


@settings(max_examples=60)
@given(st.data())
def test_json_of_other_types(data: st.DataObject) -> None:
    name = data.draw(st.sampled_from([name for name in sorted(TEXTS) if name.endswith("json")]))
    content = json.loads(TEXTS[name])
    for _ in range(data.draw(st.integers(1, 3))):
        path = data.draw(st.sampled_from(places(content)[1:] or [()]))
        if not path:
            continue
        where = content
        for key in path[:-1]:
            where = where[key]
        if data.draw(st.booleans()):
            where[path[-1]] = data.draw(ANYTHING)
        else:
            del where[path[-1]]
    survives(name, as_json(content))


MATS = {
    "plain": mat(False, positions=POINTS, names=cells([f"m{i}" for i in range(18)]), fps=30),
    "packed": mat(True, take={"a": POINTS[:, 0], "b": POINTS[:, 1], "fps": 30}),
    "qtm": mat(False, take=qtm(POINTS)),
}


@settings(max_examples=60)
@given(st.data())
def test_mat_files(data: st.DataObject) -> None:
    sound = bytearray(MATS[data.draw(st.sampled_from(sorted(MATS)))])
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(124, len(sound) - 1))
        sound[at : at + 4] = data.draw(st.binary(max_size=4))
    del sound[data.draw(st.one_of(st.just(len(sound)), st.integers(1, len(sound)))) :]
    survives("a.mat", bytes(sound))


@pytest.fixture(scope="module")
def hdf5(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    pytest.importorskip("h5py")
    tracks = pixels(standing(COCO, 4))[None]
    return {
        "a.h5": sleap_h5(tracks, COCO, ["a"], new=False),
        "a.mat": as_hdf5({"take": qtm(POINTS)}, tmp_path_factory.mktemp("mat")),
    }


@settings(max_examples=60)
@given(data=st.data())
def test_hdf5_files(hdf5: dict[str, bytes], data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(hdf5)))
    sound = bytearray(hdf5[name])
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(sound) - 1))
        sound[at : at + 4] = data.draw(st.binary(max_size=4))
    del sound[data.draw(st.one_of(st.just(len(sound)), st.integers(1, len(sound)))) :]
    survives(name, bytes(sound))


def test_cells_that_claim_to_be_many() -> None:
    data = MATS["plain"].replace(
        np.array([1, 18], "<i4").tobytes(), np.array([2**30, 2**30], "<i4").tobytes()
    )
    assert data != MATS["plain"]
    tracemalloc.start()
    survives("a.mat", data)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 5_000_000
