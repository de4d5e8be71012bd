"""Every real sample file loads, or is refused with a message that says what to do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.errors import ReadError


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
        if path.suffix == ".asf":
            with pytest.raises(ReadError, match="is a skeleton without a motion: give the AMC"):
                kineme.read(path)
            continue
        motion = kineme.read(path)
        assert motion.n_frames > 50, path
        assert motion.provenance.sha256
        assert 0.1 < np.ptp(motion.positions[0], axis=0).max() < 10, path  # metres
