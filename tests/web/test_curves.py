"""Curves over time: every value of a recording is between what its pieces say, at any level."""

from __future__ import annotations

import numpy as np

import kineme
from kineme.cycles import channels_of
from kineme.recordings import Signals
from kineme.web.curves import (
    FACTOR,
    TILE,
    Curves,
    build_levels,
    compute_level_sizes,
    make_report_curves,
)


def test_no_peak_is_lost_at_any_level() -> None:
    values = np.random.default_rng(0).normal(size=9001)
    values[4321] = 50.0
    values[5000:5600] = np.nan
    for level, pairs in enumerate(build_levels(values)):
        wide = FACTOR**level
        assert len(pairs) == compute_level_sizes(len(values))[level]
        assert np.nanmax(pairs[:, 1]) == 50.0
        for i in (0, 4321 // wide):
            part = values[i * wide : (i + 1) * wide]
            assert np.isclose(pairs[i, 0], np.nanmin(part))


def test_curves_of_a_body() -> None:
    motion = kineme.read(kineme.bundled_recording())
    curves = Curves(motion)
    heads = curves.head().curves
    height = next(i for i, each in enumerate(heads) if each.group == "height")
    tile = np.frombuffer(curves.tile(lambda _: motion, height, 0, 0), "<f4").reshape(-1, 2)
    assert np.allclose(tile[:, 0], motion.positions[:TILE, 0, 1], atol=1e-5)
    assert {each.group for each in heads} == {"angle", "height", "speed", "x", "z"}
    knee = next(i for i, each in enumerate(heads) if each.name == "knee_l")
    tile = np.frombuffer(curves.tile(lambda _: motion, knee, 0, 0), "<f4").reshape(-1, 2)
    assert np.allclose(tile[:, 0], channels_of(motion, ["knee_l"])[0].values()[:TILE], atol=1e-4)
    assert curves.tile(lambda _: motion, len(heads), 0, 0) is None


def test_a_report_has_the_channels_of_signals() -> None:
    signals = Signals(np.arange(6000.0).reshape(3000, 2), 50.0, ["a", "b"], gaps=[(10, 20)])
    head, pieces = make_report_curves(signals, 50.0)
    assert [each.name for each in head.curves] == ["a", "b"]
    first = np.frombuffer(pieces["0/0/0"], "<f4")
    assert np.isnan(first[20:40]).all()
    assert first[2] == 2.0
