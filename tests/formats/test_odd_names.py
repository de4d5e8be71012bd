"""Names with a special meaning in a format are kept, changed with a warning, or refused."""

from __future__ import annotations

import ast
import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.datasets import bundled_recording
from kineme.errors import KinemeWarning, WriteError
from kineme.recordings import Motion, Skeleton

NAMES = [
    "Spine (1)", "MOTION Frames: 5", "motion  frames :", "\ufeffHips", "a\ud800b", "a b", "a,b",
    "a\tb", "{x}", "#c", "End Site", "", "  lead", "root", ":bonedata", "a\nb", "a.X", "x\u2028y",
    '"q"', "0", "time", "é", "HIERARCHY", "JOINT", "end", "begin", "X1", "Frame#", "a:b", "a\x00b",
    "=1+1", "n" * 300,
]  # fmt: skip
JOINT = 3


@pytest.fixture(scope="module")
def turning() -> Motion:
    motion = kineme.read(bundled_recording())
    assert isinstance(motion, Motion)
    return motion[:20]


@pytest.fixture(scope="module")
def points() -> Motion:
    names = ["Hips", "Head", "LeftHand", "Any", "RightHand", "LeftFoot", "RightFoot"]
    skeleton = Skeleton(names, [-1] * 7, np.zeros((7, 3)))
    positions = np.random.default_rng(0).normal(0, 0.2, (20, 7, 3)).cumsum(0) + 1
    return Motion(skeleton=skeleton, positions=positions, fps=30)


@pytest.mark.parametrize("suffix", [".bvh", ".amc", ".trc", ".csv", ".npz"])
@pytest.mark.parametrize("name", NAMES, ids=lambda name: ascii(name)[:20])
def test_a_name_comes_back_or_it_is_said(
    turning: Motion, points: Motion, tmp_path: Path, suffix: str, name: str
) -> None:
    plain = turning if suffix in (".bvh", ".amc") else points
    names = list(plain.skeleton.names)
    names[JOINT] = name
    motion = replace(plain, skeleton=replace(plain.skeleton, names=tuple(names)))
    path = tmp_path / f"take{suffix}"
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", KinemeWarning)
        try:
            kineme.write(motion, path)
        except WriteError as error:
            assert "is not text" in str(error)
            assert not path.exists()
            return
    changed = [re.search(r"written as (.*)$", str(each.message)) for each in said]
    written = next((ast.literal_eval(found[1]) for found in changed if found), name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        back = kineme.read(path)
    assert isinstance(back, Motion)
    assert back.n_frames == motion.n_frames
    names = back.skeleton.names
    assert written in {*names, *(each.removesuffix("_end") for each in names)}
