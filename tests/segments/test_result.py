"""Segmentation: invariants, errors, and what notebooks show."""

from __future__ import annotations

from xml.etree import ElementTree as ET

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kineme.errors import ParameterError
from kineme.segments import display
from kineme.segments.editing.borders import replace_columns
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, SegmentTable
from segmentations import from_rows, make_activities, segmentations

WALK_JUMP = {
    "level": ["activity"] * 3 + ["primitive"] * 5,
    "kind": ["activity", "transition"] + ["activity"] * 3 + ["transition"] + ["activity"] * 2,
    "start_frame": [0, 40, 50, 0, 20, 40, 50, 70],
    "stop_frame": [40, 50, 90, 20, 40, 50, 70, 90],
    "cluster": [-1, -1, -1, 0, 0, -1, 1, 0],
}


def walk_jump(**changes: object) -> Segmentation:
    return Segmentation.from_columns({**WALK_JUMP, **changes}, n_frames=90, fps=30.0)  # type: ignore[dict-item]


def test_cuts_repetitions_and_frames() -> None:
    result = walk_jump()
    assert result.cuts().tolist() == [40, 50]
    assert result.cuts("primitive").tolist() == [20, 40, 50, 70]
    assert result.repetitions() == {0: 3, 1: 1}
    assert result.primitives.activity.tolist() == [0, 0, 1, 2, 2]
    assert result.per_frame("kind", level="activity").tolist() == (
        ["activity"] * 40 + ["transition"] * 10 + ["activity"] * 40
    )
    assert len(result) == len(list(result)) == 8
    assert "2 activities, 1 transition, 4 primitives, 2 clusters" in repr(result)
    assert repr(result.primitives) == "<SegmentTable of 5 segments, 0.00 to 3.00 s>"
    assert repr(result.table[:0]) == "<SegmentTable of 0 segments>"


def test_rows_are_picked_as_in_numpy() -> None:
    table = walk_jump().table
    repeated = table.cluster == 0
    for rows in (slice(0, 2), slice(None, None, -1), repeated, np.array([3, -1]), [3, 1], []):
        picked = table[rows]
        assert isinstance(picked, type(table))
        for name, column in table.columns().items():
            expected = column[rows if isinstance(rows, slice) or len(rows) else slice(0)]
            np.testing.assert_array_equal(getattr(picked, name), expected)
    assert [row.start_frame for row in table[repeated.tolist()]] == [0, 20, 70]
    assert table[np.int64(1)].kind == "transition"


def test_what_picks_no_rows_is_said() -> None:
    table = walk_jump().table
    for row in (8, -9, [0, 8]):
        with pytest.raises(IndexError, match="of a table of 8"):
            table[row]
    with pytest.raises(ParameterError, match="a mask of 3 does not match a table of 8 rows"):
        table[np.array([True, False, True])]
    for rows in ("label", 1.5, None, (0, "a"), [[0, 1]], np.ones((2, 2))):
        with pytest.raises(ParameterError, match="slice, a mask or row numbers"):
            table[rows]
    with pytest.raises(ParameterError, match="give whole numbers"):
        table["a":"b"]


def test_pandas_sees_the_documented_columns_and_durations() -> None:
    frame = walk_jump().to_dataframe()
    assert list(frame.columns.drop("duration_s")) == list(COLUMNS)
    np.testing.assert_array_equal(frame.duration_s, frame.stop_s - frame.start_s)
    assert walk_jump().primitives.to_dataframe().duration_s.sum() == pytest.approx(3.0)
    assert frame.query("level == 'primitive' and cluster == 0").start_frame.tolist() == [0, 20, 70]


@given(segmentations())
def test_every_level_tiles_the_recording(result: Segmentation) -> None:
    for rows in filter(len, (result.activities, result.primitives)):
        covered = np.concatenate([np.arange(r.start_frame, r.stop_frame) for r in rows])
        np.testing.assert_array_equal(covered, np.arange(result.n_frames))
        np.testing.assert_array_equal(rows.start_s, rows.start_frame / result.fps)
    for row in result.primitives:
        parent = result.activities[row.activity]
        assert parent.start_frame <= row.start_frame < row.stop_frame <= parent.stop_frame


