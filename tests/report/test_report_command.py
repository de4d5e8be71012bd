"""``kineme report`` and ``kineme segment --report`` as people type them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from click.testing import Result
from typer.testing import CliRunner

import kineme
from kineme.cli.app import app
from kineme.datasets import bundled_recording
from kineme.recordings.operations import cut
from segmentations import make_activities

MOTION = cut(kineme.read(bundled_recording()), 0, 900)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two recordings in the folder at work."""
    monkeypatch.chdir(tmp_path)
    for name in ("one.bvh", "two.bvh"):
        kineme.write(MOTION, name)
    return tmp_path


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, list(arguments))


def read_shown(path: Path) -> dict[str, object]:
    text = path.read_text(encoding="utf-8")
    found = re.search(r'<script[^>]*id="kineme-recording">(.*?)</script>', text, re.DOTALL)
    return json.loads(found[1])


def test_a_page_per_recording_beside_the_prompt(folder: Path) -> None:
    result = run("report", "one.bvh", "two.bvh")
    assert result.exit_code == 0, result.output
    assert result.output.split() == ["one.html", "two.html"]
    assert read_shown(folder / "one.html")["name"] == "one.bvh"


def test_corrected_tables_are_shown(folder: Path) -> None:
    columns = {"kind": ["activity", "transition"], "label": ["<b>squat</b>", ""]}
    table = make_activities(500, 900, fps=60, **columns)
    for name in ("one", "two"):
        kineme.write_segments(table, folder / f"{name}.segments.json")
    assert run("report", "one.bvh", "--segments", "one.segments.json").exit_code == 0
    assert run("report", "one.bvh", "two.bvh", "--segments", ".", "-o", "all").exit_code == 0
    for page in ("one.html", "all/one.html", "all/two.html"):
        rows = read_shown(folder / page)["segmentation"]["segments"]
        assert [row["label"] for row in rows] == ["<b>squat</b>", ""]
    result = run("report", "one.bvh", "two.bvh", "--segments", "one.segments.json")
    assert result.exit_code == 2
    assert "one file for 2 recordings" in result.output


def test_segmenting_writes_the_page_on_the_way(folder: Path) -> None:
    result = run("segment", "one.bvh", "-o", "one.json", "--report", "{name}.page.html", "--quiet")
    assert result.exit_code == 0, result.output
    message = read_shown(folder / "one.page.html")
    table = json.loads((folder / "one.json").read_text(encoding="utf-8"))
    assert message["segmentation"]["segments"] == table["segments"]
    assert message["motion"]["n_samples"] == 450


def test_targets_are_checked_before_any_work(folder: Path) -> None:
    for arguments in (
        ("report", "one.bvh", "-o", "page.pdf"),
        ("segment", "one.bvh", "--report", "page.png"),
    ):
        result = run(*arguments)
        assert result.exit_code == 2
        assert "suffix must be one of .html" in result.output
    assert run("segment", "one.bvh", "two.bvh", "--report", "page.html").exit_code == 2
    assert sorted(path.name for path in folder.iterdir()) == ["one.bvh", "two.bvh"]
