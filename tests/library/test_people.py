"""What a library finds across people, on real recordings."""

from __future__ import annotations

from pathlib import Path

import pytest

from kineme.library import Library, build

OTHERS = ("throwBasketball", "squat1Reps", "rotateArmsBothBackward1Reps")


@pytest.fixture(scope="module")
def exercises(data_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Library:
    """Walks of two people of CMU and of subject 86, and a few exercises of three of HDM05."""
    takes = [data_dir / "cmu_formats" / "02_01.amc", data_dir / "cmu_formats" / "49_02.amc"]
    for actor in ("bd", "bk", "dg"):
        for kind in (*OTHERS, "sneak2StepsLStart"):
            takes += sorted((data_dir / "hdm05" / "amc").glob(f"HDM_{actor}_{kind}_*.amc"))[:2]
    folder = tmp_path_factory.mktemp("people") / "library"
    built = build(takes, folder)
    assert not built.failed
    return Library(folder)


def test_a_walk_is_found_whoever_walks_and_nothing_else(exercises: Library, data_dir: Path) -> None:
    # A double step of subject 86, who is not in the library.
    hits = exercises.search(data_dir / "cmu86" / "86_01.amc", 2.0, 3.1, top=None)
    found = {hit.recording for hit in hits}
    assert "02_01.amc" in found
    assert not [name for name in found if any(kind in name for kind in OTHERS)]


def test_an_exercise_is_found_in_those_of_other_people(exercises: Library) -> None:
    names = exercises.recordings["recording"]
    example = next(name for name in names if "bd_rotate" in name)
    hits = exercises.search(example, max_per_recording=1, top=None)
    others = {hit.recording for hit in hits if "_bd_" not in hit.recording}
    assert others == {name for name in names if "rotate" in name and "_bd_" not in name}
