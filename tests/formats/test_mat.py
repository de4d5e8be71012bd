"""MAT files: written by scipy and h5py, compared with scipy, and damaged."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from marker_samples import PLUG_IN_GAIT, make_walk, to_millimetres
from scipy.io import loadmat, savemat

import kineme
from kineme.errors import ReadError
from kineme.formats.arrays.mat import parse_mat
from kineme.formats.files import FileContent
from reading import read


def to_mat(compressed: bool = True, **variables: object) -> bytes:
    file = io.BytesIO()
    savemat(file, variables, do_compression=compressed)
    return file.getvalue()


def to_cells(names: list[str]) -> np.ndarray:
    out = np.empty(len(names), object)
    out[:] = names
    return out


MARKERS = make_walk()
PELVIS = MARKERS[:, :4].mean(axis=1)


def has_the_walk(motion: kineme.Motion) -> bool:
    found = motion.positions[:, motion.joint("pelvis")]
    return motion.fps == 100 and np.allclose(found, PELVIS, atol=1e-3)


@pytest.mark.parametrize("compressed", [False, True])
def test_positions_by_variables(tmp_path: Path, compressed: bool) -> None:
    names = to_cells(PLUG_IN_GAIT)
    data = to_mat(compressed, positions=MARKERS, names=names, fps=100)
    assert has_the_walk(read(tmp_path, "a.mat", data))
    inside = to_mat(compressed, take={"positions": MARKERS, "names": names, "fps": 100})
    assert has_the_walk(read(tmp_path, "a.mat", inside))
    rows = to_mat(compressed, positions=MARKERS, names=np.array(PLUG_IN_GAIT), fps=100)
    assert has_the_walk(read(tmp_path, "a.mat", rows))  # a matrix of characters


def test_a_variable_for_each_marker(tmp_path: Path) -> None:
    tracks = {name: MARKERS[:, i] for i, name in enumerate(PLUG_IN_GAIT)}
    assert has_the_walk(read(tmp_path, "a.mat", to_mat(fps=100.0, **tracks)))
    assert has_the_walk(read(tmp_path, "a.mat", to_mat(markers=tracks, fps=100.0, info="a take")))
    time = np.arange(60) / 100
    assert has_the_walk(read(tmp_path, "a.mat", to_mat(markers={**tracks, "time": time})))
    columns = {
        f"{n}_{a}": MARKERS[:, i, k]
        for i, n in enumerate(PLUG_IN_GAIT)
        for k, a in enumerate("xyz")
    }
    assert has_the_walk(read(tmp_path, "a.mat", to_mat(**columns, time=time)))


def to_qtm(points: np.ndarray) -> dict:
    data = np.concatenate([points, np.zeros((*points.shape[:2], 1))], axis=2)
    labels = to_cells(PLUG_IN_GAIT)
    labeled = {"Count": 18, "Labels": labels, "Data": data.transpose(1, 2, 0)}
    return {"File": "x", "FrameRate": 100, "Trajectories": {"Labeled": labeled}}


def test_exports_of_qtm(tmp_path: Path) -> None:
    points = to_millimetres(MARKERS)
    motion = read(tmp_path, "a.mat", to_mat(take_01=to_qtm(points)))
    assert motion.provenance.format == "MAT of QTM"
    assert has_the_walk(motion)
    wrong = to_qtm(points[:, :5])
    with pytest.raises(ReadError, match=r"18 Labels for Data of shape \(5, 4, 60\)"):
        read(tmp_path, "a.mat", to_mat(take=wrong))


def as_hdf5(variables: dict, folder: Path) -> bytes:
    """As MATLAB's -v7.3 lays them out."""
    h5py = pytest.importorskip("h5py")

    def put(group, name: str, value: object) -> None:
        if isinstance(value, dict):
            inner = group.create_group(name)
            inner.attrs["MATLAB_class"] = np.bytes_("struct")
            for key, item in value.items():
                put(inner, key, item)
        elif isinstance(value, str):
            rows = value.split("\n")
            width = max(map(len, rows))
            codes = [list(map(ord, row.ljust(width))) for row in rows]
            group[name] = np.array(codes, np.uint16).T
            group[name].attrs["MATLAB_class"] = np.bytes_("char")
        elif isinstance(value, np.ndarray) and value.dtype == object:
            refs = np.empty((1, len(value)), h5py.ref_dtype)
            for i, item in enumerate(value):
                put(group.file.require_group("#refs#"), f"{name}{i}", item)
                refs[0, i] = group.file[f"#refs#/{name}{i}"].ref
            group.create_dataset(name, data=refs, dtype=h5py.ref_dtype)
            group[name].attrs["MATLAB_class"] = np.bytes_("cell")
        else:
            group[name] = np.atleast_2d(np.asarray(value, float)).T
            group[name].attrs["MATLAB_class"] = np.bytes_("double")

    with h5py.File(folder / "v73.mat", "w", userblock_size=512) as file:
        for key, item in variables.items():
            put(file, key, item)
    data = bytearray((folder / "v73.mat").read_bytes())
    data[:128] = b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM"
    return bytes(data)


