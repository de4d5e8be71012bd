"""kineme among the segmenters of aeon and sktime.

Neither goes with the newest numpy and pandas, so they are not among the test
dependencies: ``pip install 'kineme[segmenters]'`` in an environment of its own.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from kineme import Segmenter
from kineme.interop.adapters import to_aeon

WHY = "not installed: pip install 'kineme[segmenters]'"


def make_series() -> np.ndarray:
    t = np.arange(900) / 30
    rng = np.random.default_rng(0)
    one = np.column_stack([np.sin(6 * t), np.cos(6 * t)])
    two = np.column_stack([np.sin(10 * t) ** 3, np.cos(10 * t)])
    return np.where((t < 15)[:, None], one, two) + 0.05 * rng.standard_normal((900, 2))


def find_expected(level: str = "activity") -> list[int]:
    return to_aeon(Segmenter(fps=30).fit(make_series()).segmentation_, level=level).tolist()


def test_aeon_takes_it_for_a_segmenter() -> None:
    pytest.importorskip("aeon", reason=WHY)
    from aeon.testing.estimator_checking import check_estimator

    from kineme.interop.aeon_segmenter import KinemeSegmenter

    x = make_series()
    assert KinemeSegmenter(fps=30).fit_predict(x, axis=0).tolist() == find_expected()
    assert KinemeSegmenter(fps=30).fit_predict(x.T, axis=1).tolist() == find_expected()
    assert KinemeSegmenter(fps=30, level="primitive").fit_predict(
        x, axis=0
    ).tolist() == find_expected("primitive")
    changed = KinemeSegmenter(fps=30, constants={"min_action": 5.0}).clone()
    assert changed.get_params()["constants"] == {"min_action": 5.0}
    results = check_estimator(KinemeSegmenter, raise_exceptions=False)
    failed = {name: result for name, result in results.items() if result != "PASSED"}
    assert len(results) > 15
    # It takes the largest change point of twenty random numbers, which have none.
    assert set(failed.values()) <= {"FAILED: max() arg is an empty sequence"}
    assert all(name.startswith("check_segmenter_instance") for name in failed)


def test_sktime_takes_it_for_a_detector() -> None:
    pytest.importorskip("sktime", reason=WHY)
    from sktime.utils.estimator_checks import check_estimator

    from kineme.interop.sktime_segmenter import KinemeSegmenter

    found = KinemeSegmenter(fps=30).fit_predict(pd.DataFrame(make_series()))
    assert found["ilocs"].array.left[1:].tolist() == find_expected()
    results = check_estimator(KinemeSegmenter, raise_exceptions=False, verbose=False)
    assert len(results) > 50
    assert {name: result for name, result in results.items() if result != "PASSED"} == {}
