"""Segment tables as files: exact round trips, and clear words on bad files."""

from __future__ import annotations

import csv
import json
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pyarrow import parquet

import kineme
from kineme.datasets import bundled_truth
from kineme.errors import KinemeWarning, MissingDependencyError, ReadError, WriteError
from kineme.labels import read_segments, write_segments
from kineme.labels.csv_table import name_provenance
from kineme.labels.event_tables import name_sidecar
from kineme.segments import editing
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS
from segmentations import from_rows, make_activities, segmentations

SUFFIXES = (".csv", ".json", ".parquet")


@pytest.fixture
def small() -> Segmentation:
    rows = [
        ("activity", "activity", 0, 120, -1, "walk"),
        ("primitive", "primitive", 0, 50, 0, 'a "long", step'),
        ("primitive", "primitive", 50, 120, 0, ""),
    ]
    return from_rows(rows, fps=120.0, provenance={"preset": "voegele2014", "notes": ["é"]})


@given(segmentations())
def test_a_csv_alone_keeps_the_whole_table(folder: Path, result: Segmentation) -> None:
    path = folder / "alone.csv"
    write_segments(result, path)
    name_provenance(path).unlink()
    alone = read_segments(path)
    assert alone.n_frames == result.n_frames
    assert alone.fps == pytest.approx(result.fps, rel=1e-15)
    for name in set(COLUMNS) - {"confidence", "border_confidence", "start_s", "stop_s"}:
        assert alone.table.columns()[name].tolist() == result.table.columns()[name].tolist()
    assert "computed from frames and seconds" in alone.provenance["notes"][0]


def test_pandas_reads_csv_and_parquet_directly(tmp_path: Path, small: Segmentation) -> None:
    for suffix, reader in ((".csv", pd.read_csv), (".parquet", pd.read_parquet)):
        write_segments(small, tmp_path / f"cuts{suffix}")
        frame = reader(tmp_path / f"cuts{suffix}")
        assert tuple(frame.columns) == tuple(COLUMNS)
        assert frame.stop_frame.tolist() == [120, 50, 120]
        assert frame.stop_s.tolist() == [1.0, 50 / 120, 1.0]
        assert frame.label[1] == 'a "long", step'
        assert frame.confidence.isna().all()


def test_a_csv_that_went_through_pandas_is_still_read(tmp_path: Path, small: Segmentation) -> None:
    path = tmp_path / "cuts.csv"
    write_segments(small, path)
    frame = pd.read_csv(path)
    frame.loc[2, "label"] = "step"
    frame[frame.columns[::-1]].assign(mine=1).to_csv(path, index=False)
    edited = read_segments(path)
    assert edited.table.label.tolist() == ["walk", 'a "long", step', "step"]
    assert edited.provenance == small.provenance


@pytest.mark.parametrize("name", ["boris", "bids", "clips"])
@pytest.mark.parametrize("label", ["=HYPERLINK(1)", "'=x"])
def test_no_table_of_labels_holds_a_formula(tmp_path: Path, name: str, label: str) -> None:
    table = make_activities(9, label=[label], provenance={"input": {"path": "=cmd|x.bvh"}})
    path = tmp_path / f"labels{'.tsv' if name == 'bids' else '.csv'}"
    write_segments(table, path, format=name)
    mark = "\t" if name == "bids" else ","
    cells = [
        cell for row in csv.reader(path.read_text().splitlines(), delimiter=mark) for cell in row
    ]
    assert not [cell for cell in cells if cell.startswith(("=", "+", "-", "@"))]
    assert read_segments(path, format=name, fps=30).table.label.tolist() == [label]


def test_json_follows_its_documented_schema(tmp_path: Path, small: Segmentation) -> None:
    write_segments(small, tmp_path / "cuts.json")
    data = json.loads((tmp_path / "cuts.json").read_text())
    assert list(data) == ["schema", "n_frames", "fps", "provenance", "timings", "segments"]
    assert data["schema"] == "kineme.segments/2"
    assert data["segments"][1] == {
        "level": "primitive",
        "kind": "primitive",
        "start_frame": 0,
        "stop_frame": 50,
        "start_s": 0.0,
        "stop_s": 50 / 120,
        "cluster": 0,
        "activity": 0,
        "label": 'a "long", step',
        "confidence": None,
        "action": -1,
        "border_confidence": None,
    }


