"""Delimited text is parsed in the same way for joints, channels and dialects."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_capture_tables import to_nexus

import kineme
from kineme.formats.channels.writing import write_signals

ROWS = [(i / 50, i * 0.25, 1.5 - i * 0.125, i * 0.5) for i in range(12)]


def join_rows(*head: str, separator: str = ",", comma: bool = False) -> str:
    rows = [separator.join(map(str, row)) for row in ROWS]
    rows = [row.replace(".", ",") for row in rows] if comma else rows
    return "\n".join([*head, *rows, ""])


COMMAS = ("numbers have a decimal comma",)
SKIPPED = ("2 lines above the names skipped",)
WORDS = ("line 2 has no numbers and was skipped: s;m;m;m",)
LAYOUTS = {
    "commas": (",", False, ["{}"], ()),
    "tabs": ("\t", False, ["{}"], ()),
    "tabs and decimal commas": ("\t", True, ["{}"], COMMAS),
    "blanks": (" ", False, ["{}"], ()),
    "blank lines": (",", False, ["{}"], ()),
    "semicolons": (";", True, ["{}"], COMMAS),
    "sep": (";", False, ["sep=;", "{}"], ()),
    "logger": (",", False, ["Logger 3", "Date,2026-01-31", "", "{}"], SKIPPED),
    "padded logger": (";", False, ["Device;X 5;", "Rate;50;", "", "{}"], SKIPPED),
    "comment": (",", False, ["# made by hand, twice", "{}"], ()),
    "units": (";", False, ["{}", "s;m;m;m"], WORDS),
}
"""Separator, decimal comma, lines above the rows, of which ``{}`` is that of names, and notes."""


@pytest.mark.parametrize("name", ["device", "note"])
def test_a_quote_without_an_end_is_named_with_its_line(tmp_path: Path, name: str) -> None:
    rows = [f"{i / 50},a,{i % 7}\n" for i in range(20000)]
    rows[30] = '0.6,"b,3\n'
    path = tmp_path / "a.csv"
    path.write_text(f"time,{name},acc_x\n{''.join(rows)}")
    with pytest.raises(kineme.errors.ReadError, match=r"line \d+: "):
        kineme.read(path)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("joint", ["hüfte", "acc"])
def test_joints_and_channels_may_stand_in_the_same_layouts(
    tmp_path: Path, layout: str, encoding: str, joint: str
) -> None:
    separator, comma, head, notes = LAYOUTS[layout]
    names = separator.join(["time", *(f"{joint}_{axis}" for axis in "xyz")])
    head = [line.format(names) for line in head]
    path = tmp_path / "a.csv"
    text = join_rows(*head, separator=separator, comma=comma)
    text = text.replace("\n", "\n\n") if layout == "blank lines" else text
    line_end = "\r\n" if layout == "sep" else "\n"  # spreadsheets write both
    path.write_text(text, encoding=encoding, newline=line_end)
    found = kineme.read(path, **({} if joint == "acc" else {"unit": "m", "up": "y"}))
    expected = np.array(ROWS)[:, 1:]
    assert found.fps == 50
    assert {*notes} <= {*found.provenance.notes}
    if not isinstance(found, kineme.Signals):
        assert (joint, found.skeleton.names) == ("hüfte", ("hüfte",))
        np.testing.assert_allclose(found.positions[:, 0], expected)
        return
    assert (joint, found.names) == ("acc", ("acc_x", "acc_y", "acc_z"))
    assert found.provenance.notes == notes
    np.testing.assert_array_equal(found.values, expected)
    kineme.write(found[2:6], tmp_path / "clip.csv")
    np.testing.assert_array_equal(kineme.read(tmp_path / "clip.csv").values, expected[2:6])
    write_signals(found, tmp_path / "all.tsv", columns=["acc_y"])
    np.testing.assert_array_equal(kineme.read(tmp_path / "all.tsv").values, expected[:, 1:2])


def test_a_separator_between_quotes_is_part_of_a_name(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(join_rows('time,"force, left",b,c'))
    signals = kineme.read(path)
    assert signals.names == ("force, left", "b", "c")
    kineme.write(signals, tmp_path / "b.tsv")
    assert kineme.read(tmp_path / "b.tsv").names == signals.names


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_capture_tables_may_be_saved_again_by_a_spreadsheet(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(to_nexus(), encoding=encoding)
    motion = kineme.read(path)
    assert motion.provenance.format == "Nexus table"
    assert "head" in motion.skeleton.names
