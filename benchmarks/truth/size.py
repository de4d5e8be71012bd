"""Measure the size and style of code and docs, and the depth of a call.

python -m benchmarks size
"""

from __future__ import annotations

import ast
import re
import sys
import tokenize
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import kineme
from _options import make_parser
from kineme.datasets import bundled_recording

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "kineme"
PAGES = SOURCE / "web" / "pages" / "src"
PREPOSITIONS = {
    "about", "above", "after", "among", "at", "before", "below", "beside", "between", "by", "for",
    "in", "into", "of", "on", "over", "per", "since", "under", "with", "within", "without",
}  # fmt: skip
IRREGULAR = {"found", "told", "made", "known", "shown", "given", "kept", "held", "drawn"}
DIRECTIVE = re.compile(r"#\s*(noqa|type:|fmt:)")
WANTED: dict[str, str] = {
    "Python lines": "48000",
    "Python files": "300",
    "Python code lines": "31000",
    "TypeScript and CSS lines": "14500",
    "test lines": "30000",
    "benchmark lines": "6000",
    "words of docs and README": "29000",
    "words of CHANGELOG": "500",
    "segment(motion): files entered": "25",
    "segment(motion): functions": "130",
    "segment(motion): depth": "12",
    "code lines per comment": "25",
    "docstrings that begin with The": "50",
    "functions named by a bare participle": "0",
    "functions that begin with a preposition, %": "3",
}


def main() -> None:
    make_parser(__doc__).parse_args()
    figures = {**count_sizes(), **measure_depth(), **measure_style()}
    print(f"{'':44}{'now':>10}{'wanted':>10}")
    for name, wanted in WANTED.items():
        print(f"{name:44}{figures[name]:10.5g}{wanted:>10}")


def count_sizes() -> dict[str, float]:
    """Count lines, files and words."""
    python = [*SOURCE.rglob("*.py")]
    docs = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    return {
        "Python lines": count_lines(python),
        "Python files": len(python),
        "Python code lines": sum(len(find_code_lines(path)) for path in python),
        "TypeScript and CSS lines": count_lines(
            path for path in PAGES.rglob("*") if path.suffix in (".ts", ".tsx", ".css")
        ),
        "test lines": count_lines((ROOT / "tests").rglob("*.py")),
        "benchmark lines": count_lines((ROOT / "benchmarks").rglob("*.py")),
        "words of docs and README": sum(len(path.read_text().split()) for path in docs),
        "words of CHANGELOG": len((ROOT / "CHANGELOG.md").read_text().split()),
    }


def count_lines(paths: Iterable[Path]) -> int:
    return sum(len(path.read_text(encoding="utf-8").splitlines()) for path in paths)


def find_code_lines(path: Path) -> set[int]:
    """Return the lines that hold code: neither blank, nor comment, nor docstring."""
    text = path.read_text(encoding="utf-8")
    docstrings = {line for doc in find_docstrings(ast.parse(text)) for line in list_lines(doc)}
    skipped = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
    with path.open("rb") as file:
        tokens = [
            token
            for token in tokenize.tokenize(file.readline)
            if token.type not in (*skipped, tokenize.ENCODING, tokenize.ENDMARKER)
        ]
    used = {line for token in tokens for line in range(token.start[0], token.end[0] + 1)}
    return used - docstrings


def find_docstrings(tree: ast.AST) -> Iterator[ast.Constant]:
    """Yield the docstrings of a module, also those of constants."""
    bodies = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    for node in ast.walk(tree):
        for statement in node.body if isinstance(node, bodies) else ():
            value = statement.value if isinstance(statement, ast.Expr) else None
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                yield value


def list_lines(node: Any) -> range:
    return range(node.lineno, node.end_lineno + 1)


def measure_style() -> dict[str, float]:
    """Count comments, docstrings and names of functions."""
    comments, code, begin_with_the = 0, 0, 0
    names: list[str] = []
    for path in SOURCE.rglob("*.py"):
        code += len(find_code_lines(path))
        with path.open("rb") as file:
            comments += sum(
                token.type == tokenize.COMMENT and not DIRECTIVE.match(token.string)
                for token in tokenize.tokenize(file.readline)
            )
        tree = ast.parse(path.read_text(encoding="utf-8"))
        begin_with_the += sum(str(doc.value).startswith("The ") for doc in find_docstrings(tree))
        functions = (node for node in tree.body if isinstance(node, ast.FunctionDef))
        names += [node.name.lstrip("_") for node in functions]
    prepositions = sum(name.partition("_")[0] in PREPOSITIONS for name in names)
    return {
        "code lines per comment": code / max(comments, 1),
        "docstrings that begin with The": begin_with_the,
        "functions named by a bare participle": sum(
            re.fullmatch(r"[a-z]+ed", name) is not None or name in IRREGULAR for name in names
        ),
        "functions that begin with a preposition, %": 100 * prepositions / len(names),
    }


def measure_depth() -> dict[str, float]:
    """Count files, functions and call depth of the second `kineme.segment` of a recording."""
    motion = kineme.read(bundled_recording())
    kineme.segment(motion)
    files: set[str] = set()
    functions: set[tuple[str, int]] = set()
    level = deepest = 0

    def follow(frame: FrameType, event: str, _: object) -> None:
        nonlocal level, deepest
        code = frame.f_code
        if not code.co_filename.startswith(str(SOURCE)) or code.co_name.startswith("<"):
            return
        if event == "call":
            level += 1
            deepest = max(deepest, level)
            files.add(code.co_filename)
            functions.add((code.co_filename, code.co_firstlineno))
        elif event == "return":
            level -= 1

    sys.setprofile(follow)
    kineme.segment(motion)
    sys.setprofile(None)
    return {
        "segment(motion): files entered": len(files),
        "segment(motion): functions": len(functions),
        "segment(motion): depth": deepest,
    }


if __name__ == "__main__":
    main()
