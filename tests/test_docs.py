"""The code in the README and the documentation runs as it stands there.

Each page is run from top to bottom in an empty folder that holds a copy of the
bundled recording as ``take.bvh``. Blocks marked ``python`` and ``bash`` are
run; what sets up an environment is marked ``sh`` and left to ``.ci/run``.
"""

from __future__ import annotations

import ast
import datetime as dt
import json
import re
import runpy
import subprocess
import sys
from collections.abc import Iterator
from contextlib import nullcontext
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import jsonschema
import pytest
import yaml
from matplotlib import pyplot as plt

import kineme
from kineme.datasets import bundled_recording
from kineme.labels import read_segments, write_segments
from ready_kineme import ready_kineme

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
NOTEBOOKS = sorted((ROOT / "docs").rglob("*.ipynb"))
RUN = runpy.run_path(str(ROOT / "docs" / "run_pages.py"))
FIGURES = json.loads((ROOT / "docs" / "figures.json").read_text(encoding="utf-8"))
FILL = runpy.run_path(str(ROOT / "docs" / "fill_pages.py"))
ALONE = f"""
import runpy, sys
from pathlib import Path

runpy.run_path({str(ROOT / "docs" / "run_pages.py")!r})["run_page"](*map(Path, sys.argv[1:]))
"""


@pytest.fixture(scope="module")
def programs() -> Iterator[Path]:
    """Where ``kineme`` is: where processes can be forked, one that starts at once."""
    with ready_kineme() if sys.platform == "linux" else nullcontext(RUN["SCRIPTS"]) as folder:
        yield folder


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_code_blocks_run(page: Path, tmp_path: Path, programs: Path) -> None:
    if page.stem == "extending":  # what it registers stays in the process
        subprocess.run([sys.executable, "-c", ALONE, page, tmp_path, programs], check=True)
    else:
        RUN["run_page"](page, tmp_path, programs)
    for name in RUN["pictures_of"](page):
        assert (tmp_path / name).is_file(), "the page shows a picture that it does not draw"
        assert (ROOT / "docs" / "images" / "made" / name).is_file(), "run python docs/run_pages.py"


@pytest.mark.slow
@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda notebook: notebook.stem)
def test_notebook_runs(notebook: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each cell, and what the notebook would show of its last line."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    namespace: dict[str, Any] = {}
    shown = 0
    for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] != "code":
            continue
        assert not cell["outputs"]
        assert cell["execution_count"] is None
        tree = ast.parse("".join(cell["source"]))
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, notebook.name, "exec"), namespace)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), notebook.name, "eval"), namespace)
            assert getattr(value, "_repr_html_", lambda: None)() or repr(value)
            shown += 1
    assert shown
    plt.close("all")


def test_json_schema_of_the_docs_is_that_of_the_files(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "segments.schema.json").read_text(encoding="utf-8")
    assert text == FILL["fill_schema"](), "run python docs/fill_pages.py"
    schema = json.loads(text)
    truth = read_segments(bundled_recording().with_suffix(".json"))
    write_segments(truth, tmp_path / "truth.json")
    written = json.loads((tmp_path / "truth.json").read_text(encoding="utf-8"))
    jsonschema.validate(written, schema)
    del written["segments"][0]["stop_frame"]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(written, schema)


def test_citation_has_the_form_of_its_format_and_the_version_of_the_package() -> None:
    """Check the fields that we use; the checker cffconvert wants an old jsonschema."""
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    schema = json.loads((ROOT / "tests" / "citation.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(citation, schema)
    assert citation["version"] == kineme.__version__


@pytest.mark.parametrize("page", FILL["FILLS"], ids=lambda page: page.stem)
def test_generated_tables_are_up_to_date(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    word = FILL["FILLS"][page][0]
    assert FILL["fill_page"](page) == text, "run python docs/fill_pages.py"
    assert f"<!-- {word}" in text


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_names_in_the_docs_exist(page: Path) -> None:
    groups = {
        f"kineme.{name}" for name in ("formats", "presets", "label_formats", "scores", "benchmarks")
    }
    for name in re.findall(r"`(kineme(?:\.\w+)+)`", page.read_text(encoding="utf-8")):
        if name not in groups and not name.startswith("kineme.interop."):  # some need more packages
            assert resolve_name(name) is not None


def test_both_methods_have_a_table_of_constants() -> None:
    text = (ROOT / "docs" / "parameters.md").read_text(encoding="utf-8")
    assert re.findall(r"<!-- constants: (\w+) -->", text) == ["kineme", "region_growing"]


def test_constants_on_the_page_of_the_method_are_those_of_the_preset() -> None:
    """And of the preset for sensors, where that stands in brackets."""
    text = (ROOT / "docs" / "method.md").read_text(encoding="utf-8")
    told = re.findall(r"`(\w+)`\s=\s([\d.]*\d)(?:\s\(([\d.]+)\))?", text)
    for name, bodies, sensors in told:
        for preset, value in (("kineme", bodies), ("sensors", sensors)):
            if value:
                shipped = getattr(kineme.PRESETS[preset], name)
                assert shipped in (float(value), (float(value),)), f"{name} of {preset}"
    assert len(told) > 30


def test_every_constant_of_the_published_methods_has_its_source() -> None:
    method = (ROOT / "docs" / "published.md").read_text(encoding="utf-8")
    chapter = method.partition("## Constants\n")[2].partition("\n## ")[0]
    for name in ("voegele2014", "krueger2017"):
        told = {known.name for known in kineme.PRESETS[name].constants()}
        assert set(re.findall(r"^\| `(\w+)` \|", chapter, flags=re.MULTILINE)) == told


def test_set_up_commands_are_the_first_of_the_readme() -> None:
    """``.ci/run`` takes these two lines from the README."""
    lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    commands = [line for line in lines if line.startswith("python3 -m venv ")]
    assert len(commands) == 2
    assert commands[0].endswith("kineme demo")
    assert commands[1].endswith("-m pytest -n 2")


def test_every_figure_of_the_results_is_recorded() -> None:
    tables = FILL["results_tables"](FIGURES)
    rows = [line for line in tables.splitlines() if line.startswith("| ")]
    assert len(rows) > 60
    assert not [row for row in rows if row.count(" – ") > 1]


def test_figures_say_what_measured_them() -> None:
    for name, figure in FIGURES.items():
        script = re.match(r"python -m benchmarks (\w+)", figure["command"])
        assert script, name
        assert list((ROOT / "benchmarks").glob(f"*/{script[1]}.py"))
        assert name.startswith(f"{script[1]}.")
        assert dt.date.fromisoformat(figure["date"])
        assert figure.keys() == {"value", "unit", "command", "version", "date"}


def test_results_are_the_recorded_figures() -> None:
    """The page of results is made whole, by another command."""
    text = (ROOT / "docs" / "results.md").read_text(encoding="utf-8")
    means = text.partition("## CMU subject 86")[2].partition("\n- ")[0]
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
