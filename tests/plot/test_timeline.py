"""Timelines: what lies where, in which colour, under which name."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from matplotlib import pyplot as plt
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

import kineme
from kineme.errors import ParameterError
from kineme.segments.display import get_cluster_color
from kineme.segments.editing import name_segment
from kineme.segments.segmentation import Segmentation
from segmentations import make_activities, segmentations


def make_result(
    cuts: list[int], clusters: list[int], fps: float = 10.0, **provenance: object
) -> Segmentation:
    kinds = ["activity" if cluster >= 0 else "transition" for cluster in clusters]
    columns = {"kind": kinds, "cluster": clusters, "label": ["walk"] * len(clusters)}
    return make_activities(*cuts, fps=fps, **columns, provenance=provenance)


def list_bars(axes: object) -> list[list[tuple[float, float, str]]]:
    """Start, stop and colour of each bar, row by row."""
    rows = []
    for bars in axes.collections:  # type: ignore[attr-defined]
        spans = [path.vertices[:, 0] for path in bars.get_paths()]
        colors = [to_hex(color).upper() for color in bars.get_facecolors()]
        rows.append([(x.min(), x.max(), color) for x, color in zip(spans, colors)])
    return rows


@settings(max_examples=30)
@given(segmentations())
def test_every_result_is_drawn_segment_by_segment(found: Segmentation) -> None:
    given_axes = Figure().add_subplot()
    assert kineme.plot_timeline(found, ax=given_axes) is given_axes
    levels = [rows for rows in (found.activities, found.primitives) if len(rows)]
    for table, bars in zip(levels, list_bars(given_axes), strict=True):
        starts, stops, colors = zip(*bars)
        np.testing.assert_allclose(starts, table.start_s)
        np.testing.assert_allclose(stops, table.stop_s)
        for segment, color in zip(table, colors):
            if segment.cluster >= 0:
                assert color == get_cluster_color(segment.cluster)
    assert given_axes.get_xlim() == (0, found.n_frames / found.fps)


def test_without_axes_a_figure_is_made() -> None:
    axes = kineme.plot_timeline(make_result([40, 90], [0, 1]))
    assert [text.get_text() for text in axes.texts] == ["walk", "walk"]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["activities"]
    plt.close(axes.figure)


def test_a_label_is_no_formula() -> None:
    found = make_result([40], [0])
    priced = name_segment(found, "activity", 0, "$5 and $")
    figure = Figure()
    axes = kineme.plot_timeline(priced, ax=figure.add_subplot())
    assert axes.texts[0].get_text() == r"\$5 and \$"
    figure.canvas.draw()


def test_compared_clusters_take_the_colours_of_those_they_share_time_with() -> None:
    first = make_result([30, 60, 90], [0, 1, 0])
    other = make_result([280, 600, 900, 1000], [7, 2, 7, 4], fps=100.0)
    axes = kineme.compare([first, other], ax=Figure().add_subplot())
    top, below = list_bars(axes)
    assert [color for *_, color in top] == [get_cluster_color(c) for c in (0, 1, 0)]
    assert [color for *_, color in below] == [get_cluster_color(c) for c in (0, 1, 0, 2)]
    assert axes.get_xlim() == (0, 10.0)


def test_results_are_called_by_what_tells_them_apart() -> None:
    def names(*results: Segmentation, **options: object) -> list[str]:
        axes = kineme.compare(list(results), ax=Figure().add_subplot(), **options)
        return [label.get_text() for label in axes.get_yticklabels()]

    plain = make_result([40], [0])
    one, other = (make_result([40], [0], preset=name) for name in ("kineme", "voegele2014"))
    a, b = (make_result([40], [0], preset="kineme", input={"path": f"x/{n}.bvh"}) for n in "ab")
    assert names(one, other) == ["kineme", "voegele2014"]
    assert names(plain, one) == ["result 1", "kineme"]
    assert names(a, b) == ["a.bvh", "b.bvh"]
    assert names(plain, plain) == ["result 1", "result 2"]
    assert names(plain, plain, names=["truth", "found"]) == ["truth", "found"]


@pytest.mark.parametrize(
    ("results", "options", "message"),
    [
        ([], {}, "at least one result"),
        (make_result([9], [0]), {}, "compare takes a Sequence, not Segmentation"),
        ([3], {}, "compare takes a Segmentation, not int"),
        ([make_result([9], [0])], {"names": ["a", "b"]}, "give a different one for each"),
        ([make_result([9], [0])], {"level": "rest"}, "level must be"),
        ([make_result([9], [0])], {"level": "primitive"}, "has no segments of level 'primitive'"),
    ],
)
def test_what_cannot_be_compared_is_said(results: object, options: dict, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        kineme.compare(results, **options)
