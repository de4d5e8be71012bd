"""Agreement of several people: kappas as published and as in other libraries."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.metrics import cohen_kappa_score

from kineme.errors import ParameterError
from kineme.evaluation.annotators import (
    Extent,
    annotator_agreement,
    fleiss_kappa,
    gather_labels,
)
from kineme.evaluation.comparison import find_runs
from kineme.labels.collections import find_labels
from kineme.labels.spans import Labels, Span, as_segmentation
from kineme.segments.segmentation import Segmentation

PATIENTS = (
    "00060 03003 01401 00006 03030 20400 00402 20310 20040 00006 10050 11040 03300 10050 02031 "
    "00501 30012 51000 02040 10203 00006 01050 02013 20040 10041 05010 40002 02040 10500 00006"
)
"""Fleiss 1971, table 1: thirty patients, six psychiatrists, five diagnoses."""
SUBJECTS = (
    (0, 0, 0, 0, 14), (0, 2, 6, 4, 2), (0, 0, 3, 5, 6), (0, 3, 9, 2, 0), (2, 2, 8, 1, 1),
    (7, 7, 0, 0, 0), (3, 2, 6, 3, 0), (2, 5, 3, 2, 2), (6, 5, 2, 1, 0), (0, 2, 2, 3, 7),
)  # fmt: skip
"""Ten subjects, fourteen people, five classes: the example in most textbooks."""
WORDS = ("walk", "run", "jump")


def said(names: list[str], fps: float = 10) -> Segmentation:
    """Make the labels of a person, one per frame; empty for no label."""
    numbers = {name: number for number, name in enumerate(dict.fromkeys(names))}
    spans = [
        Span(run.start, run.stop, names[run.start])
        for run in find_runs([numbers[name] for name in names])
        if names[run.start]
    ]
    labels = Labels(spans, "frames", fps, len(names))
    return as_segmentation(labels, Path("labels.csv"), "csv", fps=fps)[0]


def labels_of_frames(draw) -> list[list[str]]:
    """Draw labels of some people for the same frames, at least one of them labelled."""
    length = draw(st.integers(2, 30))
    people = draw(st.integers(2, 4))
    frames = st.lists(st.sampled_from([*WORDS, ""]), min_size=length, max_size=length)
    return [["walk", *draw(frames)] for _ in range(people)]


def test_fleiss_kappa_is_the_published_one() -> None:
    counts = [list(map(int, row)) for row in PATIENTS.split()]
    assert fleiss_kappa(counts) == pytest.approx(0.430, abs=5e-4)
    assert fleiss_kappa(SUBJECTS) == pytest.approx(0.210, abs=5e-4)


def test_fleiss_kappa_of_nothing_and_of_one_class() -> None:
    assert math.isnan(fleiss_kappa(np.zeros((0, 3))))
    assert fleiss_kappa([[2, 0], [2, 0]]) == 1.0
    for counts in ([[1, 0], [1, 0]], [[2, 0], [3, 0]], [2, 2]):
        with pytest.raises(ParameterError):
            fleiss_kappa(counts)


@given(people=st.composite(labels_of_frames)())
def test_kappas_by_names_are_those_of_the_frames(people: list[list[str]]) -> None:
    sides = {f"{i}": said(names) for i, names in enumerate(people)}
    found = annotator_agreement({"take": sides})
    assert found.by == "names"
    for pair in found.pairs:
        first, second = people[int(pair.first)], people[int(pair.second)]
        if len({*first, *second}) > 1:  # else the other program divides by 0
            assert pair.cohen_kappa == pytest.approx(cohen_kappa_score(first, second), abs=1e-9)
    counts = [[frame.count(word) for word in (*WORDS, "")] for frame in zip(*people, strict=True)]
    assert found.fleiss_kappa == pytest.approx(fleiss_kappa(counts), abs=1e-9)


def test_people_agree_with_themselves_and_differ_where_they_do() -> None:
    anna = ["walk"] * 20 + [""] * 5 + ["run"] * 20
    ben = ["Walk"] * 20 + [""] * 5 + ["run"] * 10 + ["jump"] * 10
    same = annotator_agreement({"take": {"Anna": said(anna), "Bea": said(anna)}})
    kappas = [same.fleiss_kappa, same.pairs[0].cohen_kappa, same.pairs[0].border_f1]
    assert kappas == pytest.approx([1, 1, 1])
    assert same.recordings[0].differences == ()
    found = annotator_agreement({"take": {"Anna": said(anna), "Ben": said(ben)}})
    assert found.recordings[0].differences == ((3.5, 4.5, ("run", "jump")),)
    assert 0 < found.pairs[0].border_f1 < 1


def test_other_words_for_the_same_are_mapped() -> None:
    anna = ["walk"] * 20 + ["run"] * 20 + ["walk"] * 10
    ben = ["gehen"] * 20 + ["laufen"] * 20 + ["gehen"] * 10
    found = annotator_agreement({"take": {"Anna": said(anna), "Ben": said(ben)}})
    assert found.by == "mapping"
    assert [found.fleiss_kappa, found.pairs[0].cohen_kappa] == pytest.approx([1, 1])


def test_each_counts_where_they_labelled() -> None:
    names = ["walk"] * 20 + ["run"] * 20
    turned = ["run"] * 20 + ["walk"] * 20
    found = annotator_agreement(
        {
            "one": {"Anna": said(names), "Ben": said(names), "Cleo": said(names)},
            "two": {"Anna": said(names), "Ben": said(turned)},
            "three": {"Anna": said(names)},
        }
    )
    assert [pair.recordings for pair in found.pairs] == [2, 1, 1]
    assert found.fleiss_kappa == 1.0  # all three labelled the first alone
    assert found.pairs[0].cohen_kappa == pytest.approx(0)
    assert [one.recording for one in found.recordings] == ["one", "two"]
    with pytest.raises(ParameterError, match="two people"):
        annotator_agreement({"three": {"Anna": said(names)}})


def test_files_that_say_nothing_are_named_and_the_others_count(tmp_path: Path) -> None:
    paths = [tmp_path / f"{name}.bvh" for name in ("a", "b")]
    for who, texts in {"anna": ("walk", "walk"), "ben": ("walk", "transition")}.items():
        (tmp_path / who).mkdir()
        for path, text in zip(paths, texts, strict=True):
            table = f"start_s,stop_s,label\n0,1,{text}\n"
            (tmp_path / who / f"{path.stem}.csv").write_text(table)
    sources = {who: find_labels(paths, tmp_path / who) for who in ("anna", "ben")}
    labelled, failures = gather_labels(sources, lambda _: Extent(30, 30))
    assert {name: list(sides) for name, sides in labelled.items()} == {
        "a.bvh": ["anna", "ben"],
        "b.bvh": ["anna"],
    }
    assert len(failures) == 1
    assert failures[0].startswith("b.bvh, ben: ")
