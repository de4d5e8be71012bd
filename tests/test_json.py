"""Damaged JSON beside recordings: whatever it holds, what comes out is sound, or one sentence."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest
from msgspec import Struct

import kineme
from kineme._util.json import DEEPEST, decode_json, load_json
from kineme.datasets import bundled_truth
from kineme.errors import ReadError
from kineme.labels.collections import find_labels
from kineme.synthesis import MotionGraph
from kineme.synthesis.graph import load_sources, read_graph, write_graph

DEEP = "[" * 100_000 + "]" * 100_000


class Offset(Struct):
    offset_s: float


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"offset_s": 1', "is not valid JSON"),
        (DEEP, f"more than {DEEPEST}"),
        ("[" * (DEEPEST + 1) + "]" * (DEEPEST + 1), f"more than {DEEPEST}"),
        ('{"offset_s": 1e999}', "a number that is not finite or is too large"),
        ('{"offset_s": NaN}', "a number that is not finite or is too large"),
        (
            '{"other": [1' + "0" * 400 + '], "offset_s": 1}',
            "a number that is not finite or is too large",
        ),
        ("9" * 5000, "is not valid JSON"),
        ('{"offset_s": "late"}', "offset_s: expected float, got str"),
        ('{"offset_s": [1]}', "offset_s: expected float, got array"),
        ("{}", "missing required field offset_s"),
        ("null", "expected object, got null"),
        ('{"\\ud800": 1, "offset_s": 1}', "a name is not text"),
    ],
)
def test_what_is_no_such_thing_is_one_sentence(text: str, said: str) -> None:
    with pytest.raises(ReadError, match=said) as caught:
        decode_json(text, "walk.bvh.video.json", Offset)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 200


def test_what_is_sound_comes_out_with_what_is_not_known_left_out() -> None:
    assert decode_json('{"offset_s": 2, "new": {"a": []}}', "a.json", Offset) == Offset(2.0)
    deepest = "[" * DEEPEST + "]" * DEEPEST
    assert json.dumps(decode_json(deepest, "a.json")) == deepest


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with names")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "labels.json")
    with pytest.raises(ReadError, match="is a pipe"):
        load_json(tmp_path / "labels.json")


PROVENANCES: list[dict[str, Any]] = [
    {"input": 3},
    {"input": ["x"]},
    {"input": {"path": 5}},
    {"notes": {"a": 1}},
    {"labels": {"counts": 3}},
    {"gaps": [[1]]},
]


@pytest.mark.parametrize("provenance", PROVENANCES, ids=str)
def test_a_provenance_of_another_shape_is_refused_where_it_comes_in(
    tmp_path: Path, provenance: dict[str, Any]
) -> None:
    told = json.loads(bundled_truth().read_text())
    told["provenance"] |= provenance
    (tmp_path / "a.json").write_text(json.dumps(told))
    (name,) = provenance
    with pytest.raises(
        ReadError, match=f"(provenance|annotation) is not as kineme writes it: {name}"
    ):
        kineme.read_segments(tmp_path / "a.json")


def test_times_beyond_all_measure_are_cut_off(tmp_path: Path) -> None:
    table = tmp_path / "labels.csv"
    table.write_text("recording,start_s,stop_s,label\na.bvh,0,1e308,walk\na.bvh,-1e308,1,x\n")
    (source,) = find_labels([Path("a.bvh")], table).values()
    found = source.of(n_frames=90, fps=60.0)
    assert found.activities.label.tolist() == ["x", "walk"]
    assert found.activities.start_frame.tolist() == [0, 60]
    assert any("starting before the recording" in note for note in found.provenance["notes"])
    table.write_text("recording,start_s,stop_s,label\na.bvh,0,1e308,walk\na.bvh,2e307,1e308,x\n")
    (source,) = find_labels([Path("a.bvh")], table).values()
    assert source.of(n_frames=90, fps=60.0).activities.label.tolist() == ["walk"]


@pytest.mark.parametrize("name", ["x" * 300 + ".bvh", "a\0b.bvh"])
def test_a_graph_of_recordings_that_no_file_is_called_after(tmp_path: Path, name: str) -> None:
    path = tmp_path / "graph.json"
    write_graph(MotionGraph((), (), (), 60.0, 0.1, 0.3), path)
    told = json.loads(path.read_text())
    told["sources"] = [{"path": name, "sha256": "0", "n_frames": 9, "options": {}}]
    path.write_text(json.dumps(told))
    with pytest.raises(ReadError):
        load_sources(read_graph(path))
