"""Occurrences: spans that recur are found at any place, and no others."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

import naive
from gestures import insert_gestures, make_wandering, stack_features
from kineme.methods.kineme import _event_kernels as kernels
from kineme.methods.kineme import events
from kineme.methods.kineme.events import Occurrences, find_occurrences
from kineme.methods.kineme.pipeline import analyze
from kineme.methods.kineme.preset import KINEME
from kineme.methods.kineme.primitives import (
    Segments,
    drop_still_clusters,
    replace_by_occurrences,
)

seconds = settings(max_examples=40)


@st.composite
def walks(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Draw samples, their costs, and starts of free spans."""
    n = draw(st.integers(2, 24))
    rng = np.random.default_rng(draw(st.integers(0, 99)))
    samples = rng.integers(0, 3, (n, 2)) / 2 + rng.normal(0, 1e-3, (n, 2))
    begins = rng.random(n) < draw(st.sampled_from([0.0, 0.1]))
    begins[0] = True
    return samples, rng.uniform(0, 0.3, n), begins


@given(walks(), st.integers(1, 4), st.integers(4, 30), st.sampled_from([0.5, 2.0]))
@seconds
def test_paths_are_those_of_the_naive_version(walk, gap, width, least) -> None:
    samples, costs, begins = walk
    columns = np.ascontiguousarray(samples.T)
    ends, scores, _ = kernels.find_local_paths(columns, costs, begins, gap, width, 99, 0.8, least)
    found: dict[tuple[int, int], float] = {}
    for (i, j, *_), score in zip(ends.tolist(), scores, strict=True):
        found[i, j] = max(found.get((i, j), 0), score)
    best = naive.find_local_path_scores(samples, costs, begins, gap, width, 0.8)
    assert found == pytest.approx({first: s for first, s in best.items() if s >= least})


@given(walks())
@seconds
def test_a_path_is_followed_as_by_the_naive_version(walk) -> None:
    samples, costs, begins = walk
    columns = np.ascontiguousarray(samples.T)
    ends, scores, _ = kernels.find_local_paths(columns, costs, begins, 1, 30, 99, 0.8, 1.0)
    for each, score in zip(ends, scores, strict=True):
        partners, sums, other_partners, other_sums = kernels.trace_path(columns, costs, each, 0.8)
        expected = naive.trace_path_score(samples, costs, each.tolist()[:4], 0.8)
        assert sums[-1] == pytest.approx(expected)
        assert other_sums[-1] == pytest.approx(expected)
        assert expected >= score - 1e-9
        assert partners[[0, -1]].tolist() == [each[1], each[3]]
        assert other_partners[[0, -1]].tolist() == [each[0], each[2]]
        assert (np.diff(partners) > 0).all()


