"""Delimited text is parsed in the same way for joints, channels and dialects."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_capture_tables import nexus

import kineme
from kineme.errors import KinemeWarning
from kineme.formats.dialects import DIALECTS, Dialect
from kineme.formats.files import FileContent
from kineme.formats.listing import scan_folder
from kineme.formats.sniffing import sniff

ROWS = [(i / 50, i * 0.25, 1.5 - i * 0.125, i * 0.5) for i in range(12)]


def text(*head: str, separator: str = ",", comma: bool = False) -> str:
    rows = [separator.join(map(str, row)) for row in ROWS]
    rows = [row.replace(".", ",") for row in rows] if comma else rows
    return "\n".join([*head, *rows, ""])


LAYOUTS = {
    "commas": (",", False, []),
    "tabs": ("\t", False, []),
    "blanks": (" ", False, []),
    "semicolons": (";", True, []),
    "sep": (";", False, ["sep=;"]),
    "logger": (",", False, ["Logger 3", "Date,2026-01-31"]),
    "comment": (",", False, ["# made by hand, twice"]),
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("joint", ["hüfte", "acc"])
def test_joints_and_channels_may_stand_in_the_same_layouts(
    tmp_path: Path, layout: str, encoding: str, joint: str
) -> None:
    separator, comma, above = LAYOUTS[layout]
    names = separator.join(["time", *(f"{joint}_{axis}" for axis in "xyz")])
    path = tmp_path / "a.csv"
    path.write_text(text(*above, names, separator=separator, comma=comma), encoding=encoding)
    found = kineme.read(path, **({} if joint == "acc" else {"unit": "m", "up": "y"}))
    expected = np.array(ROWS)[:, 1:]
    if isinstance(found, kineme.Signals):
        assert (joint, found.names) == ("acc", ("acc_x", "acc_y", "acc_z"))
        np.testing.assert_array_equal(found.values, expected)
    else:
        assert (joint, found.skeleton.names) == ("hüfte", ("hüfte",))
        np.testing.assert_allclose(found.positions[:, 0], expected)
    assert found.fps == 50


def test_a_separator_between_quotes_is_part_of_a_name(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text('time,"force, left",b,c'))
    signals = kineme.read(path)
    assert signals.names == ("force, left", "b", "c")
    kineme.write(signals, tmp_path / "b.tsv")
    assert kineme.read(tmp_path / "b.tsv").names == signals.names


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_keypoints_of_deeplabcut_may_stand_between_anything(tmp_path: Path, separator: str) -> None:
    head = ["scorer,net,net,net", "bodyparts,tail,tail,tail", "coords,x,y,likelihood"]
    rows = [f"{i},{i * 2.0},{100 - i},0.9" for i in range(12)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join([*head, *rows]).replace(",", separator))
    motion = kineme.read(path, fps=30)
    assert (motion.provenance.format, motion.skeleton.names) == ("DeepLabCut", ("tail",))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_capture_tables_may_be_saved_again_by_a_spreadsheet(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(nexus(), encoding=encoding)
    motion = kineme.read(path)
    assert motion.provenance.format == "Nexus table"
    assert "head" in motion.skeleton.names


def test_what_was_sniffed_is_there_to_look_at() -> None:
    content = FileContent(Path("a.csv"), text("Logger", "t;a;b;c", separator=";").encode())
    table = sniff(content)
    assert table.names == ["t", "a", "b", "c"]
    assert (table.head, table.first_row, table.separator) == (1, 2, ";")
    assert table.find_numeric_columns() == table.names
    assert table.remarks == ("1 line above the names skipped",)
    bare = sniff(FileContent(Path("a.csv"), text().encode()))
    assert bare.is_headless
    assert bare.number_columns().names == ["1", "2", "3", "4"]
    np.testing.assert_array_equal(bare.number_columns().numbers(), ROWS)


def test_a_dialect_that_cannot_tell_its_files_costs_itself_only(tmp_path: Path) -> None:
    def recognises(names, lines):
        raise KeyError(names[0])

    DIALECTS.register(Dialect("broken", recognises, lambda table, options: None))
    path = tmp_path / "a.csv"
    path.write_text(text("time,acc_x,acc_y,acc_z"))
    try:
        with pytest.warns(
            KinemeWarning, match="broken was skipped, since it failed to recognise files"
        ):
            assert kineme.read(path).n_frames == len(ROWS)
    finally:
        DIALECTS.remove("broken")


@pytest.mark.parametrize(
    "head",
    ["start_s;stop_s;label", "start_s\tstop_s\tlabel", "Observer,Ann\nstart_s,stop_s,label,n"],
)
def test_a_folder_passes_over_tables_of_spans_in_any_layout(tmp_path: Path, head: str) -> None:
    names = head.splitlines()[-1]
    separator = next(mark for mark in ";\t," if mark in names)
    row = separator.join(["0.5", "1.5", "walk", "3"][: names.count(separator) + 1])
    (tmp_path / "labels.csv").write_text(f"{head}\n{row}\n{row}\n{row}\n")
    (tmp_path / "take.csv").write_text(text("time,acc_x,acc_y,acc_z"))
    assert [path.name for path in scan_folder(tmp_path).recordings] == ["take.csv"]
