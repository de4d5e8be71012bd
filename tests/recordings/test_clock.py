"""A border at 60 s of 120 s stands there, whatever the clock and the container of the rows do."""

from __future__ import annotations

import re
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import kineme
from kineme import Signals, as_signals, join_signals
from kineme.cli.app import app
from kineme.errors import KinemeWarning, ParameterError
from kineme.recordings.arrays import mark_spans

BORDER, LENGTH = 60.0, 120.0
ACC, GYRO = ["acc_x", "acc_y", "acc_z"], ["gyro_x", "gyro_y", "gyro_z"]
ZONE = "Europe/Berlin"


def make_movement(times: np.ndarray, channels: list[str]) -> pd.DataFrame:
    """Quick and large swings until the border, then slow and small ones, at these seconds."""
    early = times < BORDER
    turn = np.where(early, 7.0, 3.0) * times
    size = np.where(early, 3.0, 1.0)
    shape = [np.sin(turn), np.cos(turn), np.sin(2 * turn)]
    level = np.where(early, 0.0, 4.0)
    rng = np.random.default_rng(len(channels[0]))
    noise = 0.05 * rng.standard_normal((3, len(times)))
    columns = [size * each + level + more for each, more in zip(shape, noise)]
    return pd.DataFrame(dict(zip(channels, columns)))


def make_rows(times: np.ndarray) -> tuple[pd.DataFrame, np.ndarray]:
    return make_movement(times, ACC), times


def merge_by_time() -> tuple[pd.DataFrame, np.ndarray]:
    acc_at = np.arange(0, LENGTH, 0.02)
    gyro_at = np.arange(0, LENGTH, 0.01) + 0.0034
    both = (
        make_movement(acc_at, ACC)
        .set_index(acc_at)
        .join(make_movement(gyro_at, GYRO).set_index(gyro_at), how="outer")
    )
    return both.reset_index(drop=True), both.index.to_numpy()


def lose_rows() -> tuple[pd.DataFrame, np.ndarray]:
    times = np.arange(0, LENGTH, 0.02)
    kept = np.random.default_rng(1).random(len(times)) > 0.1
    return make_rows(times[kept])


def make_local_times(begin: str) -> tuple[pd.DataFrame, pd.DatetimeIndex]:
    """Local times; the clock is changed 40 s after they begin."""
    frame, times = make_rows(np.arange(0, LENGTH, 0.02))
    zoned = pd.Timestamp(begin, tz=ZONE) + pd.to_timedelta(np.rint(times * 1e9).astype("i8"))
    return frame, zoned.tz_localize(None)


def shuffle_rows() -> tuple[pd.DataFrame, pd.DatetimeIndex]:
    frame, times = make_rows(np.arange(0, LENGTH, 0.02))
    stamps = pd.Timestamp("2026-05-01T09:30") + pd.to_timedelta(np.rint(times * 1e9).astype("i8"))
    order = np.random.default_rng(2).permutation(len(times))
    return frame.iloc[order].reset_index(drop=True), stamps[order]


def count_since_boot() -> tuple[pd.DataFrame, np.ndarray]:
    times = np.arange(0, LENGTH, 0.02)
    jitter = np.random.default_rng(3).integers(-900_000, 900_000, len(times))
    return make_movement(times, ACC), 83_512_004_123_456 + np.rint(times * 1e9).astype(
        "i8"
    ) + jitter


def leave_hole() -> tuple[pd.DataFrame, np.ndarray]:
    times = np.arange(0, LENGTH, 0.02)
    return make_rows(times[(times < 25) | (times >= 45)])


CASES = {
    "merged by time": merge_by_time,
    "a tenth lost": lose_rows,
    "spring": lambda: make_local_times("2026-03-29T01:59:20"),
    "autumn": lambda: make_local_times("2026-10-25T02:59:20+02:00"),
    "shuffled": shuffle_rows,
    "nanoseconds since boot": count_since_boot,
    "a hole of 20 s": leave_hole,
}


def as_csv(frame: pd.DataFrame, times, folder: Path) -> Signals:
    frame.assign(timestamp=times).to_csv(folder / "a.csv", index=False)
    return kineme.read(folder / "a.csv")


def as_parquet(frame: pd.DataFrame, times, folder: Path) -> Signals:
    frame.assign(timestamp=times).to_parquet(folder / "a.parquet", index=False)
    return kineme.read(folder / "a.parquet")


def as_frame(frame: pd.DataFrame, times, _: Path) -> Signals:
    return as_signals(frame.set_index(pd.Index(times, name="time")))


def as_xarray(frame: pd.DataFrame, times, _: Path) -> Signals:
    xr = pytest.importorskip("xarray")
    array = xr.DataArray(frame, dims=("time", "channel"))
    return as_signals(array.assign_coords(time=np.asarray(times)))


def as_array(frame: pd.DataFrame, times, _: Path) -> Signals:
    return as_signals(frame.to_numpy(), times=times)


