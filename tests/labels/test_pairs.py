"""A table and the file beside it: one that belongs to another table is noticed."""

from __future__ import annotations

import json
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

import kineme
from kineme.errors import KinemeWarning, ReadError
from kineme.labels.bids import sidecar_path
from kineme.labels.csv_table import provenance_path

Beside = Callable[[Path], Path]
PAIRS: list[tuple[str, str, Beside]] = [
    ("a.csv", "csv", provenance_path),
    ("a.tsv", "bids", sidecar_path),
]


def table(folder: Path, name: str, form: str, fps: float, label: str) -> Path:
    folder.mkdir()
    path = folder / name
    columns = {
        "level": ["activity", "activity"],
        "kind": ["activity", "activity"],
        "start_frame": [0, 60],
        "stop_frame": [60, 120],
        "label": [label, "squat"],
    }
    segments = kineme.Segmentation.from_columns(columns, n_frames=120, fps=fps)
    kineme.write_segments(segments, path, format=form)
    return path


@pytest.mark.parametrize(("name", "form", "beside"), PAIRS)
def test_killed_between_the_two_renames(
    tmp_path: Path, name: str, form: str, beside: Beside
) -> None:
    old = table(tmp_path / "old", name, form, 120.0, "walk")
    new = table(tmp_path / "new", name, form, 60.0, "walk")
    assert kineme.read_segments(new, format=form).fps == 60.0
    shutil.copy(new, old)
    with pytest.raises(ReadError, match=r"is of 60 frames per second, but .* speaks of 120"):
        kineme.read_segments(old, format=form)


@pytest.mark.parametrize(("name", "form", "beside"), PAIRS)
def test_cuts_of_another_table_are_said(
    tmp_path: Path, name: str, form: str, beside: Beside
) -> None:
    path = table(tmp_path / "a", name, form, 60.0, "walk")
    path.write_text(path.read_text().replace("60", "61"))
    said = f"not the table that {beside(path).name} was written with"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        moved = kineme.read_segments(path, format=form)
    assert any(said in note for note in moved.provenance["notes"])
    assert moved.fps == 60.0


@pytest.mark.parametrize(("name", "form", "beside"), PAIRS)
def test_labels_may_be_edited(tmp_path: Path, name: str, form: str, beside: Beside) -> None:
    path = table(tmp_path / "a", name, form, 60.0, "walk")
    path.write_text(path.read_text().replace("walk", "jump"))
    edited = kineme.read_segments(path, format=form)
    assert edited.activities.label.tolist() == ["jump", "squat"]
    assert beside(path).name not in str(edited.provenance.get("notes", ""))


def test_an_odd_number_of_frames_is_told_on_one_line(tmp_path: Path) -> None:
    path = table(tmp_path / "a", "a.csv", "csv", 60.0, "walk")
    head = json.loads(provenance_path(path).read_text())
    provenance_path(path).write_text(json.dumps({**head, "n_frames": "a\nb"}))
    with pytest.raises(ReadError, match=r"speaks of 'a\\nb' frames"):
        kineme.read_segments(path)
