"""The application itself: information, help, start-up, presets and their constants."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import CliRunner

import kineme as package
from kineme.cli.app import app
from kineme.cli.options import format_value, parse_constants
from kineme.datasets import bundled_recording
from kineme.methods.base import Preset
from kineme.methods.presets import PRESETS


def test_info_says_what_the_file_is(kineme) -> None:
    done = kineme("info", bundled_recording(), "--joints", errors="")
    assert "2898 frames at 60 Hz, 48.30 s" in done.stdout
    assert "left wrist LeftHand" in done.stdout
    assert "unit cm inferred" in done.stdout
    assert "── " in done.stdout


def test_info_as_json(kineme) -> None:
    options = ("--json", "--unit", "cm", "--effectors", "left_wrist=LeftForeArm")
    facts = json.loads(kineme("info", bundled_recording(), *options).stdout)
    assert (facts["format"], facts["frames"], facts["fps"]) == ("BVH", 2898, 60.0)
    assert facts["notes"] == []
    assert facts["end_effectors"]["head"] in facts["joints"] + facts["end_sites"]
    assert facts["end_effectors"]["left_wrist"] == "LeftForeArm"


def test_version_and_completion(kineme_process) -> None:
    assert kineme_process("--version").stdout == f"kineme {package.__version__}\n"
    done = kineme_process(_KINEME_COMPLETE="complete_bash", COMP_WORDS="kineme se", COMP_CWORD="1")
    assert done.stdout.split() == ["segment"]


@pytest.mark.parametrize("words", ["--help", "evaluate --help", "segment --help"])
def test_help_is_light(words: str) -> None:
    code = (
        "import atexit, sys; from kineme.cli.app import app; heavy = "
        "{'numba', 'scipy', 'matplotlib', 'pandas', 'pyarrow', 'sklearn'}; "
        "atexit.register(lambda: print(heavy & set(sys.modules), file=sys.stderr)); app()"
    )
    command = [sys.executable, "-c", code, *words.split()]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "set()"


def commands(group=None, words: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Every command and subcommand, as the words that name it."""
    yield words
    group = group or get_command(app)
    for name in getattr(group, "commands", ()):
        yield from commands(group.commands[name], (*words, name))


@pytest.mark.parametrize("words", [*commands()], ids=" ".join)
def test_help_fits_on_a_page(words: tuple[str, ...]) -> None:
    done = CliRunner().invoke(app, [*words, "--help"], env={"COLUMNS": "80"})
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert len(lines) <= 80
    assert max(map(len, lines)) <= 80
    assert "@" not in done.stdout.replace("@START", "").replace("bvh@", "")


@pytest.mark.parametrize(
    "words",
    [
        "segment", "cycles", "report", "split -o clips", "graph -o graph.json",
        "label --labels x.json --knowledge known.npz", "transfer --knowledge known.npz",
        "library build --into lib",
    ],
)  # fmt: skip
def test_all_commands_which_segment_take_the_same_options(kineme, words: str) -> None:
    given = ["--detail", "4", "--set", "min_action=2", "--effectors", "head=Top", "--unit", "cmm"]
    done = kineme(*words.split(), "x.bvh", *given, code=2)
    assert "unit is 'cmm'" in done.stderr


def test_presets_are_listed_with_a_line_each(kineme) -> None:
    lines = kineme("presets").stdout.splitlines()
    assert [line.split()[0] for line in lines] == [*PRESETS]
    assert all(preset.help in line for preset, line in zip(PRESETS.values(), lines, strict=True))
    assert [line for line in lines if "(default)" in line] == lines[:1]


