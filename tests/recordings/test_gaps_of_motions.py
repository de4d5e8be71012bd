"""Gaps of motions follow them through every operation and every file that holds positions."""

from __future__ import annotations

import tempfile
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kineme
from kineme.errors import MotionError
from kineme.recordings import Motion, Skeleton
from kineme.recordings.arrays import mark_spans
from kineme.recordings.operations import cut, move, resample, split_at_gaps

NAMES = ("pelvis", "left_hip", "right_hip", "left_ankle", "right_ankle", "head")
NAMES += ("left_wrist", "right_wrist")
REST = np.array(
    [(0, 1, 0), (0.1, 1, 0), (-0.1, 1, 0), (0.1, 0.1, 0), (-0.1, 0.1, 0), (0, 1.6, 0)]
    + [(0.3, 1, 0), (-0.3, 1, 0)]
)


def make_body(n: int = 100, fps: float = 50.0, gaps: tuple[tuple[int, int], ...] = ()) -> Motion:
    positions = np.repeat(REST[None], n, axis=0)
    positions[:, :, 2] += np.arange(n)[:, None] / fps
    parents = (-1, 0, 0, 1, 2, 0, 0, 0)
    return Motion(Skeleton(NAMES, parents, np.zeros((8, 3))), positions, fps, gaps=gaps)


@st.composite
def spans(draw: st.DrawFn, n: int = 100, apart: int = 1) -> tuple[tuple[int, int], ...]:
    found, at = [], 0
    while at < n and draw(st.booleans()):
        start = draw(st.integers(at, n - 1))
        stop = draw(st.integers(start + 1, n))
        found.append((start, stop))
        at = stop + apart
    return tuple(found)


def mark_hidden(motion: Motion) -> np.ndarray:
    return mark_spans(motion.gaps, motion.n_frames)


@given(spans(), st.integers(0, 99), st.integers(1, 100))
def test_a_cut_has_the_gaps_of_its_frames(gaps: tuple, start: int, length: int) -> None:
    motion = make_body(gaps=gaps)
    stop = min(100, start + length)
    assert np.array_equal(mark_hidden(cut(motion, start, stop)), mark_hidden(motion)[start:stop])


@given(spans(), st.sampled_from([50.0, 25.0, 10.0, 50 / 7, 30.0, 29.97, 120.0]))
def test_frames_between_seen_ones_only_count_as_seen(gaps: tuple, fps: float) -> None:
    motion = make_body(gaps=gaps)
    again = resample(motion, fps)
    at = np.arange(again.n_frames) * 50 / fps
    before = np.minimum(np.floor(at + 1e-9).astype(int), 99)
    after = np.minimum(np.ceil(at - 1e-9).astype(int), 99)
    unseen = mark_hidden(motion)
    assert np.array_equal(mark_hidden(again), unseen[before] | unseen[after])


@given(spans())
def test_parts_and_gaps_tile_the_motion(gaps: tuple) -> None:
    motion = move(make_body(gaps=gaps), (1, 0, 0))
    if mark_hidden(motion).all():
        with pytest.raises(MotionError, match="not seen in any frame"):
            split_at_gaps(motion)
        return
    parts = split_at_gaps(motion)
    seen = np.concatenate([np.arange(at, at + part.n_frames) for at, part in parts])
    assert np.array_equal(seen, np.flatnonzero(~mark_hidden(motion)))
    for start, part in parts:
        assert part.gaps == ()
        assert np.array_equal(part.positions, motion.positions[start : start + part.n_frames])


@settings(max_examples=30)
@given(st.sampled_from([".csv", ".trc", ".npz"]), spans(apart=11))
@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
def test_files_of_positions_hold_gaps(suffix: str, gaps: tuple) -> None:
    long = tuple((start, stop) for start, stop in gaps if stop - start > 10)
    motion = make_body(gaps=long)
    if sum(b - a for a, b in long) > 80:
        return
    with tempfile.TemporaryDirectory() as folder:
        kineme.write(motion, Path(folder) / f"a{suffix}")
        again = kineme.read(Path(folder) / f"a{suffix}")
    kept = mark_hidden(again)
    # What is seen for 0.2 s or less at an end of the recording becomes part of the gap.
    assert kept[mark_hidden(motion)].all()
    assert np.abs(again.positions - motion.positions)[~kept].max() < 1e-8
    assert again.n_frames == 100


def test_what_is_missing_with_the_body_only_stays(tmp_path: Path) -> None:
    names, parents = (*NAMES, "knee", "elbow"), (-1, 0, 0, 1, 2, 0, 0, 0, 1, 0)
    positions = np.repeat(REST[None, [*range(8), 3, 6]], 100, axis=0)
    positions[:, 8, 0] = np.arange(100) / 100
    skeleton = Skeleton(names, parents, np.zeros((10, 3)))
    path = tmp_path / "a.csv"
    kineme.write(Motion(skeleton, positions, 50.0, gaps=((30, 60),)), path)
    rows = path.read_text().splitlines()
    rows[80:95] = [",".join([*row.split(",")[:-3], "", "", ""]) for row in rows[80:95]]
    path.write_text("\n".join(rows) + "\n")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        again = kineme.read(path, unit="m", up="y")
    (warning,) = caught
    said = again.provenance.warnings
    assert str(warning.message) == f"{path}: {'; '.join(said)}"
    assert said[0] == "left out for gaps above 0.2 s: elbow (frames 30 to 93)"
    assert said[1].startswith("the body is incomplete in frames 30 to 59")
    assert again.gaps == ((30, 60),)
    knee = again.positions[:, again.joint("knee"), 0]
    assert knee == pytest.approx(np.arange(100) / 100)
