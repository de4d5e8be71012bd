"""The columns of the table are declared once, as fields of `Segment`."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from kineme.errors import ParameterError
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, Segment, SegmentTable

ONE_MORE = '''
import inspect, json, runpy, sys, types
from pathlib import Path

from kineme import segments

# The table with one field more, in place of the one in the package.
source = (Path(segments.__file__).parent / "table.py").read_text()
last = "    @property\\n    def duration_s(self) -> float:"
assert source.count(last) == 1
field = """    effort: Annotated[
        float, Column("how hard it was", unit="W", least=0, optional=True)
    ] = math.nan

"""
table = types.ModuleType("kineme.segments.table")
sys.modules["kineme.segments.table"] = segments.table = table
exec(compile(source.replace(last, field + last), "table.py", "exec"), table.__dict__)

from kineme.labels import read_segments, write_segments
from kineme.library.storage.tables import DESCRIBED
from kineme.segments import editing
from kineme.segments.segmentation import Segmentation
from kineme.web.page_data import make_segments_message
from kineme.web.encoding import to_json

folder, pages, docs = map(Path, sys.argv[1:])
columns = {"level": ["activity"] * 2, "kind": ["activity"] * 2, "start_frame": [0, 4],
           "stop_frame": [4, 9], "effort": [0.5, 2]}
made = Segmentation.from_columns(columns, n_frames=9, fps=30)
read = {}
for name in ("made.csv", "made.json", "made.parquet"):
    write_segments(made, folder / name)
    assert read_segments(folder / name) == made
    read[name] = read_segments(folder / name).table.effort.tolist()
filling = runpy.run_path(str(docs / "fill_pages.py"))
schema = filling["json_schema"]()["properties"]["segments"]["items"]
print(json.dumps({
    "read": read,
    "csv": (folder / "made.csv").read_text().splitlines()[:2],
    "json": json.loads((folder / "made.json").read_text())["segments"][1]["effort"],
    "frame": made.to_dataframe().effort.tolist(),
    "row": made.table[1].effort,
    "renamed": editing.name_segment(made, "activity", 4, "hop").table.effort.tolist(),
    "schema": [schema["properties"]["effort"], "effort" in schema["required"]],
    "message": json.loads(to_json(make_segments_message(made)))["segments"][1]["effort"],
    "types": runpy.run_path(str(pages / "make_messages.py"))["format_messages"](),
    "docs": filling["columns_table"](),
    "library": "effort" in DESCRIBED["segments"],
}))
'''
ROOT = Path(__file__).parents[2]


def test_a_column_more_is_one_field_more(tmp_path: Path) -> None:
    pages = ROOT / "src" / "kineme" / "web" / "pages"
    places = [tmp_path, pages, ROOT / "docs"]
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", ONE_MORE, *map(str, places)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["read"] == {f"made{suffix}": [0.5, 2.0] for suffix in (".csv", ".json", ".parquet")}
    assert told["csv"][0].endswith(",effort")
    assert told["csv"][1].endswith(",0.5")
    assert told["json"] == told["row"] == told["message"] == 2.0
    assert told["frame"] == told["renamed"] == [0.5, 2.0]
    cell = {"description": "how hard it was", "type": ["number", "null"], "minimum": 0, "unit": "W"}
    assert told["schema"] == [cell, False]
    assert "  effort: number | null;\n" in told["types"]
    assert "  effort: null,\n" in told["types"]
    assert told["docs"].endswith("| `effort` | number, W | how hard it was |")
    assert told["library"]


def test_a_row_is_made_of_what_is_needed() -> None:
    row = Segment("activity", "activity", 0, 30, 0.0, 1.0)
    assert (row.cluster, row.label, row.duration_s) == (-1, "", 1.0)
    assert np.isnan(row.confidence)
    with pytest.raises(TypeError, match="stop_frame"):
        Segment("activity", "activity", 0, start_s=0.0, stop_s=1.0)  # type: ignore[call-arg]


def test_a_table_has_the_declared_columns_and_no_others() -> None:
    columns = {"level": ["activity"], "kind": ["activity"], "start_frame": [0], "stop_frame": [9]}
    table = Segmentation.from_columns({**columns, "colour": ["red"]}, n_frames=9, fps=30).table
    assert list(table.columns()) == list(COLUMNS)
    with pytest.raises(AttributeError, match="colour"):
        table.colour  # noqa: B018
    with pytest.raises(TypeError, match="colour"):
        SegmentTable(**table.columns(), colour=np.array(["red"]))
    named = table.with_columns(label=np.array(["hop"]))
    assert (named.label.tolist(), table.label.tolist()) == (["hop"], [""])


def test_kinds_are_those_of_the_levels() -> None:
    columns = {"level": ["activity", "primitive"], "start_frame": [0, 0], "stop_frame": [9, 9]}

    def kinds(*given: str) -> list[str]:
        made = Segmentation.from_columns({**columns, "kind": [*given]}, n_frames=9, fps=30)
        kinds: list[str] = made.table.kind.tolist()
        return kinds

    assert kinds("activity", "primitive") == ["activity", "primitive"]
    assert kinds("activity", "activity") == ["activity", "primitive"]  # as older tables say
    assert kinds("transition", "transition") == ["transition", "transition"]
    with pytest.raises(ParameterError, match="not a primitive"):
        kinds("primitive", "primitive")
