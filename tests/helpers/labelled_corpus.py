"""Make a small folder of labelled recordings."""

from __future__ import annotations

from pathlib import Path

import numpy as np


def make_corpus(home: Path) -> Path:
    """Write four recordings, one of them damaged, and labels of three."""
    (home / "recordings").mkdir()
    random = np.random.default_rng(0)
    times = np.arange(1200) / 30
    for name in ("a", "b"):
        slow, fast = np.sin(2 * np.pi * 0.7 * times), np.sin(2 * np.pi * 1.9 * times)
        shape = np.where(times < 20, slow, 0.4 * fast)
        other = np.where(times < 20, np.cos(2 * np.pi * 0.7 * times), 1.5 + 0.4 * slow)
        channels = np.column_stack([shape, other]) + 0.02 * random.normal(size=(1200, 2))
        lines = [f"{t:.4f},{x:.5f},{y:.5f},{random.normal():.5f}"
                 for t, (x, y) in zip(times, channels, strict=True)]  # fmt: skip
        text = "\n".join(["time_s,gyro_x,gyro_y,EMG_1", *lines])
        (home / "recordings" / f"{name}.csv").write_text(text)
    (home / "recordings" / "broken.csv").write_text("time_s,gyro_x\n0,1\nx,y\n")
    (home / "recordings" / "unlabelled.csv").write_text(text)
    rows = ["recording,start_s,stop_s,label", "a,0,20,slow", "a,20,38,fast", "b,0,21,slow",
            "b,20,40,fast", "broken,0,1,slow"]  # fmt: skip
    (home / "labels.csv").write_text("\n".join(rows))
    return home
