"""Labels of many recordings: at which rate they are, and which of two that overlap holds."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import kineme
from growth import LINEAR, times_longer
from kineme._util.checks import format_count
from kineme.errors import ReadError
from kineme.labels.collections import convert_to_frames, labels_of
from kineme.labels.spans import Labels, Span
from kineme.segments.segmentation import Segmentation


def test_a_table_at_another_rate_is_refused(tmp_path: Path) -> None:
    columns = {"level": ["activity"], "kind": ["activity"], "start_frame": [0], "stop_frame": [90]}
    table = Segmentation.from_columns(columns, n_frames=90, fps=50)
    kineme.write_segments(table, tmp_path / "walk.json")
    (source,) = labels_of([Path("walk.bvh")], tmp_path).values()
    assert source.of(n_frames=90, fps=50.001) == table
    with pytest.raises(ReadError, match="is of 50 frames per second, but the recording has 25"):
        source.of(n_frames=90, fps=25)


@st.composite
def labels(draw: st.DrawFn) -> Labels:
    spans = st.builds(
        lambda start, length, text, level: Span(start, start + length, text, level),
        *(st.integers(0, 20), st.integers(0, 9), st.sampled_from("abc")),
        st.sampled_from(["activity", "primitive"]),
    )
    return Labels(draw(st.lists(spans, max_size=12)), "frames")


@given(labels())
def test_a_frame_has_the_last_of_the_labels_that_cover_it(given_labels: Labels) -> None:
    found = convert_to_frames(given_labels, 10, n_frames=25)
    for level in ("activity", "primitive"):
        mine, theirs = (
            [
                next((s.text for s in spans if s.level == level and s.start <= i < s.stop), "")
                for i in range(25)
            ]
            for spans in (found.spans, list(reversed(given_labels.spans)))
        )
        assert mine == theirs
        rows = sorted(span[:2] for span in found.spans if span.level == level)
        assert all(a[1] <= b[0] for a, b in pairwise(rows))
    overlapping = sum(
        any(old.level == new.level and old.start < new.stop and new.start < old.stop
            for old in given_labels.spans[:i] if old.start < min(old.stop, 25))
        for i, new in enumerate(given_labels.spans) if new.start < min(new.stop, 25)
    )  # fmt: skip
    assert [note for note in found.notes if note.startswith("overlapping")] == (
        [f"overlapping others: {format_count(overlapping, 'label')}"] if overlapping else []
    )


def test_labels_by_the_ten_thousands_are_laid_out_in_no_time() -> None:
    def laid_out(n: int) -> None:
        many = Labels([Span(i / 2, i / 2 + 3, "a") for i in range(n)], "frames")
        assert len(convert_to_frames(many, 10, n_frames=n).spans) == n // 2 + 1

    assert times_longer(laid_out, 40_000) < LINEAR


def test_a_count_is_of_a_label_that_is_in_one_part() -> None:
    spans = [
        Span(0, 9, "walk", repetitions=8),
        Span(4, 6, "wave", repetitions=2),
        Span(8, 12, "run"),
    ]
    found = convert_to_frames(Labels(spans, "frames"), 10, n_frames=12).spans
    assert [(s.text, s.start, s.stop, s.repetitions) for s in found] == [
        *(("walk", 0, 4, None), ("walk", 6, 8, None), ("wave", 4, 6, 2), ("run", 8, 12, None)),
    ]
