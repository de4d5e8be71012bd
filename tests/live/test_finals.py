"""What is final follows the latest look, and repetitions of two looks are counted once each."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from kineme.live import ActivityEnded, ActivityStarted
from kineme.live.events import Finals, Look, Looks, Row


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


def advance_by_looks(looks):
    """Return the final borders and counts of looks at frames 80, 100, ... with a delay of 50."""
    finals, before, events = Finals(10.0), None, []
    for now, (activities, cuts) in zip(range(80, 1000, 20), looks, strict=False):
        primitives = [
            Row(a, b, row.cluster)
            for row, step in zip(activities, cuts, strict=True)
            for a, b in pairwise(range(row.start, row.stop + 1, step))
        ]
        look = Look(activities, primitives)
        events += finals.advance(Looks(look, before, now - 50, 50, 400, now))
        before = look
    events += finals.close(1000, 100.0)
    starts = [(e.start_s, e.cluster) for e in events if isinstance(e, ActivityStarted)]
    return starts, [e.repetitions for e in events if isinstance(e, ActivityEnded)]


def test_the_end_and_the_count_of_an_activity_follow_the_looks_at_all_of_it():
    early = [([Row(0, now, 0)], [30]) for now in range(80, 200, 20)]
    # Only now are the first repetitions told from those that began at frame 100.
    late = [([Row(0, 100, 0), Row(100, now, 1)], [25, 40]) for now in range(200, 300, 20)]
    starts, counts = advance_by_looks(early + late)
    assert starts == [(0, 0), (10, 1)]
    assert counts == [4, 4]


def test_an_activity_goes_on_if_later_looks_do_not_see_its_start():
    early = [([Row(0, 60, 0), Row(60, now, 1)], [30, 10]) for now in range(80, 160, 20)]
    late = [([Row(0, now, 1)], [30]) for now in range(160, 400, 20)]
    starts, _ = advance_by_looks(early + late)
    assert starts == [(0, 0), (6, 1)]


def test_a_part_of_a_repetition_is_no_activity_yet():
    early = [([Row(0, 60, 0), Row(60, now, 1)], [30, now - 60]) for now in range(80, 160, 20)]
    late = [([Row(0, now, 0)], [30]) for now in range(160, 400, 20)]
    assert advance_by_looks(early + late)[0] == [(0, 0)]


def test_a_start_that_moves_behind_a_short_transition_splits_no_activity():
    early = [([Row(0, 60, 0), Row(60, now, 1)], [30, 10]) for now in range(80, 200, 20)]
    late = [
        ([Row(0, 60, 0), Row(60, 68, -1), Row(68, now, 1)], [30, 100, 10])
        for now in range(200, 400, 20)
    ]
    assert advance_by_looks(early + late)[0] == [(0, 0), (6, 1)]
