"""Written motions read back unchanged."""

from __future__ import annotations

import tempfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from format_samples import PLAIN, motions
from hypothesis import given

import _fbx
from kineme import bundled_recording, segment
from kineme.errors import KinemeWarning, WriteError
from kineme.formats import read, read_motion, write
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_world_rotations


def write_and_read(motion: Motion, suffix: str) -> Motion:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"motion{suffix}"
        write(motion, path)
        if suffix == ".bvh" and motion.provenance.format != "BVH":
            return read(path, unit="cm", up="y")  # one of its own keeps its units and axes
        return read(path)


def assert_same_joints(one: Motion, other: Motion, names: list[str]) -> None:
    ours, theirs = [one.joint(n) for n in names], [other.joint(n) for n in names]
    np.testing.assert_allclose(one.positions[:, ours], other.positions[:, theirs], atol=1e-7)
    dots = (
        compute_world_rotations(one.skeleton, one.rotations)[:, ours]
        * compute_world_rotations(other.skeleton, other.rotations)[:, theirs]
    ).sum(axis=2)
    np.testing.assert_allclose(np.abs(dots), 1, atol=1e-9)
    assert other.fps == pytest.approx(one.fps, rel=1e-12)


@pytest.mark.filterwarnings("ignore:.* bones have no length")
@given(motions())
def test_bvh(motion: Motion) -> None:
    again = write_and_read(motion, ".bvh")
    skeleton = motion.skeleton
    assert again.skeleton.n_joints == skeleton.n_joints
    assert len(again.skeleton.end_sites) == len(skeleton.end_sites)
    inner = [n for i, n in enumerate(skeleton.names) if i not in skeleton.end_sites]
    assert_same_joints(motion, again, inner)
    for position in motion.positions[0]:
        assert np.abs(again.positions[0] - position).max(axis=1).min() < 1e-7


@pytest.mark.filterwarnings("ignore:.* bones have no length")
@given(motions(names=PLAIN))
def test_amc(motion: Motion) -> None:
    again = write_and_read(motion, ".amc")
    skeleton = motion.skeleton
    inner = [n for i, n in enumerate(skeleton.names) if i not in skeleton.end_sites]
    assert_same_joints(motion, again, inner)


@pytest.mark.parametrize("suffix", [".bvh", ".amc", ".npz", ".trc"])
def test_a_rate_that_differs_from_that_of_the_file_is_said(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    write(read_motion(bundled_recording())[:60], path)
    with pytest.warns(KinemeWarning, match=r"a\.\w+: the file states 60 Hz; 30 is used") as caught:
        assert read(path, fps=30).fps == 30
    assert len(caught) == 1
    assert read(path, fps=59.94).fps == 59.94  # the same but for rounding, without a warning


@pytest.mark.parametrize("suffix", [".amc", ".bvh"])
def test_what_cannot_be_written_leaves_nothing_behind(tmp_path: Path, suffix: str) -> None:
    skeleton = Skeleton(("a",), (-1,), np.zeros((1, 3)))
    points = Motion(skeleton, np.zeros((2, 1, 3)), 30)
    with pytest.raises(WriteError, match="positions only"):
        write(points, tmp_path / f"x{suffix}")
    motion = Motion.from_rotations(skeleton, [[[1, 0, 0, 0]]], 30, [[0, 0, 0]])
    with pytest.raises(WriteError, match="cannot be written"):
        write(motion, tmp_path / "no such folder" / f"x{suffix}")
    (tmp_path / f"taken{suffix}").mkdir()
    with pytest.raises(WriteError, match="cannot be written"):
        write(motion, tmp_path / f"taken{suffix}")
    assert not [path for path in tmp_path.iterdir() if path.name.startswith("tmp")]


def test_unknown_suffix(tmp_path: Path) -> None:
    skeleton = Skeleton(("a",), (-1,), np.zeros((1, 3)))
    with pytest.raises(
        WriteError, match=r"cannot write a motion with the suffix '.xyz': use one of .amc, .bvh"
    ):
        write(Motion(skeleton, np.zeros((1, 1, 3)), 30), tmp_path / "a.xyz")


def test_one_recording_has_the_same_segments_in_every_format(tmp_path: Path) -> None:
    """Borders within 0.05 s, clusters and counts the same: AMC, BVH, FBX, GLB, USD."""
    motion = read_motion(bundled_recording())
    (tmp_path / "a.fbx").write_bytes(_fbx.make_scene(motion).binary())
    written = [".amc", ".bvh", ".glb", *([".usdc"] if find_spec("pxr") else [])]
    for suffix in written:
        write(motion, tmp_path / f"a{suffix}")
    expected = segment(read_motion(tmp_path / "a.bvh", unit="cm"))
    for suffix in (".fbx", *written):
        unit = "cm" if suffix == ".bvh" else None
        found = segment(read_motion(tmp_path / f"a{suffix}", unit=unit))
        for ours, theirs in (
            (expected.activities, found.activities),
            (expected.primitives, found.primitives),
        ):
            assert [row.kind for row in theirs] == [row.kind for row in ours]
            assert [row.cluster for row in theirs] == [row.cluster for row in ours]
            away = [abs(a.start_s - b.start_s) for a, b in zip(ours, theirs, strict=True)]
            assert max(away) <= 0.05
