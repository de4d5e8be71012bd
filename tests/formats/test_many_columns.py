"""Files with very many columns or branches: work that grows with them, not with their square.

Seconds are those of the processor, and far above what is needed: the square takes minutes.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

import kineme
from kineme.features.topology import find_by_shape

SECONDS = 10.0


def test_thousands_of_columns_are_read_and_written(tmp_path: Path) -> None:
    n = 30_000
    names = [f"channel_{i}" for i in range(n)]
    rows = "".join(",".join([f"{t / 50}", *["0.5", "1.5"][:: 1 - 2 * (t % 2)] * (n // 2)]) + "\n"
                   for t in range(3))  # fmt: skip
    (tmp_path / "wide.csv").write_text(",".join(["time", *names]) + "\n" + rows)
    started = time.process_time()
    wide = kineme.read(tmp_path / "wide.csv")
    kineme.write(wide, tmp_path / "again.csv")
    assert time.process_time() - started < SECONDS
    assert (wide.n_channels, wide.fps) == (n, 50)


def test_thousands_of_branches_at_one_joint() -> None:
    n = 3000
    parents = [-1] + [0] * n + list(range(1, n + 1))
    pose = np.random.default_rng(0).normal(size=(len(parents), 3))
    started = time.process_time()
    find_by_shape(parents, pose)
    assert time.process_time() - started < SECONDS
