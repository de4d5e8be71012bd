"""Reading time grows linearly with the number of columns or branches."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import kineme
from growth import LINEAR, times_longer
from kineme.features.effectors import find_by_shape


def test_thousands_of_columns_are_read_and_written(tmp_path: Path) -> None:
    def read_and_write(n: int) -> None:
        names = [f"channel_{i}" for i in range(n)]
        rows = "".join(
            ",".join([f"{t / 50}", *["0.5", "1.5"][:: 1 - 2 * (t % 2)] * (n // 2)]) + "\n"
            for t in range(3)
        )
        (tmp_path / "wide.csv").write_text(",".join(["time", *names]) + "\n" + rows)
        wide = kineme.read(tmp_path / "wide.csv")
        kineme.write(wide, tmp_path / "again.csv")
        assert (wide.n_channels, wide.fps) == (n, 50)

    assert times_longer(read_and_write, 16_000) < LINEAR


def test_thousands_of_branches_at_one_joint() -> None:
    def look(n: int) -> None:
        parents = [-1] + [0] * n + list(range(1, n + 1))
        find_by_shape(parents, np.random.default_rng(0).normal(size=(len(parents), 3)))

    assert times_longer(look, 3200) < LINEAR
