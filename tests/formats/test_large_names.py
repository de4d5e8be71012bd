"""Files of very many names are read in a time that grows with them, not with their square."""

from __future__ import annotations

import time
from itertools import count

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import kineme
from kineme.formats.files import FileContent, unique
from kineme.formats.skeletons.asf import read_asf

N = 20_000
SECONDS = 5.0  # a square of N takes minutes


@given(st.lists(st.sampled_from(["a", "b", "a_2", "a_3", "", "_2", "a_2_2", "_3"]), max_size=14))
def test_names_made_unique_are_those_of_the_plain_way(names: list[str]) -> None:
    given_: list[str] = []
    for name in names:
        tries = (name if i == 1 else f"{name}_{i}" for i in count(1))
        given_.append(next(new for new in tries if new and new not in given_))
    assert unique(names) == given_


def test_many_names() -> None:
    start = time.process_time()
    assert len(set(unique(["a"] * 60_000))) == 60_000
    assert unique(map(str, range(60_000)))[-1] == "59999"
    assert time.process_time() - start < SECONDS


def test_many_bones(tmp_path) -> None:
    bones = "".join(f"begin\nname b{i}\ndirection 0 1 0\nlength 1\nend\n" for i in range(N))
    tree = "".join(f"b{i - 1} b{i}\n" for i in range(1, N))
    text = f":root\norder TX TY TZ\n:bonedata\n{bones}:hierarchy\nbegin\nroot b0\n{tree}end\n"
    start = time.process_time()
    figure = read_asf(FileContent(tmp_path / "a.asf", text.encode()))
    assert figure.skeleton.n_joints == N + 2
    assert time.process_time() - start < SECONDS


def test_many_end_sites(tmp_path) -> None:
    ends = "End Site\n{\nOFFSET 0 0.001 0\n}\n" * N
    text = (
        "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
        f"{ends}}}\nMOTION\nFrames: 2\nFrame Time: 0.01\n0 1 0\n0 1 0\n"
    )
    (tmp_path / "a.bvh").write_text(text)
    start = time.process_time()
    motion = kineme.read(tmp_path / "a.bvh", unit=1.7)
    assert motion.skeleton.names[-1] == f"hip_end{N}"
    assert np.isfinite(motion.positions).all()
    assert time.process_time() - start < SECONDS
