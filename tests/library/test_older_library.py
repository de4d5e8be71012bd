"""A library of before: built when primitives were called activities and confidence score.

``tests/older/library`` was built by the last version of that kind, from the recording in
``tests/older/studio``.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from kineme.errors import KinemeWarning
from kineme.labels import read_segments
from kineme.library import Library, build
from kineme.library.storage.tables import DESCRIBED

OLDER = Path(__file__).parents[1] / "older"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return shutil.copytree(OLDER / "library", tmp_path / "library")


def test_its_segments_are_told_as_today(folder: Path) -> None:
    library = Library(folder)
    segments = library.table("segments")
    assert sorted(segments.column_names) == sorted(DESCRIBED["segments"])
    told = segments.to_pydict()
    alone = read_segments(OLDER / "tables" / "found.csv").table
    assert set(zip(told["level"], told["kind"], strict=True)) == {
        ("activity", "activity"),
        ("primitive", "primitive"),
        ("primitive", "transition"),
    }
    assert len(told["kind"]) == len(told["confidence"])
    assert np.isfinite(told["confidence"]).any()
    assert alone.level.tolist()[:2] == told["level"][:2]
    (named,) = [each for each in library.clusters() if each.label == "row"]
    assert named.repetitions > 0


def test_it_is_built_on(folder: Path, tmp_path: Path) -> None:
    before = Library(folder)
    rows = before.table("segments").to_pydict()
    recording = tmp_path / "more" / "again.csv"
    recording.parent.mkdir()
    shutil.copy(OLDER / "studio" / "take.csv", recording)
    build(recording.parent, folder)
    after = Library(folder).table("segments").to_pydict()
    assert set(after["recording"]) == {"again.csv", "take.csv"}
    assert set(after["kind"]) == set(rows["kind"])


def test_constants_that_are_no_more_are_left_out_with_a_word(folder: Path) -> None:
    head = json.loads((folder / "library.json").read_text())
    head["settings"]["constants"] = {"min_action": 2.0, "link_radius": 0.4}
    (folder / "library.json").write_text(json.dumps(head))
    with pytest.warns(KinemeWarning, match="older version: link_radius; new recordings"):
        settings = Library(folder).settings
    assert settings.constants == {"min_action": 2.0}