@given(st.from_regex(r"'{0,2}[-=+@\w]{0,3}", fullmatch=True))
def test_no_label_is_a_formula_and_each_is_read_again(folder: Path, label: str) -> None:
    table = make_activities(9, label=[label])
    write_segments(table, folder / "formula.csv")
    cell = (folder / "formula.csv").read_text(encoding="utf-8").splitlines()[1].split(",")[8]
    assert not cell.startswith(("=", "+", "-", "@"))
    assert read_segments(folder / "formula.csv") == table


@pytest.mark.parametrize("suffix", [".csv", ".json", ".parquet"])
def test_tables_without_the_optional_columns_are_read(
    tmp_path: Path, small: Segmentation, suffix: str
) -> None:
    path = tmp_path / f"cuts{suffix}"
    write_segments(small, path)
    optional = ["action", "border_confidence"]
    if suffix == ".json":
        data = json.loads(path.read_text())
        for row in data["segments"]:
            del row["action"], row["border_confidence"]
        path.write_text(json.dumps(data))
    elif suffix == ".csv":
        pd.read_csv(path).drop(columns=optional).to_csv(path, index=False)
    else:
        parquet.write_table(parquet.read_table(path).drop_columns(optional), path)
    assert read_segments(path) == small


def test_names_a_reader_does_not_know_are_ignored(tmp_path: Path, small: Segmentation) -> None:
    path = tmp_path / "cuts.json"
    write_segments(small, path)
    data = json.loads(path.read_text())
    data["colour"] = "blue"
    data["segments"][0]["colour"] = "blue"
    path.write_text(json.dumps(data))
    assert read_segments(path) == small


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("content", [b"", b"\0\xff\xfe" * 40, b"PAR1garbagePAR1", b"a,b\n1,2\n"])
def test_a_foreign_file_is_one_read_error(tmp_path: Path, suffix: str, content: bytes) -> None:
    path = tmp_path / f"foreign{suffix}"
    path.write_bytes(content)
    with pytest.raises(ReadError) as caught:
        read_segments(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("a.json", '"kineme.segments/2"', '"kineme.segments/3"', "reads .*: upgrade"),
        ("a.json", '"kineme.segments/2"', '"other/1"', "is not a segment table"),
        ("a.json", '"fps": 120.0', '"fps": "120"', '"fps" must be a positive number'),
        ("a.json", '"fps": 120.0', '"fps": 1e999', "a number that is not finite or is too large"),
        ("a.json", '"n_frames": 120', '"n_frames": 119', "must cover frames 0 to 119"),
        ("a.json", '"stop_frame": 50,', "", "segment 1 has no 'stop_frame'"),
        ("a.json", '"start_frame": 50', '"start_frame": 51', "segments of a level must touch"),
        ("a.json", '"cluster": 0', '"cluster": "0"', "'cluster' must hold whole numbers"),
        ("a.json", "  ]\n}", "", "line .*: is not valid JSON or is truncated"),
        ("a.csv", ",0,120", ",0,12o", "line 2: stop_frame must be a whole number, not '12o'"),
        ("a.csv", "confidence,", "points,", "it has no column 'confidence'"),
        ("a.csv", "primitive,50,120,", "primitive,50\n#", "line 4: the line ends before column"),
        ("a.csv", ",120,", ",121,", "at frame 121, but a.provenance.json states 120 frames"),
    ],
)
def test_a_spoilt_table_says_what_is_wrong(
    tmp_path: Path, small: Segmentation, name: str, old: str, new: str, message: str
) -> None:
    path = tmp_path / name
    write_segments(small, path)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(ReadError, match=message):
        read_segments(path)


