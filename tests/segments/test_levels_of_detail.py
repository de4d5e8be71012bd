"""Levels of detail: nested in each other, kept in files, dropped by edits."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kineme
from kineme.errors import ParameterError, ReadError
from kineme.labels import read_segments, write_segments
from kineme.segments.editing import name_cluster
from kineme.segments.hierarchy import Hierarchy
from kineme.segments.segmentation import Segmentation
from segmentations import make_activities

FPS = 30.0


def wandering(seed: int, seconds: float) -> kineme.Signals:
    """Make channels that repeat random patterns, with noise and pauses."""
    rng = np.random.default_rng(seed)
    patterns = rng.standard_normal((4, 30, 3)).cumsum(axis=1)
    rows: list[np.ndarray] = []
    while sum(map(len, rows)) < seconds * FPS:
        pattern = patterns[rng.integers(4)]
        length = int(rng.integers(12, 60))
        at = np.linspace(0, 29, length).astype(int)
        rows += [pattern[at]] * int(rng.integers(1, 6))
        if rng.random() < 0.5:
            rows.append(np.repeat(rows[-1][-1:], int(rng.integers(5, 90)), axis=0))
    values = np.concatenate(rows)[: int(seconds * FPS)]
    return kineme.Signals(values + 0.05 * rng.standard_normal(values.shape), FPS)


@cache
def found(seed: int, seconds: float, preset: str) -> Segmentation:
    return kineme.segment(wandering(seed, seconds), preset=kineme.PRESETS[preset])


@given(
    st.integers(0, 10**6),
    st.floats(0.1, 40.0),
    st.sampled_from(["kineme", "sensors"]),
    st.lists(st.floats(0.05, 20.0), min_size=1, max_size=4),
)
@settings(max_examples=20, deadline=None)
def test_every_border_at_one_detail_is_one_at_any_finer_one(seed, seconds, preset, asked) -> None:
    whole = found(seed, seconds, preset)
    assert whole.hierarchy is not None
    details = sorted({*asked, 1.0, *whole.hierarchy.details})
    results = [whole.at_detail(detail) for detail in details]
    for coarse, fine in pairwise(results):
        for level in ("activity", "primitive"):
            assert set(coarse.cuts(level).tolist()) <= set(fine.cuts(level).tolist())
        clusters = np.column_stack(
            [each.per_frame("cluster", level="activity") for each in (coarse, fine)]
        )
        parents = np.unique(clusters[(clusters >= 0).all(axis=1)], axis=0)[:, 1]
        assert len(parents) == len(set(parents.tolist())), "a cluster is part of two coarser ones"
    assert whole.at_detail(1) == whole
    assert all(result.at_detail(1) == whole for result in results)


def test_the_coarsest_is_one_activity_and_finer_ones_have_more() -> None:
    whole = kineme.segment(kineme.read(kineme.bundled_recording()))
    counts = [len(whole.at_detail(detail).activities) for detail in (0.01, 0.5, 1, 100)]
    assert counts == sorted(counts)
    assert counts[0] == 1 < counts[1] < counts[2]
    assert whole.at_detail(100).provenance["detail"] > 1


def test_borders_know_the_detail_at_which_they_appear() -> None:
    whole = found(3, 30.0, "sensors")
    assert whole.hierarchy is not None
    frames, details = whole.hierarchy.borders()
    for detail in whole.hierarchy.details:
        assert frames[details <= detail].tolist() == whole.at_detail(detail).cuts().tolist()


def test_methods_without_levels_have_one() -> None:
    whole = kineme.segment(kineme.read(kineme.bundled_recording()), preset="voegele2014")
    assert whole.hierarchy is None
    assert whole.at_detail(0.1) is whole.at_detail(7) is whole


@pytest.mark.parametrize("detail", [0, -1, float("nan"), float("inf"), True, None])
def test_what_is_no_detail_is_refused(detail) -> None:
    with pytest.raises(ParameterError, match="detail"):
        found(0, 5.0, "sensors").at_detail(detail)


@pytest.mark.parametrize("suffix", [".json", ".csv", ".parquet"])
@pytest.mark.parametrize("detail", [0.5, 1.0, 4.0])
def test_files_keep_every_detail(tmp_path: Path, suffix: str, detail: float) -> None:
    result = found(5, 30.0, "kineme").at_detail(detail)
    path = tmp_path / f"take{suffix}"
    write_segments(result, path)
    again = read_segments(path)
    assert again == result
    assert again.at_detail(1) == result.at_detail(1)


def test_a_csv_that_was_edited_has_one_detail(tmp_path: Path) -> None:
    path = tmp_path / "take.csv"
    result = found(5, 30.0, "sensors")
    write_segments(result, path)
    first = result.cuts()[0]
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(line.replace(f",{first},", f",{first + 1},") for line in lines))
    edited = read_segments(path)
    assert edited.hierarchy is None
    assert edited.provenance["notes"]


def test_a_damaged_hierarchy_is_said(tmp_path: Path) -> None:
    path = tmp_path / "take.json"
    write_segments(found(5, 30.0, "sensors"), path)
    path.write_text(path.read_text().replace('"detail": 1.0', '"detail": 7.5', 1))
    with pytest.raises(ReadError, match="hierarchy"):
        read_segments(path)


def test_an_edit_leaves_one_detail() -> None:
    whole = found(5, 30.0, "sensors")
    edited = name_cluster(whole, 0, "walk")
    assert edited.hierarchy is None
    assert replace(whole, table=whole.table[:]).hierarchy == whole.hierarchy
    assert replace(whole, table=edited.table).hierarchy is None
    assert edited.at_detail(0.5) is edited


def test_tables_that_are_not_nested_are_refused() -> None:
    coarse, fine = (make_activities(*stops, 90).table for stops in ((40,), (50, 60)))
    with pytest.raises(ParameterError, match="border at frame 40"):
        Hierarchy((0.5, 1.0), (coarse, fine))
