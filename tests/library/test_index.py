"""Where a large library is looked through first."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import naive
from kineme.library import Example, Library, finding
from kineme.library._kernels import find_smallest_distances
from kineme.library.storage import tables as storage
from kineme.library.windows import FINER, LENGTHS, describe_at_speeds, describe_windows


def test_what_is_searched_first_holds_what_an_exact_search_finds(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    exact = Library(folder)
    monkeypatch.setattr(storage, "FROM_HOURS", 0.0)
    monkeypatch.setattr(finding, "SHARE", 0.2)
    monkeypatch.setattr(finding, "MORE", 1)
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


def test_the_window_that_is_the_example_is_the_nearest() -> None:
    features = np.random.default_rng(1).normal(size=(300, 40)).astype(np.float32)
    step = LENGTHS[1] // 2
    example = features[4 * step : 4 * step + LENGTHS[1]]
    windows, parts = describe_windows(features, LENGTHS[1]), describe_at_speeds(example)
    least = np.empty(len(windows), np.int32)
    find_smallest_distances(windows, parts, np.int32(FINER), least)
    assert least.tolist() == naive.find_smallest_distances(windows.tolist(), parts.tolist(), FINER)
    assert least.argmin() == 4
    windows[:], parts[:] = -127, 127 * FINER  # the farthest there is
    find_smallest_distances(windows, parts, np.int32(FINER), least)
    assert least.tolist() == naive.find_smallest_distances(windows.tolist(), parts.tolist(), FINER)
