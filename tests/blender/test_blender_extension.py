"""Test what of the Blender extension is plain Python."""

from __future__ import annotations

import ast
import sys
import tomllib
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

import kineme
from kineme.datasets import bundled_truth
from kineme.labels.json_table import as_object

FOLDER = Path(__file__).resolve().parents[2] / "blender"
SOURCES = sorted(FOLDER.glob("*.py"))
FIRST = 11


def import_part(name: str) -> ModuleType:
    """A module of the extension, under a package that does not import bpy."""
    package = ModuleType("blender_extension")
    package.__path__ = [str(FOLDER)]
    sys.modules.setdefault("blender_extension", package)
    return import_module(f"blender_extension.{name}")


table, process = import_part("table"), import_part("process")


@pytest.fixture
def record() -> dict[str, Any]:
    found = kineme.read_segments(bundled_truth(), fps=60)
    record = {"first": FIRST, "level": "activity", "table": as_object(found)}
    for row in record["table"]["segments"]:
        row["label"] = ""
    return record | {"markers": table.markers_of(record, "activity")}


def run_task(task: dict[str, Any]) -> dict[str, Any]:
    steps = process.work([sys.executable], task)
    while True:
        try:
            next(steps)
        except StopIteration as done:
            return done.value


def test_a_segment_is_called_by_label_cluster_or_kind() -> None:
    row = {"label": " double \n step ", "cluster": 3, "kind": "primitive"}
    assert table.name_of(row) == "double step"
    assert table.name_of(row | {"label": " "}) == "cluster 3"
    assert table.name_of(row | {"label": "", "cluster": -1, "kind": "transition"}) == "transition"


def test_names_fit_into_blender_with_a_number_and_are_no_halves_of_letters() -> None:
    row = {"label": "é" * 80, "cluster": 0, "kind": "primitive"}
    (name, *_) = names = table.numbered([row] * 1000)
    assert len(set(names)) == 1000
    assert max(len(name.encode()) for name in names) <= 63
    assert name == "é" * 27 + " 0001"
    assert table.numbered([row | {"label": "kick"}]) == ["kick"]


def test_a_number_makes_no_name_that_another_has() -> None:
    labels = ["kick", "kick 01", "kick", "kick 01 01", "kick 01"]
    rows = [{"label": label, "cluster": 0, "kind": "primitive"} for label in labels]
    names = ["kick 02", "kick 01 02", "kick 03", "kick 01 01", "kick 01 03"]
    assert table.numbered(rows) == names


def test_frames_of_the_table_are_those_of_the_scene(record: dict[str, Any]) -> None:
    rows = table.rows_of(record, "primitive")
    spans = [table.frames_of(record, row) for row in rows]
    assert spans[0][0] == FIRST
    assert spans[-1][1] == FIRST + record["table"]["n_frames"] - 1
    assert all(before[1] + 1 == after[0] for before, after in pairwise(spans))
    for row, (first, last) in zip(rows, spans):
        assert table.row_at(record, "primitive", first) == row
        assert table.row_at(record, "primitive", last) == row
    assert table.row_at(record, "primitive", FIRST - 1) is None


def test_one_goes_from_start_to_start_and_stays_at_the_ends(record: dict[str, Any]) -> None:
    starts = [table.frames_of(record, row)[0] for row in table.rows_of(record, "activity")]
    frame, visited = FIRST - 5, []
    while (frame := table.neighbour(record, "activity", frame, 1)) is not None:
        visited.append(frame)
    assert visited == starts
    assert table.neighbour(record, "activity", starts[1] + 3, -1) == starts[1]
    assert table.neighbour(record, "activity", starts[1], -1) == starts[0]
    assert table.neighbour(record, "activity", starts[0], -1) is None


def test_transitions_become_no_clips(record: dict[str, Any]) -> None:
    kinds = {row["kind"] for _, row in table.clips_of(record, "primitive")}
    assert kinds == {"primitive"}


def test_markers_are_known_again_though_renamed_but_not_where_moved() -> None:
    former = [[1, "a"], [1, "b"], [9, "c"], [20, "d"]]
    markers = [table.Marker(*each) for each in [(9, "kick"), (1, "b"), (1, "mine"), (21, "d")]]
    found = [place for _, place in table.same_markers(former, markers)]
    assert found == [2, 1, 0, None]


