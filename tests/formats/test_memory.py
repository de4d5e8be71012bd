"""Small files that claim to be large are refused before memory is allocated."""

from __future__ import annotations

import io
import itertools
import resource
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import kineme
from growth import measure_peak

FRAMES = 40_000
MOST = 4 << 30
"""Bytes of address space for all of Python; reading each of these files once took more."""


def write_repeated_texts(path: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    rows = 20_000
    names = [f"{joint}_{axis}" for joint in ("a", "b") for axis in "xyz"]
    texts = pa.DictionaryArray.from_arrays(np.zeros(rows, np.int32), ["x" * 400_000])
    rng = np.random.default_rng(0)
    columns = {name: rng.normal(size=rows) for name in names} | {"time": texts}
    parquet.write_table(pa.table(columns), path, compression="brotli")


def write_channelless_bvh(path: Path) -> None:
    joints = "".join(f"JOINT j{i} {{ OFFSET 0 1 0 }}\n" for i in range(4000))
    frames = "1\n" * 20_000
    path.write_text(
        "HIERARCHY\nROOT r\n{ OFFSET 0 0 0\nCHANNELS 1 Xposition\n"
        f"{joints}}}\nMOTION\nFrames: 20000\nFrame Time: 0.01\n{frames}"
    )


@cache
def make_zeros() -> bytes:
    file = io.BytesIO()
    zeros = np.broadcast_to(np.float32(0), (3_000_000, 75))  # written in small parts
    np.savez_compressed(file, head=np.array('{"schema": "kineme.knowledge/1"}'), features=zeros)
    return file.getvalue()


def write_zeros(path: Path) -> None:
    path.write_bytes(make_zeros())


def nest_groups(path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        groups = [file.create_group(f"g{i}") for i in range(25)]
        for outer, inner in itertools.pairwise(groups):
            for name in "abcd":
                outer[name] = inner


def link_to_itself(path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        inner = file.create_group("outer/inner")
        for name in "abcd":
            inner[name] = file["outer"]


def write_long_bvh(folder: Path) -> Path:
    channels = "CHANNELS 3 Zrotation Yrotation Xrotation"
    path = folder / "long.bvh"
    path.write_text(
        "HIERARCHY\nROOT r { OFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
        f"Zrotation Yrotation Xrotation\nJOINT a {{ OFFSET 0 60 0\n{channels}\n"
        f"JOINT b {{ OFFSET 0 60 0\n{channels}\nEnd Site {{ OFFSET 0 60 0 }} }} }} }}\nMOTION\n"
        f"Frames: {FRAMES}\nFrame Time: 0.01\n" + "1 90 3 4 5 6 7 8 9 10 11 12\n" * FRAMES
    )
    return path


def test_a_long_recording_holds_little_more_than_itself(tmp_path: Path) -> None:
    path = write_long_bvh(tmp_path)
    motion = kineme.read(path)  # which imports
    assert motion.n_frames == FRAMES
    size = motion.positions.nbytes + motion.rotations.nbytes
    assert measure_peak(lambda: kineme.read(path)) < 1.8 * size


RECORDING, KNOWLEDGE = "kineme.read(path, fps=30)", "kineme.KnowledgeBase.load(path)"
FILES: list[tuple[Callable[[Path], None], str, str]] = [
    (write_repeated_texts, "a.parquet", "claims texts that repeat"),
    (write_channelless_bvh, "a.bvh", "claims 4001 joints in 20000 frames"),
    (write_zeros, "a.npz", "claims to unpack to 900 MB"),
    (write_zeros, "base.npz", "claims to unpack to 900 MB"),
    (nest_groups, "a.h5", "claims to unpack far more than it contains"),
    (link_to_itself, "a.h5", "contains a link to itself"),
]


@pytest.mark.parametrize(("make", "name", "reason"), FILES)
def test_no_reader_takes_what_the_file_cannot_fill(
    tmp_path: Path, make: Callable[[Path], None], name: str, reason: str
) -> None:
    path = tmp_path / name
    make(path)
    assert path.stat().st_size < 7_000_000
    code = (
        "import sys, kineme\n"
        "path = sys.argv[1]\n"
        f"try: {KNOWLEDGE if name == 'base.npz' else RECORDING}\n"
        "except kineme.ReadError as error: print(error)\n"
    )

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (MOST, MOST))

    ran = subprocess.run(
        [sys.executable, "-c", code, str(path)],
        capture_output=True,
        text=True,
        timeout=60,
        preexec_fn=limited,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    assert reason in ran.stdout
    assert "\n" not in ran.stdout.strip()
