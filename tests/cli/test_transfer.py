"""``kineme label`` and ``kineme transfer`` from file to file."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import kineme as package
from kineme.datasets import bundled_recording
from kineme.datasets.bundled import bundled_truth
from kineme.transfer import KnowledgeBase


@pytest.fixture(scope="module")
def base(kineme_in, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the true segments of the recording teach."""
    folder = tmp_path_factory.mktemp("base")
    path = folder / "base.npz"
    recording = shutil.copy(bundled_recording(), folder / "exercises.bvh")
    done = kineme_in(folder, "label", recording, "--labels", bundled_truth(), "--knowledge", path)
    assert f"{len(KnowledgeBase.load(path))} primitives in all" in done.stdout
    return path


@pytest.fixture
def taught(base: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(base, tmp_path))


def test_what_was_taught_is_found_again(kineme, tmp_path, recording, taught) -> None:
    done = kineme("transfer", recording, "--knowledge", taught, "-o", "named.csv")
    written = package.read_segments(tmp_path / "named.csv")
    truth = package.read_segments(bundled_truth())
    own, right = (s.per_frame("label", level="activity") for s in (written, truth))
    named = own != ""
    assert named.mean() > 0.5
    assert (own == right)[named].mean() > 0.85
    assert "unlabelled primitives labelled" in done.stdout


def test_labelling_twice_adds_nothing(kineme, recording, taught) -> None:
    before = KnowledgeBase.load(taught)
    kineme("label", recording, "--labels", bundled_truth(), "--knowledge", taught, "-q")
    assert KnowledgeBase.load(taught).counts() == before.counts()


def test_of_labels_of_many_recordings_its_own_are_taken(kineme, tmp_path, recording) -> None:
    rows = "recording,start_s,stop_s,label\nother,0,99,run\nexercises,0,20,walk\n"
    (tmp_path / "labels.csv").write_text(rows)
    done = kineme(
        "label", recording, "--labels", "labels.csv", "--knowledge", "new.npz", "-q", errors=""
    )
    assert done.stdout == ""
    assert set(KnowledgeBase.load(tmp_path / "new.npz").counts()) == {"walk"}


def test_json_holds_costs_and_options(kineme, recording, taught) -> None:
    options = ("--threshold", 0.05, "--spread", "--json")
    done = kineme("transfer", recording, "--knowledge", taught, "--knowledge", taught, *options)
    transfer = json.loads(done.stdout)["provenance"]["transfer"]
    assert (transfer["threshold"], transfer["spread"]) == (0.05, True)


def test_what_goes_wrong_is_one_line(kineme, tmp_path, recording, taught) -> None:
    (tmp_path / "bad.npz").write_bytes(b"PK")
    before = taught.read_bytes()
    for arguments, reason in (
        (("transfer", recording, "--knowledge", "bad.npz"), "is not a knowledge base"),
        (("transfer", recording, "--knowledge", "gone.npz"), "no such file"),
        (("label", recording, "--labels", "gone.csv", "--knowledge", taught), "gone.csv"),
        (("label", recording, "--labels", bundled_truth(), "--knowledge", "bad.npz"), "bad.npz"),
    ):
        done = kineme(*arguments, code=1)
        assert len(done.stderr.splitlines()) == 1
        assert reason in done.stderr
    assert taught.read_bytes() == before
    assert (tmp_path / "bad.npz").read_bytes() == b"PK"
    kineme("transfer", recording, "--knowledge", taught, "--threshold", 0, code=2)