@pytest.mark.parametrize("preset", PRESETS.values(), ids=lambda preset: preset.name)
def test_the_constants_of_a_preset_are_listed(kineme, preset: Preset) -> None:
    head, *rows = (line.split("\t") for line in kineme("presets", preset.name).stdout.splitlines())
    assert head == ["constant", "value", "unit", "range", "default", "fine", "meaning"]
    told = {row[0]: row[1:] for row in rows}
    assert [*told] == [each.name for each in sorted(preset.constants(), key=lambda c: c.fine)]
    for each in preset.constants():
        value, unit, allowed, _, fine, meaning = told[each.name]
        assert (value, unit, meaning) == (format_value(each.value), each.unit, each.help)
        assert (fine == "fine") == each.fine
        if each.limits is not None:
            assert f"{each.limits.minimum:g} to " in allowed


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such terminals")
def test_on_a_terminal_they_are_a_table_for_people(tmp_path: Path) -> None:
    import pty

    leader, follower = pty.openpty()
    command = [sys.executable, "-m", "kineme", "presets", "sensors"]
    environment = {**os.environ, "COLUMNS": "80"}
    with subprocess.Popen(command, stdout=follower, env=environment) as process:
        os.close(follower)
        text = ""
        with suppress(OSError):  # so a terminal ends
            while part := os.read(leader, 4096):
                text += part.decode()
    os.close(leader)
    assert process.returncode == 0
    lines = re.sub(r"\x1b\[\d*m", "", text).splitlines()
    assert lines[0] == f"sensors: {PRESETS['sensors'].help}"
    working = next(i for i, line in enumerate(lines) if line.startswith("  working_fps"))
    assert lines[working].split() == ["working_fps", "50", "Hz", "0.1", "to", "1000", "30"]
    assert lines[working + 1].strip() == "samples per second to which the recording is resampled"
    assert any(line.startswith("Fine constants") for line in lines)
    assert max(map(len, lines)) <= 80


def test_a_preset_that_is_none_is_answered_with_the_nearest(kineme) -> None:
    for given in (["presets", "kineem"], ["segment", "x.bvh", "--preset", "kineem"]):
        done = kineme(*given, code=2)
        assert "no preset 'kineem'; did you mean kineme?" in " ".join(done.stderr.split())


@pytest.mark.parametrize("preset", PRESETS.values(), ids=lambda preset: preset.name)
def test_constants_given_one_by_one_make_the_preset(preset: Preset) -> None:
    texts = [f"{known.name}={typed(known.value)}" for known in preset.constants()]
    values = parse_constants([preset.name], texts)
    assert preset.replace(**values) == preset
    assert set(values) == {known.name for known in preset.constants()}


@pytest.mark.parametrize("command", ["segment", "library build"])
@pytest.mark.parametrize(
    ("given", "told"),
    [
        ("min_acton=2", "kineme has no parameter 'min_acton'; did you mean min_action?"),
        ("radius=0.3", "kineme has no parameter 'radius': it belongs to voegele2014"),
        ("min_action=-1", "min_action must be a number from 0 to 3600 s, not -1.0"),
        ("min_action=long", "min_action must be a number, 0 to 3600 s, not 'long'"),
        ("max_clusters=2.5", "max_clusters must be a whole number, 1 to 1000000, not '2.5'"),
        ("bands=low,high", "bands must be numbers separated by commas, each above 0 to 500"),
        ("min_action", "give NAME=VALUE, such as min_action=2, not 'min_action'"),
        ("interpolate=perhaps", "interpolate must be one of yes, no, not 'perhaps'"),
        ("growth=circles", "growth must be one of squares, scan_lines, not 'circles'"),
    ],
)
def test_a_constant_that_cannot_be_is_answered(kineme, command, given, told) -> None:
    to = ["--into", "lib"] if command == "library build" else ["-o", "out"]
    of_krueger = given.startswith(("interpolate", "growth"))
    preset = ["--preset", "krueger2017"] if of_krueger else []
    done = kineme(*command.split(), "x.bvh", *to, *preset, "--set", given, code=2)
    assert told in " ".join(done.stderr.split())
    assert "--set" in done.stderr


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (("--min-action", "2"), "No such option: --min-action; use --set min_action=2"),
        (("--min-action=2",), "No such option: --min-action; use --set min_action=2"),
        (("--radius",), "No such option: --radius; use --set radius=VALUE"),
    ],
)
def test_a_constant_as_an_option_is_told_how_it_is_set(kineme, given, told) -> None:
    done = kineme("segment", "x.bvh", *given, code=2)
    assert told in done.stderr


def typed(value: object) -> str:
    """A value as it is typed on the command line."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        pairs = isinstance(value[0], tuple)
        return (" " if pairs else ",").join(map(typed, value))
    return "none" if value is None else str(value)
