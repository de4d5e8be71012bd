"""Importing the package is cheap, and all it promises is there."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import kineme

HEAVY = {
    "matplotlib", "numba", "numpy", "pandas", "pyarrow", "rich", "scipy", "sklearn", "typer",
}  # fmt: skip


def loaded_by(statement: str) -> set[str]:
    """Top-level modules in a fresh process after a statement."""
    code = f"import sys\n{statement}\nprint(*{{name.split('.')[0] for name in sys.modules}})"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=True
    )
    return set(done.stdout.split())


def test_importing_loads_nothing_heavy() -> None:
    assert not loaded_by("import kineme") & HEAVY


def test_listing_names_loads_nothing_heavy() -> None:
    assert not loaded_by("import kineme; assert set(kineme.__all__) <= set(dir(kineme))") & HEAVY


def test_errors_and_the_table_need_no_compiler() -> None:
    statement = "import kineme; kineme.KinemeError, kineme.Segmentation, kineme.read"
    assert not loaded_by(statement) & {"numba", "matplotlib", "sklearn"}
    statement = "import kineme; kineme.read_signals, kineme.Signals, kineme.segment_signals"
    assert not loaded_by(statement) & {"numba", "matplotlib", "sklearn"}


@pytest.mark.parametrize("name", kineme.__all__)
def test_every_public_name_is_there(name: str) -> None:
    assert getattr(kineme, name) is not None


def test_the_names_for_type_checkers_are_those_of_the_package() -> None:
    tree = ast.parse(Path(kineme.__file__).read_text(encoding="utf-8"))
    (block,) = (node for node in tree.body if isinstance(node, ast.If))
    declared = {
        alias.asname or alias.name
        for statement in block.body
        if isinstance(statement, ast.ImportFrom)
        for alias in statement.names
    }
    assert declared | {"__version__"} == set(kineme.__all__)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'segmentt'"):
        _ = kineme.segmentt