CONTAINERS = [as_csv, as_parquet, as_frame, as_xarray, as_array]


@cache
def find_undisturbed_border() -> float:
    """Where the method puts the border in even rows: by its own grid, a quarter of a second off."""
    values = make_movement(np.arange(0, LENGTH, 0.02), ACC).to_numpy()
    found = kineme.segment(Signals(values, 50)).activities.start_s
    border: float = found[np.abs(found - BORDER).argmin()]
    assert abs(border - BORDER) < 0.3
    return border


def check_border(signals: Signals) -> None:
    """The values tell that the border is where the clock says, and so does the table."""
    assert signals.duration == pytest.approx(LENGTH, abs=0.1)
    true = make_movement(signals.times, list(signals.names[:3])).to_numpy()
    inside = np.abs(signals.times - BORDER) > 0.05
    inside &= ~mark_spans(signals.gaps, signals.n_frames)
    assert np.abs(signals.values[:, :3] - true)[inside].max() < 0.6  # noqa: PD011
    starts = kineme.segment(signals).activities.start_s
    assert np.abs(starts - find_undisturbed_border()).min() <= 0.1


@pytest.mark.parametrize("container", CONTAINERS)
@pytest.mark.parametrize("case", CASES)
def test_the_border_stands_where_the_clock_says(case, container, tmp_path) -> None:
    frame, times = CASES[case]()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        signals = container(frame, times, tmp_path)
    check_border(signals)
    assert signals.fps == (100 if case == "merged by time" else 50)
    assert signals.gaps == (((1250, 2250),) if case == "a hole of 20 s" else ())


@pytest.mark.parametrize(
    ("fps", "slower", "late"), [(50, 20, 0.003), (100, 10, 0.0), (50, 20, 0.0)]
)
def test_merged_sensors_have_the_rate_of_the_fastest(fps, slower, late) -> None:
    fast, slow = np.arange(0, 20, 1 / fps), np.arange(0, 20, 1 / slower) + late
    acc = make_movement(fast, ACC).set_index(fast.round(4))
    both = acc.join(make_movement(slow, GYRO).set_index(slow.round(4)), how="outer")
    signals = as_signals(both.reset_index(drop=True), times=both.index.to_numpy())
    assert signals.fps == fps
    assert np.allclose(signals.values[: len(fast), :3], acc)  # noqa: PD011


