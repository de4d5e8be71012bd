"""Annotations: stored in files, kept by edits, and separate from provenance."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kineme.errors import ParameterError, ReadError
from kineme.labels import read_segments, write_segments
from kineme.segments import editing
from kineme.segments.annotation import Annotation
from kineme.segments.segmentation import Segmentation
from segmentations import LABELS, from_rows, segmentations

LEVELS = st.sampled_from(["activity", "primitive"])
SPANS = st.lists(st.tuples(LEVELS, st.integers(0, 60), st.integers(0, 60)), max_size=3).map(tuple)
ANNOTATIONS = st.builds(
    Annotation,
    SPANS,
    SPANS,
    st.lists(st.tuples(LEVELS, st.integers(0, 60), LABELS), max_size=3).map(tuple),
    st.dictionaries(st.integers(0, 5), LABELS, max_size=3),
    st.integers(0, 9),
    st.lists(st.integers(0, 60), max_size=3).map(tuple),
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("annotated")


def walk() -> Segmentation:
    rows = [
        ("activity", "activity", 0, 60, 0, ""),
        ("activity", "transition", 60, 90, -1, ""),
        ("primitive", "primitive", 0, 30, 0, ""),
        ("primitive", "primitive", 30, 60, 0, ""),
        ("primitive", "transition", 60, 90, -1, ""),
    ]
    return from_rows(rows, provenance={"notes": ["a"]})


@pytest.mark.parametrize("suffix", [".csv", ".json", ".parquet"])
@given(segmentations(), ANNOTATIONS)
def test_files_keep_segments_and_annotation(folder: Path, suffix: str, table, annotation) -> None:
    path = folder / f"table{suffix}"
    annotated = replace(table, annotation=annotation)
    write_segments(annotated, path)
    assert read_segments(path) == annotated


def test_edits_leave_the_provenance_and_keep_the_annotation() -> None:
    edited = editing.check(walk(), "primitive", [0], True)
    edited = editing.comment(edited, "activity", 0, "slips")
    edited = editing.name_cluster(edited, 0, "walk")
    expected = Annotation(
        checked=(("primitive", 0, 30),),
        comments=(("activity", 30, "slips"),),
        cluster_names={0: "walk"},
    )
    assert edited.annotation == expected
    for changed in (
        editing.split(edited, "primitive", 40),
        editing.set_kind(edited, "primitive", 30, "transition"),
        editing.set_cluster(edited, "primitive", 30, 1),
    ):
        assert changed.annotation.checked == expected.checked
        assert changed.annotation.comments == expected.comments
        assert changed.annotation.cluster_names[0] == "walk"
        assert changed.provenance == walk().provenance
    assert edited != walk()


@pytest.mark.parametrize(
    "said",
    [
        3,
        {"checked": 5},
        {"checked": [["floor", 0, 1]]},
        {"by_hand": [["activity", 0]]},
        {"comments": [["activity", 0, 1]]},
        {"cluster_names": {"0": []}},
        {"cluster_names": {"walk": "walk"}},
        {"corrections": "many"},
        {"excluded": [[3, 4]]},
    ],
    ids=str,
)
def test_one_of_another_shape_is_refused(tmp_path: Path, said: object) -> None:
    write_segments(walk(), tmp_path / "walk.json")
    told = json.loads((tmp_path / "walk.json").read_text()) | {"annotation": said}
    (tmp_path / "walk.json").write_text(json.dumps(told))
    with pytest.raises(ReadError, match="the annotation is not as kineme writes it"):
        read_segments(tmp_path / "walk.json")
    with pytest.raises(ParameterError, match="annotation"):
        Annotation.from_json(said)


def test_what_is_left_out_of_means_stays_left_out_whatever_becomes_of_its_borders() -> None:
    without = editing.exclude(walk(), [30], True)
    assert without.annotation.excluded == (45,)
    assert without.annotation.corrections == 0
    assert editing.exclude(without, [30], True) == without
    for changed in (
        editing.move_border(without, "primitive", 30, 38),
        editing.merge(without, "primitive", 0, 60),
        editing.set_cluster(without, "primitive", 30, 1),
        editing.carry_corrections(without, walk()).segmentation,
    ):
        assert changed.annotation.excluded == (45,)
    merged = editing.merge(without, "primitive", 0, 60)
    assert editing.exclude(merged, [0], False).annotation.excluded == ()
    assert editing.exclude(without, [30], False) == walk()
    with pytest.raises(ParameterError, match="no segment of level 'primitive' starts at frame 31"):
        editing.exclude(walk(), [31], True)
