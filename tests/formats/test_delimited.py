"""Delimited text is parsed in the same way for joints, channels and dialects."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_capture_tables import to_nexus

import kineme

ROWS = [(i / 50, i * 0.25, 1.5 - i * 0.125, i * 0.5) for i in range(12)]


def join_rows(*head: str, separator: str = ",", comma: bool = False) -> str:
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
    separator, comma, above = LAYOUTS[layout]
    names = separator.join(["time", *(f"{joint}_{axis}" for axis in "xyz")])
    path = tmp_path / "a.csv"
    path.write_text(join_rows(*above, names, separator=separator, comma=comma), encoding=encoding)
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
    path.write_text(join_rows('time,"force, left",b,c'))
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
    path.write_text(to_nexus(), encoding=encoding)
    motion = kineme.read(path)
    assert motion.provenance.format == "Nexus table"
    assert "head" in motion.skeleton.names
