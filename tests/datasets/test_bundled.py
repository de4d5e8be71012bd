"""The recording in the package: small, readable, and made by the code beside it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.datasets import bundled_recording, bundled_truth
from kineme.datasets.make_bundled import make_bundled


def test_it_is_small_and_reads_with_its_truth() -> None:
    assert bundled_recording().stat().st_size <= 1_000_000
    motion = kineme.read(bundled_recording())
    truth = kineme.read_segments(bundled_truth())
    assert (motion.n_frames, motion.fps) == (truth.n_frames, pytest.approx(truth.fps))
    assert 40 < motion.duration < 60
    activities = truth.activities.label[truth.activities.kind == "activity"]
    assert activities.tolist() == ["walk", "squat", "walk", "arm circles", "jump", "run", "kick"]


def test_making_it_again_gives_the_same(tmp_path: Path) -> None:
    make_bundled(tmp_path)
    for stored in (bundled_recording(), bundled_truth()):
        again = (tmp_path / stored.name).read_text(encoding="utf-8").splitlines()
        lines = stored.read_text(encoding="utf-8").splitlines()
        assert len(again) == len(lines)
        for new, old in zip(again, lines, strict=True):
            if new != old:  # the last decimal may differ between processors
                np.testing.assert_allclose(
                    np.array(new.split(), float), np.array(old.split(), float), atol=0.0101
                )
