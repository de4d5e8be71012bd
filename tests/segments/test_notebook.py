"""Results in notebooks: a small picture and a few rows at any length."""

from __future__ import annotations

from xml.etree import ElementTree as ET

import numpy as np
from hypothesis import given, settings

from kineme.segments import display
from kineme.segments.display import FIRST_ROWS, choose_label_colors
from kineme.segments.segmentation import Segmentation
from segmentations import make_activities, segmentations


def parsed(page: str) -> ET.Element:
    return ET.fromstring(page)


@settings(max_examples=50)
@given(segmentations())
def test_every_result_is_shown_as_well_formed_html(result: Segmentation) -> None:
    page = parsed(result._repr_html_())
    assert len(page.findall(".//tbody/tr")) == min(FIRST_ROWS, len(result.activities))
    bars = page.findall(".//rect")
    colors = {bar.get("fill") for bar in bars}
    labels = choose_label_colors(result)
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
    assert f"and {n - FIRST_ROWS} more" in result.table._repr_html_()
