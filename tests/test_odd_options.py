"""Options of levels, transfer, clips, libraries: odd values give a result or a sentence."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import pytest

import kineme
from kineme._util.json import options_from_json, options_to_json
from kineme.clips.split import split
from kineme.datasets import bundled_truth
from kineme.errors import KinemeWarning
from kineme.formats import ReadOptions
from kineme.library import Library, build
from kineme.methods.segmenter import SegmentOptions
from kineme.transfer import transfer_features
from odd_values import ODD, surprise


def surprises(door: Callable[..., object], *names: str) -> list[str]:
    """What a door raises but errors of the package, for every option and every value."""
    found = []
    for name in names:
        for value in ODD:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                warnings.simplefilter("ignore", KinemeWarning)
                if said := surprise(partial(door, **{name: value})):
                    found.append(f"{name}={value!r:.20}: {said}")
    return found


@pytest.fixture(scope="module")
def walk() -> kineme.Motion:
    motion = kineme.read(kineme.bundled_recording())
    assert isinstance(motion, kineme.Motion)
    return motion[:360]


def test_levels(walk: kineme.Motion) -> None:
    assert not surprises(kineme.segment(walk).level, "level")


def test_transfer(walk: kineme.Motion) -> None:
    found, features = kineme.segment(walk), transfer_features(walk)
    truth = kineme.read_segments(bundled_truth())
    whole = kineme.read(kineme.bundled_recording())
    base = kineme.KnowledgeBase.from_recording(whole, truth)

    def transfer(**more: Any) -> object:
        return kineme.transfer_labels(**{"segmentation": found, "features": features} | more,
                                      knowledge=base)  # fmt: skip

    assert not surprises(transfer, "threshold", "spread", "features")


def test_clips(walk: kineme.Motion, tmp_path: Path) -> None:
    found, names = kineme.segment(walk), count()

    def cut(**more: Any) -> object:
        return split(walk, found, tmp_path / str(next(names)), **more)

    assert not surprises(cut, "level", "cluster", "loops")


def test_libraries(walk: kineme.Motion, tmp_path: Path) -> None:
    kineme.write(walk, tmp_path / "walk.bvh")
    build(tmp_path / "walk.bvh", tmp_path / "library")
    library = Library(tmp_path / "library")

    def search(**more: Any) -> object:
        return library.search(**{"like": walk[:60]} | more)

    assert not surprises(search, "like", "start_s", "stop_s", "cluster", "unlike", "mirror")
    assert not surprises(search, "threshold", "top", "max_per_recording")

    def again(**more: Any) -> object:
        return build(**{"sources": (), "into": tmp_path / "library"} | more)

    assert not surprises(again, "sources", "remove", "jobs", "recursive")
    assert not surprises(again, "read_options", "segment_options")
    assert not surprises(library.numbers, "cluster")


@pytest.mark.parametrize("kind", [ReadOptions, SegmentOptions])
def test_options_of_files_and_methods(kind: type) -> None:
    def again(**given: object) -> object:
        return options_from_json(kind, options_to_json(kind(**given)))

    assert not surprises(again, *vars(kind()))
