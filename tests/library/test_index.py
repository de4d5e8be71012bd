"""Where a large library is looked through first."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import naive
from kineme.library import Example, Library, searching
from kineme.library._kernels import least_squares
from kineme.library.searching import Parts
from kineme.library.storage import index as storage
from kineme.library.windows import (
    FINER,
    LENGTHS,
    all_windows,
    count,
    group_by_length,
    parts_at_speeds,
    windows_of,
)


def test_what_is_searched_first_holds_what_an_exact_search_finds(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    exact = Library(folder)
    monkeypatch.setattr(storage, "FROM_HOURS", 0.0)
    monkeypatch.setattr(searching, "SHARE", 0.2)
    monkeypatch.setattr(searching, "MORE", 1)
    storage.write_index(folder, exact.head["tables"], exact.recordings)
    indexed = Library(folder)
    for example in (Example("walk.bvh", 2.0, 3.2), Example("jacks.bvh", 4.0, 7.5)):
        few, all_ = (
            {(hit.recording, hit.start_s): hit.distance for hit in library.search(example, top=5)}
            for library in (indexed, exact)
        )
        assert len(few.keys() & all_.keys()) >= 0.8 * len(all_)
        assert min(few.values()) < 0.01
    clean = indexed.search("wrist.csv", 2.0, 4.0, top=3)  # channels have no index
    assert clean == exact.search("wrist.csv", 2.0, 4.0, top=3)


def test_windows_of_all_lengths_are_told_apart_again() -> None:
    random = np.random.default_rng(0)
    for n in (1, 14, 15, 61, 200):
        features = random.normal(size=(n, 40)).astype(np.float32)
        laid = dict(group_by_length(all_windows(features), n))
        assert {length: len(own) for length, own in laid.items()} == {
            length: int(count(np.array(n), length)) for length in LENGTHS
        }
        for length, own in laid.items():
            assert np.array_equal(own, windows_of(features, length))
    assert int(count(np.array(0), 15)) == 0


def test_the_window_that_is_the_example_is_the_nearest() -> None:
    features = np.random.default_rng(1).normal(size=(300, 40)).astype(np.float32)
    step = LENGTHS[1] // 2
    example = features[4 * step : 4 * step + LENGTHS[1]]
    windows, parts = windows_of(features, LENGTHS[1]), parts_at_speeds(example)
    least = np.empty(len(windows), np.int32)
    least_squares(windows, parts, np.int32(FINER), least)
    assert least.tolist() == naive.least_squares(windows.tolist(), parts.tolist(), FINER)
    assert least.argmin() == 4
    windows[:], parts[:] = -127, 127 * FINER  # the farthest there is
    least_squares(windows, parts, np.int32(FINER), least)
    assert least.tolist() == naive.least_squares(windows.tolist(), parts.tolist(), FINER)


def test_parts_that_overlap_are_one_within_a_recording() -> None:
    parts = Parts(*map(np.array, ([1, 0, 0, 0], [0, 5, 0, 30], [10, 20, 8, 40])))
    assert [column.tolist() for column in searching.merge_overlapping(parts)] == [
        [0, 0, 1],
        [0, 30, 0],
        [20, 40, 10],
    ]
