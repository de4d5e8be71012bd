"""Files laid out as programs write them, made from arrays."""

from pathlib import Path

import numpy as np
import pytest

import kineme

RNG = np.random.default_rng(4)
POINTS = RNG.normal(size=(40, 3, 3)).cumsum(axis=0) + 900


@pytest.mark.parametrize("tabs", ["\t", "\t\t", "\t\t\t"])
def test_trc_names_stand_any_number_of_tabs_apart(tmp_path: Path, tabs: str) -> None:
    path = tmp_path / "take.trc"
    rows = (
        "\t".join([f"{i + 1}", f"{i / 60:.4f}", *(f"{v:.4f}" for v in row.ravel())])
        for i, row in enumerate(POINTS)
    )
    head = [
        "PathFileType\t4\t(X/Y/Z)\ttake.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits",
        "60\t60\t40\t3\tmm",
        f"Frame#\tTime\t{tabs.join(['LASI', 'RASI', 'SACR'])}",
        "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3",
    ]
    path.write_text("\n".join([*head, "", *rows]))
    motion = kineme.read(path, up="y")
    assert isinstance(motion, kineme.Motion)
    found = motion.positions[:, [motion.skeleton.names.index(n) for n in ("LASI", "RASI", "SACR")]]
    assert np.abs(found - POINTS / 1000).max() < 1e-6
