"""The application itself: information, help, start-up, options made from presets."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import kineme as package
from kineme.cli.app import app
from kineme.cli.options.constant_texts import shown
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


def test_version_and_completion(kineme_process) -> None:
    assert kineme_process("--version").stdout == f"kineme {package.__version__}\n"
    done = kineme_process(_KINEME_COMPLETE="complete_bash", COMP_WORDS="kineme se", COMP_CWORD="1")
    assert done.stdout.split() == ["segment"]


def test_help_is_light() -> None:
    code = (
        "import sys; from kineme.cli.app import app; "
        "print({'numba', 'scipy', 'matplotlib', 'pandas', 'pyarrow'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def help_of(command: str) -> str:
    done = CliRunner().invoke(app, [command, "--help"], env={"COLUMNS": "400", "NO_COLOR": "1"})
    return done.stdout


def line_of(option: str, text: str) -> str:
    (line,) = (line for line in text.splitlines() if f"--{option.replace('_', '-')} " in line)
    return line


@pytest.mark.parametrize("command", ["segment", "split", "report"])
def test_every_constant_of_a_preset_has_an_option_with_help(command: str) -> None:
    text = help_of(command)
    for preset in PRESETS.values():
        assert f"{preset.name}: {preset.help}" in text
        for known in preset.constants():
            line = line_of(known.name, text)
            assert known.help in line
            (values,) = re.findall(r"\[([^]]*)\]", line)
            assert shown(known.value) in values
            assert preset.name in values or ";" not in values


def test_finer_constants_come_last() -> None:
    text = help_of("segment")
    fine = [known for preset in PRESETS.values() for known in preset.constants() if known.fine]
    rest = [known for preset in PRESETS.values() for known in preset.constants() if not known.fine]
    assert fine
    start = text.index("Finer constants")
    assert all(text.index(line_of(known.name, text)) > start for known in fine)
    assert all(text.index(line_of(known.name, text)) < start for known in rest)


@pytest.mark.parametrize("preset", PRESETS.values(), ids=lambda preset: preset.name)
def test_constants_given_one_by_one_make_the_preset(
    preset: Preset, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: dict[str, object] = {}

    def remember(name: str, **constants: object) -> Preset:
        asked.update(constants)
        raise package.ParameterError("enough")

    monkeypatch.setattr("kineme.cli.options.request.resolve_preset", remember)
    options = []
    for known in preset.constants():
        options += [f"--{known.name.replace('_', '-')}", typed(known.value)]
    given = ["segment", "x.bvh", "--preset", preset.name, *options]
    assert CliRunner().invoke(app, given).exit_code == 2
    assert preset.replace(**asked) == preset
    assert set(asked) == {known.name for known in preset.constants()}


def test_a_value_that_is_none_names_its_option(kineme) -> None:
    done = kineme("segment", "x.bvh", "--preset", "krueger2017", "--interpolate", "perhaps")
    assert done.returncode == 2
    told = " ".join(done.stderr.split())
    assert "--interpolate" in told
    assert "'perhaps' is not yes|no" in told
    done = kineme("segment", "x.bvh", "--radius", "0.3")
    assert done.returncode == 2
    assert "kineme has no parameter 'radius'" in " ".join(done.stderr.split())


THIRD_PARTY = """
from dataclasses import dataclass

from kineme.methods import Preset, constant, register
from kineme.methods.baselines.presets import UniformPreset


@dataclass(frozen=True, kw_only=True)
class Toy(UniformPreset):
    method = "toy"
    averaging: int = constant("whatever a toy averages over", unit="samples", default=7)
    level: int = constant("called as an option of the command", default=1)


register(Toy(name="toy", help="Cuts as a toy does.", interval=2.0))

from kineme.cli import main

main()
"""


def test_the_preset_of_another_package_is_an_option_like_any_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "400")
    monkeypatch.setenv("NO_COLOR", "1")

    def toy(*arguments: object) -> str:
        given = [sys.executable, "-c", THIRD_PARTY, *map(str, arguments)]
        done = subprocess.run(given, capture_output=True, text=True, check=True, cwd=tmp_path)
        return done.stdout

    text = toy("segment", "--help")
    assert "toy: Cuts as a toy does." in text
    averaging = line_of("averaging", text)
    assert "means and energies are taken over this" in averaging  # as kineme means it
    assert re.search(r"\[.*kineme.* 1\]", averaging)
    after = text[text.index(averaging) + len(averaging) :].splitlines()[1]
    assert "whatever a toy averages over, samples [toy 7]" in after
    data = json.loads(
        toy("segment", bundled_recording(), "--preset", "toy", "--averaging", 9, "--json")
    )
    parameters = data["provenance"]["parameters"]
    assert (parameters["averaging"], parameters["interval"], parameters["level"]) == (9, 2.0, 1)
    assert len(data["segments"]) == 25


def typed(value: object) -> str:
    """A value as it is typed on the command line."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        pairs = isinstance(value[0], tuple)
        return (" " if pairs else ",").join(map(typed, value))
    return "none" if value is None else str(value)
