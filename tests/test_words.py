"""One word, one thing: names in the package are nouns of the field, as `docs/architecture.md` says.

What is read are names that a module defines (modules, classes, functions,
parameters, variables, attributes) and the docstrings and messages that people
see, by their syntax alone: nothing is imported.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1] / "src" / "kineme"

TABLE = {
    "footage": "recording",
    "moment": "frame, sample",
    "moments": "frames, samples",
    "alike": "similar",
    "likeness": "similarity",
    "nearness": "similarity, distance",
    "along": "path",
    "way": "path, candidate",
    "ways": "paths, candidates",
    "piece": "segment, span",
    "pieces": "segments, spans",
    "stretch": "segment, span",
    "stretches": "segments, spans",
    "marks": "annotation",
    "sure": "confidence",
    "sureness": "confidence",
    "judged": "truth",
    "door": "caller, reader",
}
"""Words of the table's last column, and the word for each.

Those with a meaning of their own in code, such as row, block and score, are left to the reader.
"""

NO_NOUNS = {
    *("known", "own", "seen", "said", "told", "looks", "doors", "whole"),
    *("ours", "theirs", "whose", "which", "went", "came", "gone", "crept", "laid", "begun"),
    *("finds", "glued", "held", "met", "spent", "taken", "then", "there", "todo", "wanted"),
}
"""Participles and pronouns that say nothing of what a name holds."""

IN_TEXTS = re.compile(
    r"\b(footage|moments?|likeness|nearness|sureness|search vectors?)\b", re.IGNORECASE
)
"""Words of the table that have no other meaning in a sentence of this package."""

ALLOWED = {
    "collect_usage_pieces": "a method of click, which the help overrides",
    "is_held": "a question, which a participle answers",
    "two_way_distance": "a public name; both directions are meant",
}

SURE = re.compile(r"(?:least|less|how|%) sure\b", re.IGNORECASE)
"""What the pages call by its name: confidence."""

ALLOWED_IN_PAGES = {"held"}
"""What the browser calls the locks of tabs."""


def defined(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Names that a module defines, with their lines."""
    for node in ast.walk(tree):
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                yield node.name, node.lineno
            case ast.arg():
                yield node.arg, node.lineno
            case ast.Name(ctx=ast.Store()):
                yield node.id, node.lineno
            case ast.Attribute(ctx=ast.Store()):
                yield node.attr, node.lineno
            case ast.alias(asname=str() as name):
                yield name, node.lineno


def words(name: str) -> set[str]:
    """Parts of a name, be it in snake case or in camel case."""
    return {word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)}


def offences_of(path: Path) -> set[str]:
    """What a module has that the table does not want, with one line of each."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = {}
    place = path.relative_to(ROOT).as_posix()
    for name, line in [(path.stem, 1), *defined(tree)]:
        if name not in ALLOWED and words(name) & (TABLE.keys() | NO_NOUNS):
            found.setdefault(name, f"{place}:{line}: {name}")
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and " " in str(node.value):
            for word in IN_TEXTS.findall(str(node.value)):
                found.setdefault(f"'{word}'", f"{place}:{node.lineno}: '{word}' in a text")
    return set(found.values())


@cache
def offences() -> dict[str, set[str]]:
    """Of every room; helpers beside the rooms count as one, named ``_``."""
    rooms: dict[str, set[str]] = {}
    for path in sorted(ROOT.rglob("*.py")):
        parts = path.relative_to(ROOT).parts
        if "pages" not in parts:
            room = parts[0] if len(parts) > 1 else "_"
            rooms.setdefault(room, set()).update(offences_of(path))
    return rooms


def offences_in_pages(path: Path) -> set[str]:
    """What a source of the pages defines, or has people read, that the table does not want."""
    code = re.sub(r"/\*.*?\*/|//[^\n]*", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
    names = re.findall(r"\b(?:const|let|function|class|interface|type|readonly) (\w+)", code)
    names += re.findall(r"(?:^|[(,{\s])(\w+)\??: ", code)
    found = {name for name in names if words(name) & (TABLE.keys() | NO_NOUNS)}
    texts = {*IN_TEXTS.findall(code), *SURE.findall(code)}
    return {f"{path.name}: {each}" for each in found - ALLOWED_IN_PAGES | texts}


def test_names_in_the_pages_are_nouns_of_the_field() -> None:
    sources = sorted((ROOT / "web" / "pages" / "src").rglob("*.ts*"))
    if not sources:
        pytest.skip("the sources of the pages are not in a wheel")
    found = set().union(*map(offences_in_pages, sources))
    assert not found, "\n".join(sorted(found))


@pytest.mark.parametrize(
    "room", sorted({path.name for path in ROOT.iterdir() if path.is_dir()} | {"_"})
)
def test_names_are_nouns_of_the_field(room: str) -> None:
    found = offences().get(room, set())
    assert not found, "\n".join(sorted(found))