def test_version_73(tmp_path: Path) -> None:
    names = to_cells(PLUG_IN_GAIT)
    data = as_hdf5({"positions": MARKERS, "names": names, "fps": 100}, tmp_path)
    assert has_the_walk(read(tmp_path, "a.mat", data))
    rows = {"positions": MARKERS, "names": "\n".join(PLUG_IN_GAIT), "fps": 100}
    assert has_the_walk(read(tmp_path, "a.mat", as_hdf5(rows, tmp_path)))
    motion = read(tmp_path, "a.mat", as_hdf5({"take": to_qtm(to_millimetres(MARKERS))}, tmp_path))
    assert motion.provenance.format == "MAT of QTM"
    assert has_the_walk(motion)
    with pytest.raises(ReadError, match="is not a complete HDF5 file"):
        read(tmp_path, "a.mat", data[: len(data) // 2])


def test_channels_are_signals(tmp_path: Path) -> None:
    emg = np.sin(np.arange(500)[:, None] * (0.1, 0.2, 0.3))
    (tmp_path / "a.mat").write_bytes(
        to_mat(emg=emg, force=emg[:, 0], subject="ann", Fs=1000, x=[1, 2])
    )
    signals = kineme.read(tmp_path / "a.mat")
    assert signals.names == ("emg_1", "emg_2", "emg_3", "force")
    assert signals.fps == 1000
    assert np.array_equal(signals.values[:, :3], emg)
    with pytest.warns(kineme.KinemeWarning, match="the file states 1000 Hz; 500 is used"):
        some = kineme.read(tmp_path / "a.mat", columns=["force"], fps=500)
    assert (some.names, some.fps) == (("force",), 500)
    (tmp_path / "a.mat").write_bytes(to_mat(emg=emg.T, time=np.arange(500) / 200))
    assert kineme.read(tmp_path / "a.mat").fps == 200


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"MATLAB 5.0 MAT-file", "not a MAT file of version 5"),
        (to_mat(positions=MARKERS, fps=100)[:900], "not a complete MAT file"),
        (to_mat(), "no readable variable"),
        (to_mat(positions=MARKERS), "no 'fps' in it: give fps="),
        (to_mat(emg=np.arange(9.0)), r"it does not state its frame rate: give fps \(--fps\)"),
        (
            to_mat(False, positions=np.zeros((3, 3, 3)), names=to_cells(["a"]), fps=1),
            "1 names for 3",
        ),
        (to_mat(positions=np.zeros((10**5, 3, 3)), fps=30), "claims to unpack far more than it"),
    ],
)
def test_bad_files(tmp_path: Path, data: bytes, reason: str) -> None:
    with pytest.raises(ReadError, match=reason):
        read(tmp_path, "a.mat", data)


VALUES = st.one_of(
    st.floats(allow_nan=False, width=64),
    st.text("abcäλ ", min_size=1, max_size=9).filter(str.strip),
    st.builds(
        lambda n, m, kind: np.arange(n * m).reshape(n, m).astype(kind),
        st.integers(1, 4),
        st.integers(1, 5),
        st.sampled_from(["i1", "u2", "i4", "f4", "f8", "u8", "i8"]),
    ),
)


def are_same(ours: object, theirs: object) -> bool:
    if isinstance(ours, dict):
        return all(are_same(ours[key], theirs[key][0, 0]) for key in theirs.dtype.names)
    if isinstance(ours, list):
        return len(ours) == theirs.size and all(map(are_same, ours, theirs.ravel(order="F")))
    if isinstance(ours, str):
        return ours == "".join(theirs.ravel())
    return ours.dtype.kind == theirs.dtype.kind and np.array_equal(ours, theirs)


@settings(max_examples=60)
@given(
    st.dictionaries(
        st.text("abc", min_size=1, max_size=5),
        st.one_of(
            VALUES,
            st.lists(VALUES, min_size=1, max_size=3).map(
                lambda items: np.array([*items, None], object)[:-1]
            ),
            st.dictionaries(st.text("xyz", min_size=1, max_size=40 // 2), VALUES, min_size=1),
        ),
    ),
    st.booleans(),
)
def test_we_find_what_scipy_finds(variables: dict, compressed: bool) -> None:
    data = to_mat(compressed, **variables)
    ours, theirs = parse_mat(FileContent(Path("a.mat"), data)), loadmat(io.BytesIO(data))
    assert ours.keys() == {key for key in theirs if not key.startswith("__")}
    for name, value in ours.items():
        assert are_same(value, theirs[name]), name
