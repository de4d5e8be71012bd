"""The application itself: information, help, start-up, options made from presets."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest
from typer.testing import CliRunner

import kineme as package
from kineme.cli.app import app
from kineme.datasets import bundled_recording
from kineme.methods.base import Preset
from kineme.methods.presets import PRESETS


def test_info_says_what_the_file_is(kineme) -> None:
    done = kineme("info", bundled_recording(), "--joints")
    assert (done.returncode, done.stderr) == (0, "")
    assert "2898 frames at 60 Hz, 48.30 s" in done.stdout
    assert "left wrist LeftHand" in done.stdout
    assert "unit cm inferred" in done.stdout
    assert "── " in done.stdout


def test_info_as_json(kineme) -> None:
    facts = json.loads(kineme("info", bundled_recording(), "--json", "--unit", "cm").stdout)
    assert (facts["format"], facts["frames"], facts["fps"]) == ("BVH", 2898, 60.0)
    assert facts["notes"] == []
    assert facts["end_effectors"]["head"] in facts["joints"] + facts["end_sites"]


def test_info_of_a_body_without_hands_is_no_failure(kineme, tmp_path: Path) -> None:
    (tmp_path / "stick.bvh").write_text(
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
        "End Site\n{\nOFFSET 0 90 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n0 0 0\n"
    )
    done = kineme("info", "stick.bvh", "--unit", "cm")
    assert done.returncode == 0
    assert "not found" in done.stdout


def test_end_effectors_can_be_named(kineme) -> None:
    done = kineme("info", bundled_recording(), "--json", "--effectors", "left_wrist=LeftForeArm")
    assert json.loads(done.stdout)["end_effectors"]["left_wrist"] == "LeftForeArm"


def test_version_and_completion(kineme) -> None:
    assert kineme("--version").stdout == f"kineme {package.__version__}\n"
    done = kineme(_KINEME_COMPLETE="complete_bash", COMP_WORDS="kineme se", COMP_CWORD="1")
    assert done.stdout.split() == ["segment"]


def test_help_is_light() -> None:
    code = (
        "import sys; from kineme.cli.app import app; "
        "print({'numba', 'scipy', 'matplotlib', 'pandas', 'pyarrow'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_every_constant_of_a_preset_has_an_option_with_help() -> None:
    text = CliRunner().invoke(app, ["segment", "--help"], env={"COLUMNS": "400"}).stdout
    for preset in PRESETS.values():
        for name in preset.constants():
            (line,) = (line for line in text.splitlines() if f"--{name.replace('_', '-')} " in line)
            assert f"{preset.name} " in line
            assert len(line.split("[")[0].split()) > 4, line


@pytest.mark.parametrize("preset", PRESETS.values(), ids=lambda preset: preset.name)
def test_constants_given_one_by_one_make_the_preset(
    preset: Preset, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: dict[str, object] = {}

    def remember(name: str, **overrides: object) -> Preset:
        asked.update(overrides)
        raise package.ParameterError("enough")

    monkeypatch.setattr("kineme.cli.request.resolve_preset", remember)
    options = []
    for name in preset.constants():
        options += [f"--{name.replace('_', '-')}", typed(getattr(preset, name))]
    assert CliRunner().invoke(app, ["segment", "x.bvh", *options]).exit_code == 2
    assert preset.replace(**asked) == preset
    assert set(asked) == {field.name for field in fields(preset)} - {"name", "unit"}


def typed(value: object) -> str:
    """A value as it is typed on the command line."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        pairs = isinstance(value[0], tuple)
        return (" " if pairs else ",").join(map(typed, value))
    return "none" if value is None else str(value)
