"""Every public name says by an example how it is used, and the examples run.

Public are the names that packages export and those that the page of the API
shows. Which they are, and what stands in their docstrings, is read by syntax
alone.
"""

from __future__ import annotations

import ast
import doctest
import importlib
import re
import warnings
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
from matplotlib import pyplot as plt

from kineme.errors import MissingDependencyError

SOURCES = Path(__file__).resolve().parents[1] / "src"
ROOT = SOURCES / "kineme"
API = SOURCES.parent / "docs" / "api.md"

NOT_DONE = {
    "methods": 9,
}
"""Rooms with public names that have no example yet, and how many; they may only become fewer."""

Definition = ast.FunctionDef | ast.ClassDef


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def path_of(module: str) -> Path:
    path = SOURCES.joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def definition(module: str, name: str) -> tuple[Path, Definition | None]:
    """Where a name is defined, through what modules import; None for constants and modules."""
    path = path_of(module)
    if not path.is_file():  # a method on the page
        return path, None
    stub = path.with_suffix(".pyi")
    for node in tree_of(stub if stub.is_file() else path).body:
        match node:
            case ast.FunctionDef() | ast.ClassDef() if node.name == name:
                return path, node
            case ast.ImportFrom(module=str() as home):
                home = f"{module}.{home}" if node.level else home
                if home.startswith("kineme.") and any(a.name == name for a in node.names):
                    return definition(home, name)
    return path, None


def public() -> set[tuple[str, str]]:
    """Modules and names: those on the page, in ``kineme``, and in ``__all__`` of its packages."""
    shown = re.findall(
        r"^::: (kineme[\w.]*)\.(\w+)$", API.read_text(encoding="utf-8"), re.MULTILINE
    )
    names = {(module, name) for module, name in shown if module != "kineme"} | {
        (f"kineme.{node.module}", alias.name)
        for node in tree_of(ROOT / "__init__.pyi").body
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
    }
    for path in sorted(ROOT.rglob("__init__.py")):
        module = ".".join(path.parent.relative_to(SOURCES).parts)
        for node in tree_of(path).body:
            match node:
                case ast.Assign(targets=[ast.Name(id="__all__")], value=ast.List(elts=elements)):
                    texts = [e.value for e in elements if isinstance(e, ast.Constant)]
                    names |= {(module, str(text)) for text in texts}
    return names


def room_of(path: Path) -> str:
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def without_example() -> set[tuple[str, str]]:
    found = {definition(*each) for each in public()}
    return {
        (room_of(path), node.name)
        for path, node in found
        if node is not None and ">>>" not in (ast.get_docstring(node) or "")
    }


def test_public_names_have_examples() -> None:
    missing = without_example()
    counts = Counter(room for room, _ in missing)
    more = {room for room in counts if counts[room] > NOT_DONE.get(room, 0)}
    assert not sorted(each for each in missing if each[0] in more)


MODULES = [
    ".".join(path.relative_to(SOURCES).with_suffix("").parts).removesuffix(".__init__")
    for path in sorted(ROOT.rglob("*.py"))
    if "pages" not in path.parts and ">>> " in path.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("module", MODULES)
def test_examples_run(module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    try:
        imported = importlib.import_module(module)
    except MissingDependencyError as error:
        pytest.skip(str(error))
    with warnings.catch_warnings():
        result = doctest.testmod(imported, optionflags=doctest.ELLIPSIS)
    plt.close("all")
    assert result.attempted
    assert not result.failed
