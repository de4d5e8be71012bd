"""A table of another frame rate is not that of a recording, though as long in frames."""

from __future__ import annotations

from pathlib import Path

import pytest

import kineme
from kineme.errors import ReadError
from kineme.labels.collections import labels_of
from kineme.segments.segmentation import Segmentation


def test_a_table_at_another_rate_is_refused(tmp_path: Path) -> None:
    columns = {"level": ["activity"], "kind": ["activity"], "start_frame": [0], "stop_frame": [90]}
    table = Segmentation.from_columns(columns, n_frames=90, fps=50)
    kineme.write_segments(table, tmp_path / "walk.json")
    (source,) = labels_of([Path("walk.bvh")], tmp_path).values()
    assert source.of(n_frames=90, fps=50.001) == table
    with pytest.raises(ReadError, match="is of 50 frames per second, but the recording has 25"):
        source.of(n_frames=90, fps=25)