@given(segmentations(), st.randoms(use_true_random=False))
def test_row_order_does_not_matter(result: Segmentation, random: object) -> None:
    order = list(range(len(result)))
    random.shuffle(order)  # type: ignore[attr-defined]
    columns = {name: column[order] for name, column in result.table.columns().items()}
    assert replace_columns(result, columns) == result


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"stop_frame": [40, 50, 90, 20, 40, 50, 70, 89]}, "primitive level must cover"),
        ({"start_frame": [0, 41, 50, 0, 20, 40, 50, 70]}, "stops at frame 40, .* starts at 41"),
        ({"start_frame": [0, 30, 50, 0, 20, 40, 50, 70]}, "stops at frame 40, .* starts at 30"),
        ({"level": ["primitive"] * 8}, "activity level must cover frames 0 to 90"),
        ({"level": ["action"] * 8}, "level must be activity or primitive, not 'action'"),
        ({"kind": ["rest"] * 8}, "kind must be activity or primitive or transition, not 'rest'"),
        ({"activity": [0, 1, 2, 0, 0, 1, 2, 1]}, "names activity 1, but lies in activity 2"),
        ({"activity": [1, 1, 2, 0, 0, 1, 2, 2]}, "must count 0, 1, 2"),
        ({"cluster": [0.5] * 8}, "'cluster' must hold whole numbers"),
        ({"cluster": [0] * 7}, "'cluster' has shape"),
        ({"confidence": [np.inf] * 8}, "'confidence' must be finite"),
        ({"label": ["two\nlines"] * 8}, "must be one line"),
        ({"label": [None] * 8}, "must hold texts, not None"),
    ],
)
def test_contradictions_are_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        walk_jump(**changes)


def test_a_primitive_may_not_cross_an_activity_border() -> None:
    spans = [("activity", 0, 5), ("activity", 5, 9), ("primitive", 0, 9)]
    rows = [(level, "activity", start, stop, -1, "") for level, start, stop in spans]
    with pytest.raises(ParameterError, match=r"frames 0 to 9 crosses the border .* at 5"):
        from_rows(rows)


@pytest.mark.parametrize(("n_frames", "fps"), [(0, 30.0), (90, 0.0), (90, np.nan), (90, np.inf)])
def test_a_recording_has_frames_and_a_rate(n_frames: int, fps: float) -> None:
    with pytest.raises(ParameterError, match=r"recording|frame rate"):
        Segmentation.from_columns(WALK_JUMP, n_frames=n_frames, fps=fps)


def test_provenance_must_fit_into_json() -> None:
    with pytest.raises(ParameterError, match="provenance cannot be written as JSON"):
        Segmentation(walk_jump().table, 90, 30.0, provenance={"radius": object()})


def test_a_table_has_the_declared_columns_and_no_others() -> None:
    columns = {"level": ["activity"], "kind": ["activity"], "start_frame": [0], "stop_frame": [9]}
    table = Segmentation.from_columns({**columns, "colour": ["red"]}, n_frames=9, fps=30).table
    assert list(table.columns()) == list(COLUMNS)
    with pytest.raises(AttributeError, match="colour"):
        table.colour  # noqa: B018
    with pytest.raises(TypeError, match="colour"):
        SegmentTable(**table.columns(), colour=np.array(["red"]))
    named = table.with_columns(label=np.array(["hop"]))
    assert (named.label.tolist(), table.label.tolist()) == (["hop"], [""])


def test_kinds_are_those_of_the_levels() -> None:
    columns = {"level": ["activity", "primitive"], "start_frame": [0, 0], "stop_frame": [9, 9]}

    def kinds(*given: str) -> list[str]:
        made = Segmentation.from_columns({**columns, "kind": [*given]}, n_frames=9, fps=30)
        kinds: list[str] = made.table.kind.tolist()
        return kinds

    assert kinds("activity", "primitive") == ["activity", "primitive"]
    assert kinds("activity", "activity") == ["activity", "primitive"]  # as older tables say
    assert kinds("transition", "transition") == ["transition", "transition"]
    with pytest.raises(ParameterError, match="not a primitive"):
        kinds("primitive", "primitive")


def parsed(page: str) -> ET.Element:
    return ET.fromstring(page)


@given(segmentations())
def test_every_result_is_shown_as_well_formed_html(result: Segmentation) -> None:
    page = parsed(result._repr_html_())
    assert len(page.findall(".//tbody/tr")) == min(display.FIRST_ROWS, len(result.activities))
    bars = page.findall(".//rect")
    colors = {bar.get("fill") for bar in bars}
    labels = display.choose_label_colors(result)
    assert colors <= {display.get_segment_color(segment, labels) for segment in result}
    assert len(bars) == len(result)
    for table in (result.table, result.activities, result.table[:0]):
        parsed(table._repr_html_())


def test_a_label_cannot_be_markup() -> None:
    page = make_activities(9, label=["<script>alert(1)</script>"])._repr_html_()
    assert "<script>" not in page
    assert "&lt;script&gt;" in page


def test_hours_of_segments_stay_small() -> None:
    n = 20_000
    result = make_activities(*range(1, n + 1), fps=1.0, cluster=np.arange(n) % 5)
    page = result._repr_html_()
    bars = parsed(page).findall(".//rect")
    assert len(bars) <= 1 + display.WIDTH
    assert len(page) < 200_000
    assert f"and {n - display.FIRST_ROWS} more" in result.table._repr_html_()