def write_two_clocks(folder: Path) -> tuple[Path, Path]:
    """An accelerometer in milliseconds since 1970 and a gyroscope at dates, begun 1.5 s later."""
    acc_at, gyro_at = np.arange(0, LENGTH, 0.02), np.arange(1.5034, LENGTH, 0.01)
    begin = pd.Timestamp("2026-05-01T09:30:00Z")
    acc = make_movement(acc_at, ACC).assign(time_ms=begin.value // 10**6 + np.rint(acc_at * 1e3))
    gyro_times = begin + pd.to_timedelta(np.rint(gyro_at * 1e9).astype("i8"))
    gyro = make_movement(gyro_at, GYRO).assign(time=gyro_times)
    acc.to_csv(folder / "acc.csv", index=False)
    gyro.to_csv(folder / "gyro.csv", index=False)
    return folder / "acc.csv", folder / "gyro.csv"


def test_two_files_with_two_clocks_are_one_recording(tmp_path) -> None:
    both = join_signals(*map(kineme.read, write_two_clocks(tmp_path)))
    assert (both.names, both.fps) == ((*ACC, *GYRO), 100)
    begun = both.provenance.clock.times[0] - pd.Timestamp("2026-05-01T09:30:00Z").timestamp()
    assert begun == pytest.approx(1.5034, abs=1e-3)
    true = make_movement(both.times + begun, ACC).to_numpy()
    inside = np.abs(both.times + begun - BORDER) > 0.05
    assert np.abs(both.values[:, :3] - true)[inside].max() < 0.6  # noqa: PD011
    found = kineme.segment(both).activities.start_s + begun
    assert np.abs(found - find_undisturbed_border()).min() <= 0.1


def test_the_command_joins_files_and_names_rows(tmp_path) -> None:
    paths = [*map(str, write_two_clocks(tmp_path))]
    out = tmp_path / "out.csv"
    found = CliRunner().invoke(app, ["segment", *paths, "--join", "--quiet", "-o", str(out)])
    assert (found.exit_code, out.is_file()) == (0, True)
    assert len(kineme.read_segments(out).activities) == 2
    frame, times = lose_rows()
    with pytest.warns(KinemeWarning, match="no common clock: assumed to begin together"):
        join_signals(as_signals(frame, times=times + 1.7e9), as_signals(frame, times=times))
    now, zone, days = (as_signals(frame, times=times + 1.7e9 - ago) for ago in (0, 7200, 3 * 86400))
    with pytest.warns(KinemeWarning, match=r"overlap \(7080 s apart\): assumed to begin together"):
        assert join_signals(now, zone).duration == now.duration
    with pytest.raises(ParameterError, match="do not overlap in time"):
        join_signals(now, days)
    with pytest.warns(KinemeWarning, match="s left out in which not all sensors recorded"):
        join_signals(as_signals(frame, times=times), as_signals(frame[:500], times=times[:500]))
    with pytest.raises(ParameterError, match="do not overlap in time"):
        join_signals(as_signals(frame, times=times), as_signals(frame, fps=50), offsets=[0, 900])
    table = kineme.segment(frame, times=times).to_dataframe()
    border = table[table.level == "activity"].start_row.to_numpy()[1]
    assert abs(times[border] - find_undisturbed_border()) <= 0.1


def test_frozen_and_saturated_channels_are_named() -> None:
    times = np.arange(0, LENGTH, 0.02)
    frame = make_movement(times, ACC)
    frame.loc[1000:2000, "acc_y"] = frame.acc_y[1000]
    loud = np.random.default_rng(0).standard_normal(len(times)).cumsum() % 7
    frame["acc_z"] = np.clip(9 * np.sin(5 * times) ** 7 + 0.01 * loud, -2, 2)
    with pytest.warns(KinemeWarning) as caught:
        as_signals(frame, fps=50)
    (said,) = caught
    assert "stay constant for a while: acc_y (20 s at 20 s)" in str(said.message)
    assert "clipped at their largest values: acc_z" in str(said.message)


@pytest.mark.parametrize("name", ["set", "reps", "weight", "label", "Set number", "frame"])
def test_columns_that_count_or_label_are_no_channels(name, tmp_path) -> None:
    frame = make_movement(np.arange(0, 2, 0.02), ACC).assign(**{name: 3})
    assert as_signals(frame, fps=50).names == tuple(ACC)
    frame.to_csv(tmp_path / "a.csv", index=False)
    assert kineme.read(tmp_path / "a.csv", fps=50).names == tuple(ACC)


def test_holes_in_arrays_are_filled_or_gaps() -> None:
    values = np.arange(200.0)
    values[[3, 4, *range(50, 90)]] = np.nan
    signals = as_signals(values, fps=50)
    assert signals.values[3:5, 0].tolist() == [3, 4]  # noqa: PD011
    assert signals.gaps == ((50, 90),)


@pytest.mark.parametrize("as_file", [False, True])
@pytest.mark.parametrize(
    ("present", "is_kept", "n_gaps", "said"),
    [
        ([], False, 0, None),
        ([10, 200, 480], False, 0, "without values most of the time are left out: gyro"),
        (range(300), True, 1, r"4 of 10 s are gaps, as single .*: gyro \(40%\); choose other col"),
        (range(450), True, 1, None),
    ],
)
def test_single_channels_hide_no_others(tmp_path, present, is_kept, n_gaps, said, as_file) -> None:
    frame = make_movement(np.arange(0, 10, 0.02), ACC).assign(gyro=np.nan)
    frame.loc[list(present), "gyro"] = 1.0 * np.array(present)
    frame.to_csv(tmp_path / "a.csv", index=False)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        read = kineme.read(tmp_path / "a.csv", fps=50) if as_file else as_signals(frame, fps=50)
    assert read.names == ((*ACC, "gyro") if is_kept else tuple(ACC))
    assert len(read.gaps) == n_gaps
    assert len(caught) == (said is not None)
    assert all(re.search(said, str(each.message)) for each in caught)


def test_a_pause_of_all_channels_is_no_fault_of_one() -> None:
    frame = make_movement(np.arange(0, 10, 0.02), ACC)
    frame.loc[100:400] = np.nan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert as_signals(frame, fps=50).gaps == ((100, 401),)


def test_recordings_are_given_one_at_a_time() -> None:
    signals = Signals(np.zeros((9, 1)), 50)
    for function in (kineme.segment, as_signals):
        with pytest.raises(ParameterError, match="list of recordings: give one at a time"):
            function([signals, signals])


@pytest.mark.parametrize("mark", [".", ","])
@pytest.mark.parametrize("times", [None, "time", "clock"])
def test_numbers_as_text_in_a_data_frame(mark, times) -> None:
    at = np.arange(400) / 100
    values = np.stack([at, np.sin(at), np.cos(at)], axis=1).round(3)
    frame = pd.DataFrame(values, columns=[times or "time", "acc_x", "acc_y"])
    texts = frame.astype(str).map(lambda cell: cell.replace(".", mark)).assign(side="left")
    texts.loc[7, "acc_x"] = None
    signals = as_signals(texts, times=times)
    assert (signals.fps, signals.names) == (100, ("acc_x", "acc_y"))
    np.testing.assert_allclose(signals.values[:, 1], values[:, 2])  # noqa: PD011
    assert ("numbers have a decimal comma" in signals.provenance.notes) == (mark == ",")
    with pytest.raises(ParameterError, match="times is 'then': give a time for each row, or the"):
        as_signals(frame, times="then")
