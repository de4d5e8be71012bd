"""Repetitions that are cut at other phases are counted once each."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from kineme.live.events import Finals, Row


@pytest.mark.parametrize("seed", range(20))
def test_a_change_of_phase_neither_loses_nor_doubles_repetitions(seed):
    rng = np.random.default_rng(seed)
    cuts = 100 + np.cumsum(rng.integers(5, 40, 12))
    rows = [Row(a, b, 0) for a, b in pairwise(cuts.tolist()) if rng.random() > 0.2]
    finals = Finals(25.0, counted=int(rng.integers(100, cuts[-1])), slip=rng.choice([0, 0.4, -0.4]))
    found, slip = finals.uncounted(rows, first=100)
    left = sum(row.start + row.stop >= 2 * finals.counted for row in rows)
    assert left - 1 <= len(found) <= left
    assert all(row.start < row.stop for row in found)
    assert all(a.stop <= b.start for a, b in pairwise(found))
    if found:
        assert finals.counted <= found[0].start
        assert found[-1].stop == rows[-1].stop
    assert abs(finals.slip + slip) < 0.5


def test_a_phase_that_keeps_changing_adds_no_repetition():
    finals = Finals(25.0)
    for look in range(10):
        shift = 8 * look % 20
        rows = [Row(max(0, at - shift), at - shift + 20, 0) for at in range(0, 420, 20)]
        found, slip = finals.uncounted(rows, first=0)
        for row in found[:2]:
            finals.counted, finals.n_repetitions = row.stop, finals.n_repetitions + 1
        finals.slip += slip
    assert finals.n_repetitions == 20
    assert abs(finals.counted - 400) <= 20
