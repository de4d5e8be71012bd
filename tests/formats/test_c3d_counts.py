"""C3D files whose header and parameters disagree: the length of the file decides."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.errors import KinemeWarning, ReadError

N_FRAMES = 40


def c3d(points: int, header: int, used: int, n_frames: int = N_FRAMES) -> bytes:
    """A file with so many points in a frame, of which header and parameters say something."""
    names = b"".join(f"M{i:<3d}".encode() for i in range(points))

    def parameter(name: bytes, kind: int, shape: bytes, data: bytes) -> bytes:
        body = bytes([kind & 0xFF, len(shape)]) + shape + data + b"\0"
        return bytes([len(name), 1]) + name + struct.pack("<H", len(body) + 2) + body

    section = bytes([1, 80, 2, 84]) + bytes([5, 255]) + b"POINT" + struct.pack("<HB", 3, 0)
    section += parameter(b"USED", 2, b"", struct.pack("<H", used))
    section += parameter(b"FRAMES", 2, b"", struct.pack("<H", n_frames))
    section += parameter(b"RATE", 4, b"", struct.pack("<f", 100.0))
    section += parameter(b"SCALE", 4, b"", struct.pack("<f", -1.0))
    section += parameter(b"LABELS", -1, bytes([4, points]), names)
    section += parameter(b"UNITS", -1, bytes([2, 1]), b"mm") + b"\0\0"
    head = struct.pack("<BB5HfHHf", 2, 80, header, 0, 1, n_frames, 0, -1.0, 4, 0, 100.0)
    places = np.zeros((N_FRAMES, points, 4), "<f4")
    places[..., :3] = 100 * np.arange(1, points + 1)[:, None] + np.arange(3)
    data = places.tobytes()
    whole = head.ljust(512, b"\0") + section.ljust(1024, b"\0") + data
    return whole + bytes(-len(whole) % 512)


@pytest.mark.parametrize(("header", "used"), [(8, 7), (7, 8), (8, 12), (12, 8)])
def test_the_count_that_fits_the_file_is_taken_and_said(
    tmp_path: Path, header: int, used: int
) -> None:
    (tmp_path / "a.c3d").write_bytes(c3d(8, header, used))
    with pytest.warns(KinemeWarning, match=f"the header counts {header} points .* parameters"):
        motion = kineme.read(tmp_path / "a.c3d")
    sound = tmp_path / "sound.c3d"
    sound.write_bytes(c3d(8, 8, 8))
    np.testing.assert_array_equal(motion.positions, kineme.read(sound).positions)


def test_where_no_count_fits_the_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.c3d").write_bytes(c3d(8, 17, 18))
    with pytest.raises(ReadError, match="17 points .* parameters 18 .* neither fits"):
        kineme.read(tmp_path / "a.c3d")
