"""Every real sample file loads, or is refused with a message that says what to do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.errors import ReadError
from kineme.recordings.operations import cut

REFUSED = {
    ".asf": "is a skeleton without a motion: give the AMC file",
}
"""What cannot be a motion, and what the user is told to do instead."""


@pytest.mark.parametrize("folder", ["formats", "cmu_formats", "timeseries"])
@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
def test_every_sample(data_dir: Path, folder: str) -> None:
    files = sorted(path for path in (data_dir / folder).iterdir() if path.is_file())
    assert files
    for path in files:
        if path.suffix in (".txt", ".mot"):
            signals = kineme.read(path, fps=100 if path.suffix == ".txt" else None)
            assert isinstance(signals, kineme.Signals)
            assert signals.n_frames > 50
            continue
        reason = REFUSED.get(path.suffix.lower())
        if reason is None:
            motion = kineme.read(path)
            assert motion.n_frames > 50, path
            assert motion.provenance.sha256
            assert 0.1 < np.ptp(motion.positions[0], axis=0).max() < 10, path  # metres
        else:
            with pytest.raises(ReadError, match=reason):
                kineme.read(path)


@pytest.mark.parametrize(
    ("take", "suffixes"),
    [("02_01", ("amc", "bvh", "c3d")), ("49_02", ("amc", "bvh"))],
)
def test_one_take_has_the_same_borders_in_every_format(
    data_dir: Path, take: str, suffixes: tuple[str, ...]
) -> None:
    cuts = []
    for suffix in suffixes:
        motion = kineme.read(data_dir / "cmu_formats" / f"{take}.{suffix}")
        if suffix == "bvh":  # the conversion put a T-pose of one frame before the take
            motion = cut(motion, 1, motion.n_frames)
        segments = kineme.segment(motion)
        cuts.append([row.start_s for row in segments.primitives])
    for other in cuts[1:]:
        for ours, theirs in ((cuts[0], other), (other, cuts[0])):
            away = np.abs(np.subtract.outer(ours, theirs)).min(axis=1)
            assert (away <= 0.2).mean() >= 0.9, f"{take}: {cuts}"
