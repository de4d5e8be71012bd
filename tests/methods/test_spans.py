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
from kineme.methods.segmenter import (
    RecordedSpan,
    convert_to_frames,
    find_gaps,
)


@st.composite
def recordings(draw: st.DrawFn) -> tuple[list[RecordedSpan], dict[str, np.ndarray], int, int]:
    """Draw parts, a table of working frames, source frames, and frames per working frame."""
    ratio = draw(st.integers(1, 4))
    parts, at = [], draw(st.integers(0, 5))
    for _ in range(draw(st.integers(1, 4))):
        n = draw(st.integers(1, 12))
        parts.append(RecordedSpan(at, at + n * ratio - draw(st.integers(0, ratio - 1)), n))
        at = parts[-1].stop + draw(st.integers(1, 9))
    n_frames = parts[-1].stop + draw(st.integers(0, 5))
    working = sum(part.n_samples for part in parts)
    inner = draw(st.sets(st.integers(1, working - 1))) if working > 1 else set()
    cuts = np.array([0, *sorted(inner), working])
    n = len(cuts) - 1
    columns = {
        "level": np.repeat(["activity", "primitive"], n),
        "kind": np.full(2 * n, "activity"),
        "start_frame": np.tile(cuts[:-1], 2),
        "stop_frame": np.tile(cuts[1:], 2),
        "cluster": np.tile(np.arange(n), 2),
        "confidence": np.ones(2 * n),
    }
    return parts, columns, n_frames, ratio


@given(recordings())
def test_every_working_frame_keeps_its_segment(recording: tuple) -> None:
    parts, columns, n_frames, ratio = recording
    placed = convert_to_frames(columns, parts, n_frames, ratio)
    table = kineme.Segmentation.from_columns(placed, n_frames=n_frames, fps=30)
    found = table.per_frame("cluster")
    of_working = np.repeat(columns["cluster"], columns["stop_frame"] - columns["start_frame"])[
        : sum(part.n_samples for part in parts)
    ]
    first = 0
    for part in parts:
        at = part.start + ratio * np.arange(part.n_samples)
        assert np.array_equal(found[at], of_working[first : first + part.n_samples])
        first += part.n_samples
    for start, stop in find_gaps(parts, n_frames):
        assert (found[start:stop] == -1).all()
        row = table.activities.start_frame.tolist().index(start)
        assert table.activities[row].kind == "transition"
        assert table.activities[row].stop_frame == stop


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


@given(recordings(), st.integers(1, 4))
def test_no_segment_begins_shortly_after_a_gap(recording: tuple, near: int) -> None:
    parts, columns, n_frames, ratio = recording
    placed = convert_to_frames(columns, parts, n_frames, ratio, near=near)
    table = kineme.Segmentation.from_columns(placed, n_frames=n_frames, fps=30)  # it tiles
    for level in ("activity", "primitive"):
        cuts = table.cuts(level)
        for part in parts[1:]:
            soon = min(part.start + near * ratio, part.stop)
            assert not ((cuts > part.start) & (cuts < soon)).any()
    found, plain = table.per_frame("cluster"), convert_to_frames(columns, parts, n_frames, ratio)
    before = kineme.Segmentation.from_columns(plain, n_frames=n_frames, fps=30)
    away = np.zeros(n_frames, np.bool_)
    for part in parts:
        away[part.start + near * ratio : max(0, part.stop - near * ratio)] = True
    assert np.array_equal(found[away], before.per_frame("cluster")[away])


def test_a_clock_that_is_set_leaves_no_crumbs_beside_the_jump() -> None:
    t = np.arange(2000) / 50
    rng = np.random.default_rng(0)
    one = np.column_stack([np.sin(6 * t), np.cos(6 * t)])
    two = np.column_stack([np.sin(11 * t) ** 3, np.cos(11 * t)])
    values = np.where((t < 20)[:, None], one, two) + 0.05 * rng.standard_normal((2000, 2))
    segments = kineme.segment(kineme.Signals(values, 50, gaps=[(999, 1000)]))
    assert segments.cuts().tolist() == [999, 1000]
