"""Arrows between the rooms of the package point one way; the way of the data is downhill."""

from __future__ import annotations

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import kineme

ROOT = Path(kineme.__file__).parent
MODULES = {
    ".".join(("kineme", *path.relative_to(ROOT).with_suffix("").parts)).removesuffix(
        ".__init__"
    ): path
    for path in sorted(ROOT.rglob("*.py"))
}

COMPILED = {"_compiled", "_rank_kernels"}
BASE = {"errors", "_version", "_threads", "_files", "_rotations", "_checks"} | COMPILED
MOTION = {"motion", "kinematics", "operations"}
# For each room of the way of the data, all that it may import besides itself.
DOWNHILL = {
    "errors": set(),
    "_checks": {"errors"},
    "_threads": set(),
    "_rank_kernels": {"_compiled"},
    "_files": {"errors"},
    "_rotations": set(),
    "motion": BASE | MOTION,
    "kinematics": BASE | MOTION,
    "operations": BASE | MOTION,
    "formats": BASE | MOTION,
    "features": BASE | MOTION,
    "graph": {"errors", "_checks", "_threads"} | COMPILED,
    "segmentation": BASE | MOTION | {"features", "graph"},
    "signals": BASE | {"motion", "features", "formats", "segmentation"},
}
# In segmentation only this module may know what a skeleton is.
FROM_MOTION = "kineme.segmentation.segmenter"
NO_BODIES = {"kineme.features.bundling"}  # takes any curve
FRONT = {"cli", "studio", "report"}


class Imports(ast.NodeVisitor):
    """Modules of the package that a module imports anywhere, but for its type checker."""

    def __init__(self) -> None:
        self.found: set[str] = set()

    def visit_If(self, node: ast.If) -> None:
        if "TYPE_CHECKING" not in ast.unparse(node.test):
            self.generic_visit(node)

    def visit_Import(self, node: ast.Import) -> None:
        self.found |= {alias.name for alias in node.names if alias.name in MODULES}

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        home = node.module or ""
        if home in MODULES:
            names = {f"{home}.{alias.name}" for alias in node.names}
            self.found |= {name if name in MODULES else home for name in names}


def imports_of(module: str) -> set[str]:
    visitor = Imports()
    visitor.visit(ast.parse(MODULES[module].read_text(encoding="utf-8")))
    return visitor.found - {module}


IMPORTS = {module: imports_of(module) for module in MODULES}


def room(module: str) -> str:
    return module.split(".")[1] if "." in module else "__init__"


@pytest.mark.parametrize("name", DOWNHILL)
def test_a_room_imports_only_what_lies_above_it(name: str) -> None:
    own = [module for module in MODULES if room(module) == name]
    assert own, f"no room {name}: mend the list"
    wrong = {
        (module, target)
        for module in own
        for target in IMPORTS[module]
        if room(target) not in DOWNHILL[name] | {name}
    }
    assert not wrong


def test_nobody_imports_what_people_look_at() -> None:
    wrong = {
        (module, target)
        for module, targets in IMPORTS.items()
        for target in targets
        if room(target) in FRONT and room(module) not in FRONT | {"__main__"}
    }
    assert not wrong


def test_from_the_graph_on_nothing_knows_what_a_skeleton_is() -> None:
    rooms_of_bodies = MOTION | {"features", "formats", "_rotations"}
    wrong = {
        (module, target)
        for module in MODULES
        if room(module) in {"graph", "segmentation"} and module != FROM_MOTION
        for target in IMPORTS[module] - NO_BODIES
        if room(target) in rooms_of_bodies or target == FROM_MOTION
    }
    assert not wrong
    assert IMPORTS["kineme._checks"] == {"kineme.errors"}
    free = {"kineme.errors", "kineme._checks", "kineme._threads", "kineme.features._kernels"}
    for module in NO_BODIES:
        assert IMPORTS[module] <= free


def test_no_modules_import_each_other_in_a_circle() -> None:
    list(TopologicalSorter(IMPORTS).static_order())


def test_only_kernels_are_compiled() -> None:
    compiled = {
        module
        for module, path in MODULES.items()
        if "from numba" in path.read_text(encoding="utf-8")
        or "import numba" in path.read_text(encoding="utf-8")
    }
    assert compiled
    assert all(module.rsplit(".", 1)[-1].endswith("_kernels") for module in compiled)
