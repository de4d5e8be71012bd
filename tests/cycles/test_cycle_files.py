"""Cycles in files are what they were, read by the programs that such files are for."""

from __future__ import annotations

import csv
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.io import loadmat

import kineme
from kineme.cycles import Cycles, write_cycles, write_table
from kineme.errors import MissingDependencyError, ParameterError, WriteError
from kineme.plot import plot_curves
from kineme.recordings import Signals
from kineme.recordings.operations import cut
from segmentations import one_activity


@pytest.fixture(scope="module")
def cycles(walks) -> Cycles:
    return kineme.cycles(walks.motion, walks.truth, channels=["knee_*"]).exclude([1])


def test_csv_has_the_cycles_with_summary_and_curves_beside(cycles, tmp_path: Path) -> None:
    write_cycles(cycles, tmp_path / "c.csv")
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["c.csv", "c.curves.csv", "c.summary.csv"]
    with (tmp_path / "c.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [*rows[0]] == [*cycles.columns]
    durations = [float(row["duration_s"]) for row in rows]
    assert durations == pytest.approx(cycles.columns["duration_s"].tolist())
    assert rows[1]["excluded"] == "by hand"
    assert rows[0]["confidence"] == ""


def test_a_csv_shows_no_rounding_errors(tmp_path: Path) -> None:
    frames = np.array([2.32 * 100, 1.32 - 0.18, 2 / 3])
    write_table({"frame": frames}, tmp_path / "c.csv")
    assert (tmp_path / "c.csv").read_text().split() == [
        "frame",
        "232.0",
        "1.14",
        "0.666666666666667",
    ]


def test_parquet_and_data_frames_are_equal(cycles, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    write_cycles(cycles, tmp_path / "c.parquet")
    read = pandas.read_parquet(tmp_path / "c.parquet")
    pandas.testing.assert_frame_equal(read, cycles.to_dataframe(), check_dtype=False)
    curves = pandas.read_parquet(tmp_path / "c.curves.parquet")
    assert curves["mean"].tolist() == cycles.mean_curves()["mean"].tolist()


def test_excel_reads_equal_sheets(cycles, tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    write_cycles(cycles, tmp_path / "c.xlsx")
    book = openpyxl.load_workbook(tmp_path / "c.xlsx")
    assert book.sheetnames == ["cycles", "summary", "curves", "provenance"]
    head, *rows = book["cycles"].iter_rows(values_only=True)
    assert [*head] == [*cycles.columns]
    for name, cells in zip(head, zip(*rows, strict=True), strict=True):
        column = cycles.columns[name]
        if column.dtype.kind == "f":
            values = [np.nan if cell is None else cell for cell in cells]
            np.testing.assert_allclose(np.array(values, float), column, rtol=1e-11)
        else:
            assert [cell if cell is not None else "" for cell in cells] == column.tolist()


def test_matlab_reads_equal_structs(cycles, tmp_path: Path) -> None:
    write_cycles(cycles, tmp_path / "c.mat")
    read = loadmat(tmp_path / "c.mat", simplify_cells=True)
    np.testing.assert_array_equal(read["curves"], cycles.curves)
    np.testing.assert_array_equal(read["cycles"]["knee_l_max"], cycles.columns["knee_l.max"])
    assert read["cycles"]["group"].tolist() == cycles.columns["group"].tolist()
    assert read["channels"].tolist() == ["knee_l", "knee_r"]
    assert json.loads(read["provenance"])["channels"]["knee_l"] == "LeftUpLeg, LeftLeg, LeftFoot"


def test_names_that_matlab_cannot_have_are_made_to_fit(walks, tmp_path: Path) -> None:
    long = "a" * 70
    values = np.random.default_rng(0).normal(size=(walks.motion.n_frames, 3))
    signals = Signals(values, 60.0, ["1°", f"{long}b", f"{long}c"])
    cycles = kineme.cycles(signals, walks.truth)
    cycles = replace(cycles, provenance={})
    write_cycles(cycles, tmp_path / "c.mat")
    names = loadmat(tmp_path / "c.mat", simplify_cells=True)["cycles"]
    assert len(names) == len(cycles.columns)
    assert all(len(name) <= 63 for name in names)


def test_netcdf_reads_equal_curves(cycles, tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    write_cycles(cycles, tmp_path / "c.nc")
    with xarray.open_dataset(tmp_path / "c.nc", engine="scipy") as read:
        np.testing.assert_array_equal(read["knee_r"].values, cycles.curves[:, 1])
        assert read["knee_r"].attrs["units"] == "°"
        assert read["group"].values.tolist() == cycles.columns["group"].tolist()
        mean = read["knee_l"].where(read["group"] == "squat").mean("cycle")
    assert mean.sizes == {"percent": 101}


def test_a_package_that_is_not_there_is_named(cycles, tmp_path: Path, monkeypatch) -> None:
    for package, suffix, extra in (("openpyxl", "xlsx", "excel"), ("xarray", "nc", "xarray")):
        monkeypatch.setitem(sys.modules, package, None)
        with pytest.raises(MissingDependencyError, match=rf"kineme\[{extra}\]"):
            write_cycles(cycles, tmp_path / f"c.{suffix}")
    assert not any(tmp_path.iterdir())


def test_other_suffixes_and_objects_are_refused(cycles, tmp_path: Path) -> None:
    with pytest.raises(WriteError, match=r"must end in \.csv, \.parquet, \.xlsx, \.mat, \.nc"):
        write_cycles(cycles, tmp_path / "c.doc")
    with pytest.raises(WriteError, match=r"\.csv or \.parquet"):
        write_table(cycles.columns, tmp_path / "c.xlsx")
    with pytest.raises(ParameterError, match="write_cycles takes"):
        write_cycles(cycles.columns, tmp_path / "c.csv")


def test_nothing_measured_is_written_as_tables_without_rows(walks, tmp_path: Path) -> None:
    short = cut(walks.motion, 0, 60)
    nothing = kineme.cycles(short, one_activity(60, 60.0), channels=["knee_l"])
    for suffix in ("csv", "mat"):
        write_cycles(nothing, tmp_path / f"c.{suffix}")
    assert (tmp_path / "c.csv").read_text().startswith("row,recording,")


def test_pictures_show_a_line_for_each_group(cycles) -> None:
    axes = plot_curves(cycles, "knee_l", ax=Figure().add_subplot())
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        "walk (n = 6)", "squat (n = 3)",
    ]  # fmt: skip
    assert axes.get_ylabel() == "knee_l (°)"
    with pytest.raises(ParameterError, match="no channel 'knee'"):
        plot_curves(cycles, "knee", ax=Figure().add_subplot())
