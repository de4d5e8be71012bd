"""Issues reported for other readers that no other test covers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from format_samples import BVH
from marker_samples import PLUG_IN_GAIT, c3d_bytes, walking, z_up_millimetres

import kineme
from kineme.errors import KinemeWarning
from kineme.formats.files import FileContent
from kineme.formats.markers.c3d_file import parse_c3d


def bvh(folder: Path, text: str) -> kineme.Motion:
    path = folder / "a.bvh"
    path.write_text(text)
    return kineme.read(path)


def test_numbers_that_are_not_apart(tmp_path: Path) -> None:
    """SlimeVR-Server#995: no blank before a minus sign."""
    sound = BVH.replace("1 91 1 11 21 31", "1 91 1 -11 21 31")
    with pytest.warns(KinemeWarning, match="spaces missing before minus signs added in 1 frame"):
        glued = bvh(tmp_path, sound.replace("1 -11 21", "1-11 21"))
    np.testing.assert_array_equal(glued.positions, bvh(tmp_path, sound).positions)


def test_a_minus_in_an_exponent_is_none(tmp_path: Path) -> None:
    """usdBVHAnim#36, BVHTools#11, BVHView#4: scientific notation, small and negative."""
    motion = bvh(tmp_path, BVH.replace("1 91 1 11", "1e0 9.1E+1 1 -1.1e-5"))
    other = bvh(tmp_path, BVH.replace("1 91 1 11", "1 91 1 -0.000011"))
    np.testing.assert_array_equal(motion.positions, other.positions)


def test_names_of_every_rig(tmp_path: Path) -> None:
    """PyMO#20: names with colons and dots."""
    motion = bvh(tmp_path, BVH.replace("Foot", "Rig:Foot.L|01"))
    assert "Rig:Foot.L|01" in motion.skeleton.names


@pytest.mark.parametrize("fps", [29.476, 23.976, 59.94, 120.0])
def test_rates_are_no_whole_numbers(tmp_path: Path, fps: float) -> None:
    """freemocap_blender_addon#66, fairmotion#67: 29.476 Hz is not 24, 30 or 60."""
    motion = bvh(tmp_path, BVH.replace("0.0083333", repr(1 / fps)))
    assert motion.fps == pytest.approx(fps, rel=1e-9)
    for suffix in (".bvh", ".csv", ".npz", ".trc"):
        kineme.write(motion, tmp_path / f"b{suffix}")
        assert kineme.read(tmp_path / f"b{suffix}").fps == pytest.approx(fps, rel=1e-6)


def test_analog_channels_without_a_rate_of_their_own() -> None:
    """ezc3d#52: Xsens leaves out ANALOG:RATE."""
    analog = np.zeros((60, 4, 2))
    data = c3d_bytes(z_up_millimetres(walking()), PLUG_IN_GAIT, analog=analog)
    file = parse_c3d(FileContent(Path("a.c3d"), data))
    assert file.parameters.number("ANALOG", "RATE", default=-1.0) == -1.0
    assert file.analog_rate == 400


def test_occlusion_is_no_position(tmp_path: Path) -> None:
    """ezc3d#227: residuals below zero are gaps, not the origin."""
    points = z_up_millimetres(walking())
    points[5:9, 14] = np.nan
    (tmp_path / "a.c3d").write_bytes(c3d_bytes(points, PLUG_IN_GAIT))
    motion = kineme.read(tmp_path / "a.c3d")
    found = motion.positions[:, motion.joint(PLUG_IN_GAIT[14])]
    assert np.abs(found - walking()[:, 14]).max() < 1e-4


def test_no_body_model_is_needed(tmp_path: Path) -> None:
    """smplx#75 and #76: AMASS by joints alone, at the rate it was captured at."""
    np.savez(tmp_path / "a.npz", poses=np.zeros((5, 156)), mocap_framerate=59.94)
    assert kineme.read(tmp_path / "a.npz", up="y").fps == 59.94