def test_most_renamed_markers_name_their_cluster_and_the_others_themselves(
    record: dict[str, Any],
) -> None:
    rows = table.rows_of(record, "activity")
    cluster = next(c for c in (row["cluster"] for row in rows)
                   if [row["cluster"] for row in rows].count(c) > 1)  # fmt: skip
    members = [n for n, row in enumerate(rows) if row["cluster"] == cluster]
    markers = [table.Marker(*each) for each in record["markers"]]
    assert table.names_given(record, "activity", markers) == ({}, {})
    markers[members[0]] = markers[members[0]]._replace(name="stroll")
    assert table.names_given(record, "activity", markers) == ({cluster: "stroll"}, {})
    markers[members[1]] = markers[members[1]]._replace(name="limp")
    names, own = table.names_given(record, "activity", markers)
    assert (names, own) == ({cluster: "stroll"}, {rows[members[1]]["start_frame"]: "limp"})
    done = run_task({"task": "name", "table": record["table"], "level": "activity",
                   "clusters": names, "segments": own})  # fmt: skip
    labels = [row["label"] for row in table.rows_of(done, "activity")]
    assert [labels[n] for n in members[:2]] == ["stroll", "limp"]


def test_catalogues_are_added_once_and_keep_what_a_file_holds() -> None:
    others = "VERSION 1\n\n11111111-2222-3333-4444-555555555555:props:props"
    once = table.with_catalogues(others, ["walk", "a/b: c", "walk"])
    assert once.startswith(f"{others}\n")
    assert table.with_catalogues(once, ["walk"]) == once
    assert [line.split(":")[1] for line in once.splitlines()[3:]] == [
        "kineme/a-b- c",
        "kineme/walk",
    ]
    assert table.with_catalogues("", ["walk"]).startswith(table.CATALOGUES_HEAD)


def test_a_table_is_saved_in_any_format_and_a_wrong_suffix_is_said(
    record: dict[str, Any], tmp_path: Path
) -> None:
    task = {"task": "save", "table": record["table"]}
    assert run_task(task | {"path": str(tmp_path / "take.csv")}) == {}
    saved = kineme.read_segments(tmp_path / "take.csv")
    assert len(saved) == len(record["table"]["segments"])
    with pytest.raises(process.FailureError, match="xyz"):
        run_task(task | {"path": str(tmp_path / "take.xyz")})


def test_work_that_nobody_waits_for_leaves_no_process(
    monkeypatch: pytest.MonkeyPatch, record: dict[str, Any]
) -> None:
    begun = []
    start = process.subprocess.Popen

    def watched(*given: Any, **options: Any) -> Any:
        begun.append(start(*given, **options))
        return begun[-1]

    fake = SimpleNamespace(**vars(process.subprocess) | {"Popen": watched})
    monkeypatch.setattr(process, "subprocess", fake)
    steps = process.work([sys.executable], {"task": "save", "table": record["table"]})
    assert next(steps) == "starting"
    steps.close()
    assert begun[0].returncode is not None


def test_the_python_of_kineme_is_looked_for_and_missed_in_words(tmp_path: Path) -> None:
    assert process.python_of("") == [sys.executable]
    (tmp_path / "kineme").touch()
    with pytest.raises(process.FailureError, match="no Python lies beside"):
        process.python_of(str(tmp_path / "kineme"))
    (tmp_path / "kineme").write_text(f"#!{sys.executable}\nimport kineme\n")
    assert process.python_of(str(tmp_path / "kineme")) == [sys.executable]
    (tmp_path / "python3").touch()
    assert process.python_of(str(tmp_path / "kineme")) == [str(tmp_path / "python3")]
    with pytest.raises(process.FailureError, match="there is no program"):
        process.python_of(str(tmp_path / "nothing"))


def test_joints_are_named_as_on_the_command_line() -> None:
    worker = import_part("worker")
    assert worker.joints(" ") is None
    assert worker.joints("a, b,c ,d,e") == ["a", "b", "c", "d", "e"]
    assert worker.joints("head=Top, left_wrist=L") == {"head": "Top", "left_wrist": "L"}


def test_the_extension_has_the_version_of_the_package() -> None:
    manifest = tomllib.loads((FOLDER / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert manifest["version"] == kineme.__version__


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_sources_are_for_the_python_of_blender_4_2(path: Path) -> None:
    ast.parse(path.read_text(encoding="utf-8"), feature_version=(3, 11))
