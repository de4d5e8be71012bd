"""Recordings with gaps: one table, in which each gap is a transition."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import kineme
from kineme.datasets import bundled_recording
from kineme.methods.kineme.preset import KINEME


@settings(max_examples=5)
@given(st.data())
def test_a_gap_anywhere_is_a_transition(data: st.DataObject) -> None:
    motion = kineme.read(bundled_recording())
    start = data.draw(st.integers(60, motion.n_frames - 120))
    gap = (start, start + data.draw(st.integers(10, 60)))
    broken = kineme.segment(replace(motion, gaps=(gap,)))
    assert broken.provenance["gaps"] == [list(gap)]
    row = broken.activities.start_frame.tolist().index(gap[0])
    assert broken.activities[row].kind == "transition"
    assert broken.activities[row].stop_frame == gap[1]
    assert broken.n_frames == motion.n_frames


def test_a_gap_in_a_real_recording(data_dir: Path, tmp_path: Path) -> None:
    motion = kineme.read(data_dir / "cmu86" / "86_01.amc")
    whole = kineme.segment(motion)
    gap = (1500, 1900)  # inside a walk, 3.3 s of 38 s
    holed = replace(motion, gaps=(gap,))
    broken = kineme.segment(holed, preset=KINEME)
    far = [cut for cut in whole.cuts() if not gap[0] - 120 <= cut <= gap[1] + 120]
    assert max(np.abs(broken.cuts() - cut).min() for cut in far) <= 0.5 * motion.fps
    before, after = (broken.per_frame("cluster", level="activity")[f] for f in (1499, 1900))
    assert before == after >= 0
    kineme.plot_segmentation(broken, holed, tmp_path / "a.png")


def test_a_clock_that_is_set_leaves_no_crumbs_beside_the_jump() -> None:
    t = np.arange(2000) / 50
    rng = np.random.default_rng(0)
    one = np.column_stack([np.sin(6 * t), np.cos(6 * t)])
    two = np.column_stack([np.sin(11 * t) ** 3, np.cos(11 * t)])
    values = np.where((t < 20)[:, None], one, two) + 0.05 * rng.standard_normal((2000, 2))
    segments = kineme.segment(kineme.Signals(values, 50, gaps=[(999, 1000)]))
    assert segments.cuts().tolist() == [999, 1000]
