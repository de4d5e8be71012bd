"""Segments as ruptures, aeon, sktime and mir_eval know them."""

from __future__ import annotations

import mir_eval
import numpy as np
import pandas as pd
import pytest
import ruptures
from hypothesis import assume, given
from hypothesis import strategies as st
from ruptures.metrics import hausdorff

from kineme.errors import ParameterError
from kineme.interop.adapters import (
    from_aeon,
    from_mir_eval,
    from_ruptures,
    from_sktime,
    to_aeon,
    to_mir_eval,
    to_ruptures,
    to_sktime,
)
from segmentations import segmentations

LEVELS = st.sampled_from(["activity", "primitive"])


@given(segmentations(), LEVELS)
def test_every_package_gives_the_borders_back(result, level) -> None:
    rows = result.level(level)
    assume(len(rows))
    intervals, texts = to_mir_eval(result, level=level)
    for back in (
        from_ruptures(to_ruptures(result, level=level), fps=result.fps),
        from_aeon(to_aeon(result, level=level), n_frames=result.n_frames, fps=result.fps),
        from_sktime(to_sktime(result, level=level), fps=result.fps),
        from_mir_eval(intervals, texts, fps=result.fps),
    ):
        assert back.activities.start_frame.tolist() == rows.start_frame.tolist()
        assert back.n_frames == result.n_frames
    assert to_mir_eval(back)[1] == texts
    mir_eval.segment.validate_structure(intervals, texts, intervals, texts)
    assert intervals[0, 0] == 0
    assert to_ruptures(result, level=level)[-1] == result.n_frames
    assert 0 not in to_ruptures(result, level=level)
    assert not {0, result.n_frames} & set(to_aeon(result, level=level).tolist())
    assert to_sktime(result, level=level).ilocs.array.closed == "left"


def test_ruptures_takes_and_gives_our_breakpoints() -> None:
    signal, truth = ruptures.pw_constant(300, 2, 3, noise_std=0.1, seed=1)
    found = ruptures.Binseg(jump=1).fit(signal).predict(n_bkps=3)
    ours = from_ruptures(found, fps=30)
    assert hausdorff(to_ruptures(ours), truth) <= 2
    assert ours.n_frames == 300


def test_wrong_ends_are_named() -> None:
    with pytest.raises(ParameterError, match="start at 0, and each must start where"):
        from_mir_eval([[0, 1], [2, 3]], ["a", "b"], fps=10)
    with pytest.raises(ParameterError, match=r"\(n, 2\), not of shape \(2,\)"):
        from_mir_eval([0, 1], ["a"], fps=10)
    with pytest.raises(ParameterError, match="left-closed"):
        from_sktime(pd.DataFrame({"ilocs": pd.interval_range(0, 3)}), fps=10)
    with pytest.raises(ParameterError, match="consecutive whole numbers, not float64"):
        from_aeon([0.5], n_frames=2, fps=10)
    with pytest.raises(ParameterError, match="at least the number of frames"):
        from_ruptures([], fps=10)
    assert from_aeon(np.array([], int), n_frames=7, fps=10).n_frames == 7
