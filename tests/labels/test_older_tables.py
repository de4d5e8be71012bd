"""Tables of ``kineme.segments/1`` are read: ``score`` for confidence, primitives called activities.

The files in ``tests/older/tables`` were written by the last version that wrote such tables: the
segments of a recording of sensors, and the same named, checked and commented by a person.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from kineme.labels import read_segments, write_segments
from kineme.segments import editing
from kineme.segments.editing.annotating import marked
from kineme.segments.segmentation import Segmentation

OLDER = Path(__file__).parents[1] / "older" / "tables"


def written(name: str) -> list[dict[str, str]]:
    """The rows of the CSV as it stands there, under the names of today."""
    with (OLDER / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["confidence"] = row.pop("score")
        if row["kind"] == "activity":
            row["kind"] = row["level"]
    return rows


@pytest.mark.parametrize("name", ["found", "edited"])
@pytest.mark.parametrize("file", ["{}.csv", "{}.parquet", "{}_whole.json"])
def test_every_cell_is_read(name: str, file: str) -> None:
    table = read_segments(OLDER / file.format(name)).table
    rows = written(name)
    assert {row["kind"] for row in rows} == {"activity", "primitive", "transition"}
    for column, values in table.columns().items():
        cells = [row[column] for row in rows]
        if values.dtype.kind == "f":
            expected = [float(cell) if cell else np.nan for cell in cells]
            np.testing.assert_array_equal(values, expected, column)
        else:
            assert list(map(str, values.tolist())) == cells, column


@pytest.mark.parametrize("file", ["found.csv", "found.parquet", "found_whole.json"])
def test_other_details_are_read(file: str) -> None:
    found = read_segments(OLDER / file)
    assert found.hierarchy is not None
    assert found.hierarchy.details == (0.125, 1.0)
    assert found.at_detail(0.125).activities.kind.tolist() == ["activity"]
    assert set(found.at_detail(0.125).primitives.kind.tolist()) == {"primitive", "transition"}


@pytest.mark.parametrize("file", ["edited.csv", "edited.parquet", "edited_whole.json"])
def test_what_people_did_is_read(file: str) -> None:
    edited = read_segments(OLDER / file)
    assert editing.cluster_names(edited) == {0: "row"}
    assert editing.comments(edited) == [("activity", 150, "slips once")]
    assert marked(edited, "checked") == {("activity", 0, 301)}
    assert edited.provenance["notes"] == read_segments(OLDER / "edited.csv").provenance["notes"]


def test_events_of_bids_are_read() -> None:
    events = read_segments(OLDER / "edited_events.tsv", format="bids")
    edited = read_segments(OLDER / "edited.csv")
    for name in ("level", "kind", "start_frame", "stop_frame", "cluster", "confidence"):
        np.testing.assert_array_equal(
            events.table.columns()[name], edited.table.columns()[name], name
        )


@pytest.mark.parametrize("suffix", [".csv", ".json", ".parquet"])
def test_what_is_written_from_them_has_the_names_of_today(tmp_path: Path, suffix: str) -> None:
    found = read_segments(OLDER / "found_whole.json")
    path = tmp_path / f"found{suffix}"
    write_segments(found, path)
    assert read_segments(path) == found
    if suffix == ".json":
        told = json.loads(path.read_text())
        assert told["schema"] == "kineme.segments/2"
        assert "score" not in told["segments"][0]
        assert told["segments"][2]["kind"] == "primitive"


def test_columns_of_older_programs_make_the_same_table() -> None:
    rows = written("found")
    older = {
        "level": [row["level"] for row in rows],
        "kind": ["transition" if row["kind"] == "transition" else "activity" for row in rows],
        "start_frame": [int(row["start_frame"]) for row in rows],
        "stop_frame": [int(row["stop_frame"]) for row in rows],
        "score": [float(row["confidence"] or "nan") for row in rows],
    }
    made = Segmentation.from_columns(older, n_frames=600, fps=20).table
    found = read_segments(OLDER / "found.csv").table
    for name in ("kind", "confidence"):
        np.testing.assert_array_equal(made.columns()[name], found.columns()[name], name)
