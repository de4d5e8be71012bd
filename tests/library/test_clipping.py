"""Clips across a library: the best loops without near duplicates, coverage, hits by tag."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import kineme
from kineme.errors import ParameterError
from kineme.library import Library, build


@pytest.fixture(scope="module")
def twice(tmp_path_factory: pytest.TempPathFactory) -> Library:
    """A library of the same recording under two names, one of them cut a bit shorter."""
    home = tmp_path_factory.mktemp("twice")
    (home / "takes").mkdir()
    shutil.copy(kineme.bundled_recording(), home / "takes" / "a.bvh")
    kineme.write(kineme.read(kineme.bundled_recording())[:2890], home / "takes" / "b.bvh")
    build(home / "takes", home / "library", jobs=1)
    return Library(home / "library")


def test_duplicates_are_left_out_and_ranks_go_over_all(twice: Library, tmp_path: Path) -> None:
    paths = twice.loops(tmp_path / "clips", best=2)
    clips = json.loads((tmp_path / "clips" / "manifest.json").read_text())["clips"]
    assert len(clips) == len(paths)
    spans = [(clip["start_frame"], clip["stop_frame"]) for clip in clips]
    assert len(spans) == len(set(spans))  # each of them is in both recordings
    for cluster in {clip["cluster"] for clip in clips}:
        ranks = [clip["rank"] for clip in clips if clip["cluster"] == cluster]
        assert ranks in ([1], [1, 2])
    with pytest.raises(ParameterError, match="choose from cluster, direction, recording"):
        twice.loops(tmp_path / "more", per="take")  # type: ignore[arg-type]


def test_each_recording_can_have_its_own(twice: Library, tmp_path: Path) -> None:
    twice.loops(tmp_path / "clips", best=1, per="recording", target="unreal")
    clips = json.loads((tmp_path / "clips" / "manifest.json").read_text())["clips"]
    assert len({Path(clip["source"]).name for clip in clips}) == 2
    assert all(clip["file"].startswith("AS_") for clip in clips)


def test_coverage_tells_directions_speeds_and_turns(twice: Library) -> None:
    covered = twice.coverage()
    fast = max(covered, key=lambda each: each.fastest_m_s)
    assert fast.direction == "forwards"
    assert 2.2 < fast.fastest_m_s < 3.2
    assert max(each.left_deg for each in covered) > 90
    assert {"forwards", "in place"} == {each.direction for each in covered}


def test_a_search_finds_those_with_a_tag(twice: Library) -> None:
    hits = twice.search("a.bvh", 0.5, 1.6, top=4, tag="turn left")
    every = twice.search("a.bvh", 0.5, 1.6, top=None)
    assert 0 < len(hits) <= 4
    assert {*hits} < {*every}
    with pytest.raises(ParameterError, match="choose from forwards, backwards"):
        twice.search("a.bvh", 0.5, 1.6, tag="north")  # type: ignore[arg-type]