def paths_of(rng: np.random.Generator, n: int) -> list[tuple[int, np.ndarray, np.ndarray]]:
    paths = []
    for _ in range(12):
        length = int(rng.integers(2, n // 2))
        first, other = rng.integers(0, n - length, 2)
        scores = rng.uniform(-0.3, 1, length)
        paths.append((int(first), other + np.arange(length, dtype=float), scores.cumsum()))
    return paths


@given(st.integers(0, 10_000))
@seconds
def test_recurrences_and_the_best_set_are_those_of_the_naive_version(seed) -> None:
    rng = np.random.default_rng(seed)
    n, cover = 30, 0.8
    paths = paths_of(rng, n)
    free = rng.random(n) < 0.9
    starts = np.array([first for first, _, _ in paths])
    sizes = np.array([len(sums) for _, _, sums in paths])
    ptr = np.append(0, np.cumsum(sizes))
    rows = np.concatenate([first + np.arange(len(sums)) for first, _, sums in paths])
    row_paths = np.repeat(np.arange(len(paths)), sizes)[np.argsort(rows, kind="stable")]
    row_ptr = np.append(0, np.cumsum(np.bincount(rows, minlength=n)))
    flat = [np.concatenate([path[k] for path in paths]) for k in (1, 2)]
    lengths = np.array([3, 5, 8])
    spans, gains = np.empty((n, 4), np.int64), np.empty(n)
    totals: dict[tuple[int, int], float] = {}
    for start in range(n):
        for stop in start + lengths[start + lengths <= n]:
            total, count = kernels.count_recurrences(
                start, stop, starts, ptr, *flat, row_ptr, row_paths, free, cover, spans, gains
            )
            expected = naive.find_recurrences(start, stop, paths, free, cover)
            of = [(begin, end, *part) for begin, end, _, part in expected]
            assert [tuple(span) for span in spans[:count].tolist()] == of
            assert total == pytest.approx(sum(gain for _, _, gain, _ in expected))
            if expected and free[start:stop].all():
                covered = min(low for *_, low, _ in of), max(high for *_, high in of)
                totals[covered] = max(total, totals.get(covered, 0))
    places, _, ranks = kernels.choose_sets(
        lengths, starts, ptr, *flat, row_ptr, row_paths, free, cover
    )
    if len(places):
        assert totals[tuple(places[0].tolist())] == max(totals.values())
    assert (np.diff(ranks) >= 0).all()


def found_in(rows: np.ndarray, free: np.ndarray | None = None) -> Occurrences:
    everywhere = np.ones(len(rows), np.bool_)
    return find_occurrences(rows, everywhere if free is None else free, KINEME)


def test_a_gesture_made_now_and_then_is_one_cluster() -> None:
    places = [100, 310, 555, 790]
    found = found_in(insert_gestures(1, places))
    assert found.clusters.tolist() == [0, 0, 0, 0]
    assert np.abs(found.starts - places).max() <= 6
    assert np.abs(found.stops - places - 40).max() <= 6
    assert (found.similarity > 0.3).all()


@pytest.mark.parametrize("places", [[100, 310], [100, 310, 555]])
def test_an_event_must_be_long_enough(places: list[int]) -> None:
    rows = insert_gestures(1, places)
    everywhere = np.ones(len(rows), np.bool_)

    def found(min_recurrence: float) -> int:
        preset = KINEME.replace(min_recurrence=min_recurrence)
        return len(find_occurrences(rows, everywhere, preset))

    strongest = 1.7  # path here, seconds
    assert found(0.9 * strongest) == len(places)
    assert found(1.1 * strongest) == 0


def test_what_is_not_free_is_not_looked_at() -> None:
    rows = insert_gestures(2, [100, 310, 555])
    free = np.ones(len(rows), np.bool_)
    free[300:360] = False
    found = found_in(rows, free)
    assert len(found) == 2
    assert found.stops[0] <= 300
    assert found.starts[1] >= 360


@pytest.mark.parametrize("seed", range(3))
def test_movement_that_never_comes_back_has_no_occurrences(seed) -> None:
    assert len(found_in(make_wandering(np.random.default_rng(seed), 900))) == 0


def test_gestures_are_primitives_where_nothing_is_counted() -> None:
    places = [100, 310, 555, 790]
    found = analyze(stack_features(insert_gestures(1, places)), KINEME)
    occurring = found.segments.clusters > found.segments.labels.max()
    assert np.abs(found.primitives[:-1][occurring] - places).max() <= 6
    assert len(set(found.segments.clusters[occurring].tolist())) == 1
    assert (found.segments.counts <= 1).all()
    columns = found.columns()
    primitive = columns["level"] == "primitive"
    assert np.isnan(columns["confidence"][primitive][occurring]).all()


def test_what_is_counted_for_sure_keeps_its_repetitions() -> None:
    angle = 2 * np.pi * np.arange(600) / 45
    rows = 0.3 * np.column_stack([np.sin(k * angle + k) for k in (1, 2, 1, 3, 1, 2)])
    found = analyze(stack_features(rows), KINEME)
    assert np.abs(np.diff(found.primitives)[found.segments.clusters == 0] - 45).max() <= 4
    assert found.segments.clusters.max() == 0
    assert found.segments.not_periodic.size == 0
    assert found.doubts(found.columns(), 30.0) == []


def test_standing_still_does_not_recur() -> None:
    rng = np.random.default_rng(0)
    assert len(found_in(rng.normal(0, 1e-4, (900, 6)))) == 0
    assert len(found_in(np.zeros((900, 6)))) == 0
    assert len(found_in(np.zeros((1, 6)))) == 0


def test_backwards_is_another_movement() -> None:
    rows = insert_gestures(3, [100, 400])
    rows[400:440] = rows[400:440][::-1]
    assert len(found_in(rows)) == 0


# Processor time, so that other programs do not count; memory beyond what compiled code needs.
MEASURE = """
import re, sys, time
from pathlib import Path
import numpy as np
from gestures import stack_features, insert_gestures
from kineme.methods.kineme.pipeline import analyze
from kineme.methods.kineme.preset import KINEME
from loops import make_swings

def peak():  # rusage has that of the process that started this one, too
    return int(re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())[1])

parts = []
for seed in range(6):
    walk = make_swings(6 + seed, period=1 + seed / 10, axis=seed % 4)
    parts += [walk, insert_gestures(seed, [100, 310, 555, 790])]
PRESET = KINEME.replace(part=300.0)  # parts are done alone, so that two and four are compared
frames = round(60 * 20 * PRESET.working_fps)
rows = np.tile(np.resize(np.concatenate(parts), (frames, 6)), 2)
rows = stack_features(rows + np.random.default_rng(0).normal(0, 0.01, rows.shape))
analyze(rows[: round(15 * PRESET.working_fps)], PRESET)
before = peak()
for share in (2, 1):
    start = time.process_time()
    analyze(rows[: frames // share], PRESET)
    print(time.process_time() - start, peak() - before)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="peak memory is read from /proc")
def test_twice_as_long_takes_about_twice_the_time_and_memory() -> None:
    helpers = str(Path(__file__).parents[2] / "helpers")
    path = os.pathsep.join([helpers, *filter(None, [os.environ.get("PYTHONPATH")])])
    env = {**os.environ, "PYTHONPATH": path}
    command = [sys.executable, "-c", MEASURE]
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    half, whole = (line.split() for line in done.stdout.splitlines())
    for less, more in zip(half, whole, strict=True):
        assert float(more) / float(less) < 2.6


def found_in_legs(rows: np.ndarray, leg: float) -> Occurrences:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(events, "LEG", leg)
        return events.find_occurrences(rows, np.ones(len(rows), np.bool_), KINEME)


def test_paths_that_are_longer_than_a_leg_are_found_as_without_one() -> None:
    rows = np.vstack([insert_gestures(1, [100, 310, 555, 790])] * 4)
    rows += np.random.default_rng(0).normal(0, 0.01, rows.shape)
    whole, in_legs = found_in_legs(rows, 3600), found_in_legs(rows, 5)
    assert in_legs.clusters.tolist() == whole.clusters.tolist()
    assert np.abs(in_legs.starts - whole.starts).max() <= 1
    assert np.abs(in_legs.stops - whole.stops).max() <= 1


BORDERS = np.array([0, 100, 130, 300, 400])
LABELS = np.array([0, -1, 1, 0])


def segments() -> Segments:
    """Make an activity of two repetitions, a transition, one repetition, and the first again."""
    return Segments(
        BORDERS,
        LABELS,
        np.array([0, 50, 100, 130, 300, 400]),
        np.array([0, 0, -1, 1, 0]),
        np.empty(0, np.int64),
    )


def occurring(*spans: tuple[int, int]) -> Occurrences:
    starts, stops = np.array(spans, np.int64).reshape(-1, 2).T
    return Occurrences(starts, stops, np.zeros(len(spans), np.int64), np.full(len(spans), 0.5))


FREE = np.array([False, True, True, False])


def test_occurrences_and_what_lies_between_are_the_primitives() -> None:
    found = replace_by_occurrences(segments(), occurring((140, 180), (220, 260)), FREE)
    assert found.primitives.tolist() == [0, 50, 100, 130, 140, 180, 220, 260, 300, 400]
    assert found.clusters.tolist() == [0, 0, -1, -1, 2, -1, 2, -1, 0]
    assert found.repeats.tolist() == [True, True] + 6 * [False] + [True]
    assert found.borders.tolist() == BORDERS.tolist()
    assert found.not_periodic.tolist() == [1]


def test_numbers_go_on_after_repetitions_that_are_another_movement() -> None:
    parts = replace(segments(), clusters=np.array([0, 3, -1, 2, 0]))
    found = replace_by_occurrences(parts, occurring((140, 180), (220, 260)), FREE)
    assert found.clusters.tolist() == [0, 2, -1, -1, 3, -1, 3, -1, 0]
    untouched = replace_by_occurrences(parts, occurring(), np.zeros(4, np.bool_))
    assert untouched.clusters.tolist() == [0, 2, -1, 3, 0]
    assert untouched.not_periodic.size == 0


@pytest.mark.parametrize(
    ("spans", "borders", "labels"),
    [
        (((120, 180), (220, 260)), [0, 100, 120, 300, 400], [0, -1, 1, 0]),  # the nearer end
        (((100, 135), (220, 260)), [0, 100, 135, 300, 400], [0, -1, 1, 0]),
        (((100, 270), (280, 300)), [0, 100, 300, 400], [0, 1, 0]),  # the transition is taken
    ],
)
def test_no_border_cuts_an_occurrence(spans, borders, labels) -> None:
    found = replace_by_occurrences(segments(), occurring(*spans), FREE)
    assert found.borders.tolist() == borders
    assert found.labels.tolist() == labels


def alone() -> Segments:
    """Make activities: one repetition of 30 frames, one that repeats, and one with occurrences."""
    return Segments(
        np.array([0, 30, 100, 300]),
        np.array([0, 1, 2]),
        np.array([0, 30, 65, 100, 180, 220, 300]),
        np.array([0, 1, 1, -1, 3, -1]),
        np.array([2]),
    )


@pytest.mark.parametrize("fps", [10.0, 30.0])
@pytest.mark.parametrize("noise", [0.005, 0.01])
def test_a_body_that_stands_still_has_no_events(fps: float, noise: float) -> None:
    rows = np.random.default_rng(0).normal(0, noise, (int(60 * fps), 15))
    assert not len(find_occurrences(rows, np.ones(len(rows), np.bool_), KINEME.at_most(fps)))


@pytest.mark.parametrize(("near", "kept"), [(14, True), (15, False), (1000, False)])
def test_a_single_repetition_that_hardly_moves_is_none(near, kept) -> None:
    rows = np.arange(300, dtype=np.float32)[:, None]  # 14.5 from the mean of 30 at most
    given = alone()
    found = drop_still_clusters(given, rows, near)
    if kept:
        assert found is given
    assert found.clusters.tolist() == [0 if kept else -1, 1, 1, -1, 3, -1]
    assert found.not_periodic.tolist() == ([2] if kept else [0, 2])
    assert found.counts.tolist() == [int(kept), 2, 0]
