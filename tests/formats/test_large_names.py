"""Reading time grows linearly with the number of names, columns or branches."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import kineme
from growth import LINEAR, times_longer
from kineme.features.effectors import find_by_shape
from kineme.formats.files import FileContent
from kineme.formats.skeletons.asf import read_asf

N = 20_000


def test_many_bones(tmp_path: Path) -> None:
    def read(n: int) -> None:
        bones = "".join(f"begin\nname b{i}\ndirection 0 1 0\nlength 1\nend\n" for i in range(n))
        tree = "".join(f"b{i - 1} b{i}\n" for i in range(1, n))
        text = f":root\norder TX TY TZ\n:bonedata\n{bones}:hierarchy\nbegin\nroot b0\n{tree}end\n"
        figure = read_asf(FileContent(tmp_path / "a.asf", text.encode()))
        assert figure.skeleton.n_joints == n + 2

    assert times_longer(read, N // 2) < LINEAR


def test_many_end_sites(tmp_path: Path) -> None:
    def read(n: int) -> None:
        ends = "End Site\n{\nOFFSET 0 0.001 0\n}\n" * n
        text = (
            "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
            f"{ends}}}\nMOTION\nFrames: 2\nFrame Time: 0.01\n0 1 0\n0 1 0\n"
        )
        (tmp_path / "a.bvh").write_text(text)
        motion = kineme.read(tmp_path / "a.bvh", unit=1.7)
        assert motion.skeleton.names[-1] == f"hip_end{n}"
        assert np.isfinite(motion.positions).all()

    assert times_longer(read, N // 2) < LINEAR


def test_thousands_of_columns_are_read_and_written(tmp_path: Path) -> None:
    def read_and_write(n: int) -> None:
        names = [f"channel_{i}" for i in range(n)]
        rows = "".join(
            ",".join([f"{t / 50}", *["0.5", "1.5"][:: 1 - 2 * (t % 2)] * (n // 2)]) + "\n"
            for t in range(3)
        )
        (tmp_path / "wide.csv").write_text(",".join(["time", *names]) + "\n" + rows)
        wide = kineme.read(tmp_path / "wide.csv")
        kineme.write(wide, tmp_path / "again.csv")
        assert (wide.n_channels, wide.fps) == (n, 50)

    assert times_longer(read_and_write, 16_000) < LINEAR


def test_thousands_of_branches_at_one_joint() -> None:
    def look(n: int) -> None:
        parents = [-1] + [0] * n + list(range(1, n + 1))
        find_by_shape(parents, np.random.default_rng(0).normal(size=(len(parents), 3)))

    assert times_longer(look, 3200) < LINEAR
