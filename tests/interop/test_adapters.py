"""Segments as ruptures, aeon, sktime and mir_eval know them."""

from __future__ import annotations

import mir_eval
import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from kineme.interop.adapters import to_aeon, to_mir_eval, to_ruptures, to_sktime
from segmentations import segmentations

LEVELS = st.sampled_from(["activity", "primitive"])


@given(segmentations(), LEVELS)
def test_every_package_gets_the_borders(result, level) -> None:
    rows = result.level(level)
    assume(len(rows))
    stops, cuts = to_ruptures(result, level=level), to_aeon(result, level=level)
    assert stops == rows.stop_frame.tolist()
    assert stops[-1] == result.n_frames
    assert cuts.tolist() == stops[:-1]
    intervals, texts = to_mir_eval(result, level=level)
    mir_eval.segment.validate_structure(intervals, texts, intervals, texts)
    assert intervals[0, 0] == 0
    assert np.allclose(intervals * result.fps, np.column_stack([rows.start_frame, rows.stop_frame]))
    table = to_sktime(result, level=level)
    assert table.ilocs.array.closed == "left"
    assert table.ilocs.array.right.tolist() == stops
    assert table.labels.tolist() == texts
