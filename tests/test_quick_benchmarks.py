"""Benchmarks are tried in small by one command, which sees those that fail, lack or forget it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).resolve().parents[1] / "benchmarks"
KNOWS = f"import sys; sys.path.insert(0, {str(BENCHMARKS)!r})\nfrom _options import command_line"
FORMS = {
    "works": f"{KNOWS}, few\ncommand_line('Works.').parse_args()\nsys.exit(few(1, 0))",
    "fails": f"{KNOWS}\ncommand_line('Fails.').parse_args()\nprint(analyze)",
    "lacks": f"{KNOWS}, needed\ncommand_line('Lacks.').parse_args()\nneeded('no_such_set')",
    "forgets": "print('an hour of work')",
}


def quick(folder: Path, *names: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, BENCHMARKS / "quick.py", "--folder", folder, *names]
    return subprocess.run(command, capture_output=True, text=True)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in FORMS.items():
        (tmp_path / f"{name}.py").write_text(text)
    (tmp_path / "_shared.py").write_text("raise SystemExit(1)")
    return tmp_path


def test_one_that_works_and_one_that_lacks_recordings_are_fine(folder: Path) -> None:
    done = quick(folder, "works", "lacks")
    assert done.returncode == 0, done.stdout
    assert "skipped  skipped: no no_such_set among the recordings" in done.stdout


@pytest.mark.parametrize(
    ("name", "said"), [("fails", "NameError: name 'analyze'"), ("forgets", "has no --quick")]
)
def test_one_that_fails_or_has_no_quick_form_is_told(folder: Path, name: str, said: str) -> None:
    done = quick(folder, "works", name)
    assert done.returncode == 1
    assert said in done.stdout
    assert f"wrong: ['{name}']" in done.stdout


def test_every_benchmark_is_among_those_that_are_tried(folder: Path) -> None:
    told = quick(folder).stdout
    assert all(f"\n{name} " in f"\n{told}" for name in FORMS)
    assert "_shared" not in told


def test_figures_of_a_quick_run_are_not_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import _figures

    monkeypatch.setattr(_figures, "FILE", tmp_path / "figures.json")
    monkeypatch.setattr(sys, "argv", ["benchmarks/noise.py", "--quick", "--record"])
    _figures.record("noise.counts", 91.0)
    assert not (tmp_path / "figures.json").exists()


def test_growth_measures_every_method_and_size() -> None:
    """It had crashed for long before anybody saw, as nothing ran it."""
    command = [sys.executable, BENCHMARKS / "growth.py", "--quick", "--presets", "voegele2014"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 77:
        pytest.skip(done.stderr.strip())
    assert done.returncode == 0, done.stderr
    assert "voegele2014, max_lag, 0.04 h" in done.stdout
    assert "times 0.01 h" in done.stdout
