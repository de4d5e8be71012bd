"""The code in the README and the documentation runs as it stands there.

Each page is run from top to bottom in an empty folder that holds a copy of the
bundled recording as ``take.bvh``. Blocks marked ``python`` and ``bash`` are
run; what sets up an environment is marked ``sh`` and left to ``.ci/run``.
"""

from __future__ import annotations

import datetime as dt
import json
import os
import re
import runpy
import shutil
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from sybil import Example, Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser

import _figures
from kineme.datasets import bundled_recording
from kineme.labels import read_segments, write_segments
from kineme.methods.base import Preset
from kineme.methods.recurrence.preset import KINEME
from kineme.methods.region_growing.preset import KRUEGER2017, VOEGELE2014

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
FIGURES = json.loads((ROOT / "docs" / "figures.json").read_text(encoding="utf-8"))
FILL = runpy.run_path(str(ROOT / "docs" / "fill_figures.py"))


def run_in_shell(example: Example) -> None:
    """Each command with the tests' own interpreter and its scripts first on the path."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", example.parsed],
        env={**os.environ, "PATH": path, "COLUMNS": "100"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, f"{example.parsed}\n{done.stdout}\n{done.stderr}"


BLOCKS = Sybil(parsers=[PythonCodeBlockParser(), CodeBlockParser("bash", run_in_shell)])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_code_blocks_run(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copy(bundled_recording(), tmp_path / "take.bvh")
    monkeypatch.chdir(tmp_path)
    for example in BLOCKS.parse(page).examples():
        example.evaluate()


def test_json_schema_of_the_docs_is_that_of_the_files(tmp_path: Path) -> None:
    schema = json.loads((ROOT / "docs" / "segments.schema.json").read_text(encoding="utf-8"))
    truth = read_segments(bundled_recording().with_suffix(".json"))
    write_segments(truth, tmp_path / "truth.json")
    written = json.loads((tmp_path / "truth.json").read_text(encoding="utf-8"))
    jsonschema.validate(written, schema)
    del written["segments"][0]["stop_frame"]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(written, schema)


@pytest.mark.parametrize(
    ("title", "presets"), [("Values", [KINEME]), ("Constants", [VOEGELE2014, KRUEGER2017])]
)
def test_constants_in_the_docs_are_those_of_the_presets(title: str, presets: list[Preset]) -> None:
    method = (ROOT / "docs" / "method.md").read_text(encoding="utf-8")
    chapter = method.partition(f"### {title}\n")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| `(\w+)` \| (.+) \|$", chapter, flags=re.MULTILINE)
    written = {name: cells.split(" | ")[: len(presets)] for name, cells in rows}
    names = {field.name for field in fields(presets[0])} - {"name"}
    assert written == {name: [shown(getattr(p, name)) for p in presets] for name in names}


def shown(value: Any) -> str:
    """A constant as the table in the docs has it."""
    match value:
        case None | bool():
            return {None: "–", True: "yes", False: "no"}[value]
        case float():
            return f"{value:.4g}"
        case ((_, _), *_):
            return " ".join(map(str, value))
        case tuple():
            return ", ".join(map(shown, value))
    return str(value)


def test_set_up_commands_are_the_first_of_the_readme() -> None:
    """``.ci/run`` takes these two lines from the README."""
    lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    commands = [line for line in lines if line.startswith("python3 -m venv ")]
    assert len(commands) == 2
    assert commands[0].endswith("kineme demo")
    assert commands[1].endswith("-m pytest -n 2")


def test_figures_say_what_measured_them() -> None:
    for name, figure in FIGURES.items():
        script = re.fullmatch(r"python benchmarks/(\w+)\.py.*", figure["command"])
        assert script, name
        assert (ROOT / "benchmarks" / f"{script[1]}.py").is_file()
        assert name.startswith(f"{script[1]}.")
        assert dt.date.fromisoformat(figure["date"])
        assert figure.keys() == {"value", "unit", "command", "version", "date"}


def test_a_benchmark_records_only_when_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "figures.json"
    monkeypatch.setattr(_figures, "FILE", file)
    monkeypatch.setattr(sys, "argv", ["benchmarks/noise.py", "--seeds", "3"])
    _figures.record("noise.counts", 91.0, unit="%")
    assert not file.exists()
    monkeypatch.setattr(sys, "argv", [*sys.argv, "--record"])
    _figures.record("noise.counts", 92.5, unit="%")
    _figures.record("noise.borders", "3 of 4")
    figures = json.loads(file.read_text(encoding="utf-8"))
    assert figures["noise.counts"]["command"] == "python benchmarks/noise.py --seeds 3"
    page = (
        "<!-- figure: noise.counts .0f -->91<!-- / -->, <!-- figure: noise.borders s -->?<!-- / -->"
    )
    shown = re.sub("<!--.*?-->", "", FILL["filled"](page, figures))
    assert shown == "92, 3 of 4"


@pytest.mark.parametrize("page", FILL["PAGES"], ids=lambda page: page.name)
def test_marked_figures_are_the_recorded_ones(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert FILL["filled"](text, FIGURES) == text, "run python docs/fill_figures.py"
    assert len(re.findall("<!-- figure:", text)) == len(FILL["MARK"].findall(text))
    assert not re.search("^ *<!-- figure:", text, flags=re.MULTILINE), "a mark begins a line"


def test_scores_in_the_readme_are_marked() -> None:
    """Those that the papers print are not ours to measure."""
    text = FILL["MARK"].sub("", (ROOT / "README.md").read_text(encoding="utf-8"))
    text = text.replace("the 2014 paper reports 0.898, 0.970", "")
    assert not re.findall(r"\d\.\d{3}", text)


def test_results_are_the_recorded_figures() -> None:
    """The page of results is made whole, by another command."""
    text = (ROOT / "docs" / "results.md").read_text(encoding="utf-8")
    means = text.partition("## Means over the trials")[2].partition("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in means.splitlines() if " | " in line]
    table = {row[0]: dict(zip(rows[0], row[1:])) for row in rows[1:]}
    for title, score in {
        "strict": "strict",
        "tolerant": "tolerant",
        "one to one": "one_to_one",
        "one to one, agreed": "one_to_one_agreed",
        "border F1": "border_f1",
        "covering": "covering",
    }.items():
        for method in ("kineme", "voegele2014", "krueger2017"):
            figure = FIGURES[f"fairness.subject_86.{method}.{score}"]
            assert table[title][method] == f"{figure['value']:.3f}"
