"""A small folder of recordings, two of a body, one of channels and one damaged, and its library."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from library_folders import write_channels

import kineme
from kineme.library import Library, build

SPANS = {"walk.bvh": (0, 1500), "jacks.bvh": (1200, 2898)}
"""Frames of the bundled recording; some are in both."""


@pytest.fixture(scope="session")
def takes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    home = tmp_path_factory.mktemp("takes")
    whole = kineme.read(kineme.bundled_recording())
    for name, (start, stop) in SPANS.items():
        kineme.write(whole[start:stop], home / name)
    write_channels(home / "wrist.csv")
    (home / "broken.bvh").write_text("HIERARCHY\nROOT hips\n{\n")
    return home


@pytest.fixture(scope="session")
def built(takes: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The library of these; not to be changed."""
    folder = tmp_path_factory.mktemp("built") / "library"
    build(takes, folder)
    return folder


@pytest.fixture
def folder(built: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    return Path(shutil.copytree(built, tmp_path / "library"))


@pytest.fixture
def library(folder: Path) -> Library:
    return Library(folder)
