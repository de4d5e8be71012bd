"""Check that folders of the package import each other in one direction only.

`ROOMS` is the plan: each folder (room), what it provides, and which others it may import.
``python tests/test_architecture.py`` writes it into ``docs/architecture.md``.
"""

from __future__ import annotations

import ast
import re
from graphlib import TopologicalSorter
from pathlib import Path
from typing import NamedTuple

import pytest

import kineme

ROOT = Path(kineme.__file__).parent
PAGE = Path(__file__).parents[1] / "docs" / "architecture.md"
MODULES = {
    ".".join(("kineme", *path.relative_to(ROOT).with_suffix("").parts)).removesuffix(
        ".__init__"
    ): path
    for path in sorted(ROOT.rglob("*.py"))
    if "pages" not in path.relative_to(ROOT).parts  # sources of the pages, with a script
}


class Room(NamedTuple):
    """A folder of the package, or a file beside them."""

    gives: str
    imports: str


# In order of dependency: no room imports one that is listed below it.
ROOMS = {
    "errors": Room("all exceptions and warnings", ""),
    "recordings": Room(
        "`Motion` and `Signals` with one protocol; kinematics; operations on motions", "errors"
    ),
    "segments": Room(
        "the segment table, `Segmentation`, its editing and history",
        "recordings",
    ),
    "features": Room(
        "arrays from recordings: poses in the body's own frame, rotations, distances of points, "
        "stacking, mirroring, bundling, envelopes of muscles; features for matching people",
        "recordings",
    ),
    "formats": Room(
        "reading and writing recordings: one registry, one `read`", "features recordings"
    ),
    "pose": Room(
        "poses of people in videos: estimators, and videos as recordings", "formats recordings"
    ),
    "transfer": Room(
        "`KnowledgeBase`; labels and cluster numbers for other recordings",
        "features formats recordings segments",
    ),
    "methods": Room(
        "`segment()` and `Segmenter`: recording → features → method → `Segmentation`; presets and "
        "their methods: `kineme`, `region_growing`",
        "features recordings segments transfer",
    ),
    "live": Room(
        "`Stream`: segmentation during recording; journals and sources of rows",
        "methods recordings segments transfer",
    ),
    "labels": Room(
        "reading and writing segment tables: one registry", "formats recordings segments"
    ),
    "cycles": Room(
        "`cycles()`: measures of repetitions, mean curves, foot contacts",
        "features labels recordings segments",
    ),
    "interop": Room(
        "segments and recordings as objects of other libraries",
        "formats labels methods recordings segments",
    ),
    "synthesis": Room(
        "`MotionGraph`, routes through it, new motion",
        "features formats methods recordings segments transfer",
    ),
    "plot": Room("plots on given axes", "cycles features recordings segments synthesis"),
    "clips": Room(
        "a file per segment, ranked loops; manifests, contact sheets, motion matching",
        "cycles features formats labels plot recordings segments",
    ),
    "library": Room(
        "collections of recordings with common clusters; search by example",
        "clips features formats labels methods plot recordings segments transfer",
    ),
    "datasets": Room("recordings with known truth, also bundled", "recordings segments"),
    "evaluation": Room(
        "scores of results against truth, and of methods over a folder",
        "formats labels methods recordings segments transfer",
    ),
    "web": Room(
        "sources of the pages, the built pages, and their data",
        "cycles features formats labels recordings segments",
    ),
    "report": Room(
        "an HTML page that shows a recording or compares two sessions",
        "cycles features plot recordings segments web",
    ),
    "studio": Room(
        "a local server and its page to view recordings and correct tables",
        "clips datasets evaluation formats labels library methods pose recordings report "
        "segments transfer web",
    ),
    "cli": Room("commands, imported when used", "*"),
}
UTIL = {"_util", "_version"}
"""Modules that any room may import; `_util` itself imports errors only."""
KNOW_RECORDINGS = {"prepare", "segmenter", "estimator"}
"""Modules of `methods` that take recordings; the others take arrays. Bundling takes any curve."""
ON_ARRAYS = ("kineme.features.bundling", "kineme.features.channels")


class Imports(ast.NodeVisitor):
    """Modules of the package that a module imports anywhere, be it for its type checker only."""

    def __init__(self) -> None:
        self.found: set[str] = set()

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


def allowed(name: str) -> set[str]:
    """Rooms that one may import besides itself and the helpers."""
    words = ROOMS[name].imports.split()
    if words == ["*"]:
        return set(ROOMS)
    return {"errors", *(word.split(".")[0] for word in words)}


def table() -> str:
    """The plan as the page has it."""
    lines = ["| folder | provides | imports |", "|---|---|---|"]
    for name, (gives, imports) in ROOMS.items():
        shown = {"": "–", "*": "everything; nobody imports it"}.get(imports)
        names = ", ".join(f"`{word}`" for word in imports.split())
        lines.append(f"| `{name}` | {gives} | {shown or names} |")
    return "\n".join(lines)


def test_every_room_is_in_the_plan() -> None:
    found = {room(module) for module in MODULES} - {"__init__", "__main__"}
    assert found == ROOMS.keys() | UTIL


@pytest.mark.parametrize("name", ROOMS)
def test_a_room_imports_only_what_the_plan_says(name: str) -> None:
    wrong = {
        (module, target)
        for module in MODULES
        if room(module) == name
        for target in IMPORTS[module]
        if room(target) not in allowed(name) | {name} | UTIL
    }
    assert not wrong


@pytest.mark.parametrize("name", ROOMS)
def test_what_the_plan_says_is_so(name: str) -> None:
    used = {room(t) for m in MODULES if room(m) == name for t in IMPORTS[m]} - {name}
    assert ROOMS[name].imports == "*" or not allowed(name) - used - {"errors"}


def test_arrows_point_up_the_plan() -> None:
    order = list(ROOMS)
    for name in order:
        if ROOMS[name].imports != "*":
            assert allowed(name) <= set(order[: order.index(name) + 1])


def test_helpers_stand_alone() -> None:
    found = {room(t) for m in MODULES if room(m) == "_util" for t in IMPORTS[m]}
    assert found <= {"_util", "errors"}


def test_methods_do_not_know_what_a_skeleton_is() -> None:
    wrong = {
        (module, target)
        for module in MODULES
        if room(module) == "methods" and module.rsplit(".", 1)[-1] not in KNOW_RECORDINGS
        for target in IMPORTS[module]
        if room(target) in {"recordings", "formats", "features"} and target not in ON_ARRAYS
    }
    assert not wrong
    for module in ON_ARRAYS:
        assert {room(target) for target in IMPORTS[module]} <= {"errors", "features", *UTIL}


def test_no_modules_import_each_other_in_a_circle() -> None:
    list(TopologicalSorter(IMPORTS).static_order())


def test_only_kernels_are_compiled() -> None:
    compiled = {
        module
        for module, path in MODULES.items()
        if re.search(r"from numba import|numba\.n?jit", path.read_text(encoding="utf-8"))
    }
    assert compiled
    assert all(module.rsplit(".", 1)[-1].endswith("_kernels") for module in compiled)


def filled(page: str) -> str:
    head, _, rest = page.partition("<!-- rooms -->")
    _, _, tail = rest.partition("<!-- /rooms -->")
    return f"{head}<!-- rooms -->\n\n{table()}\n\n<!-- /rooms -->{tail}"


def test_the_page_shows_the_plan() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page == filled(page), "run python tests/test_architecture.py"


if __name__ == "__main__":
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