def test_missing_file_and_unknown_suffix(tmp_path: Path, small: Segmentation) -> None:
    with pytest.raises(ReadError, match="No such file"):
        read_segments(tmp_path / "none.json")
    with pytest.raises(WriteError, match=r"stored as \.csv, \.json, .*, not '\.xlsx'"):
        write_segments(small, tmp_path / "cuts.xlsx")
    with pytest.raises(WriteError, match=r"the folder .* does not exist"):
        write_segments(small, tmp_path / "nowhere" / "cuts.csv")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_failed_write_leaves_the_old_file(
    tmp_path: Path, small: Segmentation, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / f"cuts{suffix}"
    write_segments(small, path)
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.replace", full)
    with pytest.raises(WriteError, match="No space left on device"):
        write_segments(small, path)
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_parquet_without_pyarrow_names_the_extra(
    tmp_path: Path, small: Segmentation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pyarrow", None)
    with pytest.raises(MissingDependencyError, match=r"pip install 'kineme\[tables\]'"):
        write_segments(small, tmp_path / "cuts.parquet")


def test_a_list_kept_by_hand_is_read(tmp_path: Path) -> None:
    path = tmp_path / "by_hand.csv"
    path.write_text("label,start_s,stop_s,by\nsquat,4,6.5,me\nwalk,0.5,4,me\n")
    found = read_segments(path, fps=10, n_frames=70)
    rows = [(row.kind, row.start_frame, row.stop_frame, row.label) for row in found]
    assert rows == [
        ("transition", 0, 5, ""),
        ("activity", 5, 40, "walk"),
        ("activity", 40, 65, "squat"),
        ("transition", 65, 70, ""),
    ]


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_comments_are_a_column_that_is_read_again(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"take{suffix}"
    table = read_segments(bundled_truth(), fps=60)
    write_segments(table, path)
    assert read_segments(path).annotation.comments == ()
    first = table.table[0]
    said = editing.comment(table, first.level, first.start_frame, "=slips, twice\nand falls")
    write_segments(said, path)
    assert editing.comments(read_segments(path)) == editing.comments(said)
    if suffix == ".csv":
        frame = pd.read_csv(path, keep_default_na=False)[::-1]  # rows in another order
        frame.to_csv(path, index=False)
        assert editing.comments(read_segments(path)) == editing.comments(said)
        frame.replace("and falls", "and stands", regex=True).to_csv(path, index=False)
        ((*_, now),) = editing.comments(read_segments(path))
        assert now == "=slips, twice\nand stands"


@pytest.mark.parametrize("separator", [";", "\t"])
def test_a_table_that_a_spreadsheet_saved_with_decimal_commas(
    tmp_path: Path, small: Segmentation, separator: str
) -> None:
    path = tmp_path / "cuts.csv"
    write_segments(small, path)
    name_provenance(path).unlink()
    frame = pd.read_csv(path)
    frame.to_csv(path, sep=separator, decimal=",", index=False, encoding="utf-8-sig")
    read = read_segments(path)
    assert (read.n_frames, read.fps) == (120, 120.0)
    assert read.table == small.table


def test_labels_between_semicolons(tmp_path: Path) -> None:
    path = tmp_path / "labels.csv"
    path.write_text("start_s;stop_s;label\n0;1,5;walk; slowly\n1,5;3;run\n", encoding="utf-8")
    found = read_segments(path, fps=10, n_frames=30)
    assert found.activities.stop_frame.tolist() == [15, 30]
    assert found.activities.label.tolist() == ["walk", "run"]
    path.write_text('start_s,stop_s,label\n0,"1,5",walk\n', encoding="utf-8")
    with pytest.raises(ReadError, match="stop_s must be a number, not '1,5'"):
        read_segments(path, fps=10)


Beside = Callable[[Path], Path]
in_two_files = pytest.mark.parametrize(
    ("name", "form", "beside"),
    [("a.csv", "csv", name_provenance), ("a.tsv", "bids", name_sidecar)],
)


def write_table(folder: Path, name: str, form: str, fps: float, label: str) -> Path:
    folder.mkdir()
    path = folder / name
    segments = make_activities(60, 120, fps=fps, label=[label, "squat"])
    kineme.write_segments(segments, path, format=form)
    return path


@in_two_files
def test_killed_between_the_two_renames(
    tmp_path: Path, name: str, form: str, beside: Beside
) -> None:
    old = write_table(tmp_path / "old", name, form, 120.0, "walk")
    new = write_table(tmp_path / "new", name, form, 60.0, "walk")
    assert kineme.read_segments(new, format=form).fps == 60.0
    shutil.copy(new, old)
    with pytest.raises(ReadError, match=r"is of 60 frames per second, but .* states 120"):
        kineme.read_segments(old, format=form)


@in_two_files
def test_edited_cuts_are_noted_but_not_edited_labels(
    tmp_path: Path, name: str, form: str, beside: Beside
) -> None:
    path = write_table(tmp_path / "a", name, form, 60.0, "walk")
    text = path.read_text()
    path.write_text(text.replace("walk", "jump"))
    edited = kineme.read_segments(path, format=form)
    assert edited.activities.label.tolist() == ["jump", "squat"]
    assert beside(path).name not in str(edited.provenance.get("notes", ""))
    path.write_text(text.replace("60", "61"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        moved = kineme.read_segments(path, format=form)
    assert any(f"does not match {beside(path).name}" in note for note in moved.provenance["notes"])
    assert moved.fps == 60.0
