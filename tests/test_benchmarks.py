"""One door to all benchmarks: it lists them, tries them in small, compares what they measure."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

import _figures

ROOT = Path(__file__).resolve().parents[1]
BENCHMARKS = ROOT / "benchmarks"
SCRIPTS = sorted(BENCHMARKS.glob("*/[!_]*.py"))
KNOWS = "import sys\nfrom _options import command_line"
FORMS = {
    "works": f"{KNOWS}, few\ncommand_line('Works.').parse_args()\nsys.exit(few(1, 0))",
    "fails": f"{KNOWS}\ncommand_line('Fails.').parse_args()\nprint(analyze)",
    "lacks": f"{KNOWS}, needed\ncommand_line('Lacks.').parse_args()\nneeded('no_such_set')",
    "forgets": "print('an hour of work')",
}
DOOR = """
import sys
from pathlib import Path
from benchmarks.__main__ import main
sys.exit(main(sys.argv[2:], Path(sys.argv[1])))
"""


def door(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", DOOR, folder, *words]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "truth").mkdir()
    for name, text in FORMS.items():
        (tmp_path / "truth" / f"{name}.py").write_text(f'"""What {name}.\n\nMore."""\n{text}')
    (tmp_path / "truth" / "_shared.py").write_text("raise SystemExit(1)")
    return tmp_path


def test_all_are_listed_with_a_line_and_times(folder: Path) -> None:
    told = door(folder).stdout
    assert [line.split() for line in told.splitlines() if " What " in line] == [
        [name, "–", "–", "What", f"{name}."] for name in sorted(FORMS)
    ]


def test_every_benchmark_of_ours_is_listed_by_its_first_line() -> None:
    told = door(BENCHMARKS).stdout
    assert len(SCRIPTS) > 20
    for script in SCRIPTS:
        doc = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or ""
        if script.parent.name != "rivals":
            assert doc.partition("\n")[0] in told
    assert len({script.stem for script in SCRIPTS}) == len(SCRIPTS)


def test_one_that_works_and_one_that_lacks_recordings_are_fine(folder: Path) -> None:
    done = door(folder, "works,lacks", "--quick")
    assert done.returncode == 0, done.stdout
    assert "skipped  skipped: no no_such_set among the recordings" in done.stdout


@pytest.mark.parametrize(
    ("name", "said"), [("fails", "NameError: name 'analyze'"), ("forgets", "has no --quick")]
)
def test_one_that_fails_or_has_no_quick_form_is_told(folder: Path, name: str, said: str) -> None:
    done = door(folder, f"works,{name}", "--quick")
    assert done.returncode == 1
    assert said in done.stdout
    assert f"wrong: {name}\n" in done.stdout


@pytest.mark.parametrize("what", ["all", "truth"])
def test_a_folder_is_all_that_is_in_it(folder: Path, what: str) -> None:
    told = door(folder, what, "--quick").stdout
    assert all(f"\n{name}" in f"\n{told}" for name in FORMS)
    assert "_shared" not in told


def test_one_alone_shows_what_it_says_and_ends_as_it_does(folder: Path) -> None:
    done = door(folder, "forgets")
    assert (done.returncode, done.stdout) == (0, "an hour of work\n")
    assert door(folder, "lacks").returncode == 77
    assert "no benchmark or folder 'nothing'" in door(folder, "nothing").stderr


def test_figures_of_a_quick_run_are_not_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_figures, "FILE", tmp_path / "figures.json")
    monkeypatch.setattr(sys, "argv", ["benchmarks/truth/noise.py", "--quick", "--record"])
    _figures.record("noise.counts", 91.0)
    assert not (tmp_path / "figures.json").exists()


def test_figures_are_compared_with_those_recorded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = {
        name: {"value": 91.0, "command": "python -m benchmarks noise", "date": "2026-11-24"}
        for name in ("noise.counts", "noise.borders")
    }
    monkeypatch.setattr(_figures, "FILE", tmp_path / "figures.json")
    _figures.FILE.write_text(json.dumps(kept))
    monkeypatch.setattr(sys, "argv", ["benchmarks/truth/noise.py", "--seeds", "3"])
    assert _figures.compared({"noise.counts": 91.0, "noise.borders": 90, "noise.extra": 1}) == [
        "1 of 3 figures as recorded:",
        "  noise.borders: 90, 91.0 recorded 2026-11-24 by python -m benchmarks noise",
        "  noise.extra: 1, not recorded",
    ]


def test_growth_measures_every_method_and_size() -> None:
    """It had crashed for long before anybody saw, as nothing ran it."""
    done = door(BENCHMARKS, "growth", "--quick", "--presets", "voegele2014")
    if done.returncode == 77:
        pytest.skip(done.stderr.strip())
    assert done.returncode == 0, done.stderr
    assert "voegele2014, max_lag, 0.04 h" in done.stdout
    assert "times 0.01 h" in done.stdout
