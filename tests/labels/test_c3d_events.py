"""Events of C3D files as labels, and written into a copy that other programs read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import kineme
from kineme.cli.app import app
from kineme.cycles import foot_events
from kineme.datasets import Action, synthesize
from kineme.errors import ParameterError, ReadError, WriteError
from kineme.formats.files import FileContent, load
from kineme.formats.markers.c3d_file import BLOCK, MIPS, Layout, parse_c3d
from kineme.labels import read_segments, write_segments
from kineme.labels.c3d_events import read_events, write_events

ezc3d = pytest.importorskip("ezc3d")


def write_c3d(
    path: Path, events: list[tuple[float, str, str]], *, fps=100.0, markers=("LASI",), points=None
) -> Path:
    """A file with points (4, markers, frames) and these events: second, side, name."""
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [fps]
    file["parameters"]["POINT"]["LABELS"]["value"] = [*markers]
    file["data"]["points"] = np.ones((4, 1, 200)) if points is None else points
    if events:
        file.add_parameter("EVENT", "USED", [len(events)])
        times = np.array([[0.0, at] for at, _, _ in events]).T
        file.add_parameter("EVENT", "TIMES", times)
        file.add_parameter("EVENT", "CONTEXTS", [side for _, side, _ in events])
        file.add_parameter("EVENT", "LABELS", [name for _, _, name in events])
    file.write(str(path))
    return path


GAIT = [
    (0.2, "Right", "Foot Strike"),
    (0.7, "Left", "Foot Strike"),
    (0.85, "Right", "Foot Off"),
    (1.2, "Right", "Foot Strike"),
]


def test_each_event_lasts_until_the_next(tmp_path) -> None:
    found = read_segments(write_c3d(tmp_path / "gait.c3d", GAIT))
    rows = [(row.label or row.kind, row.start_frame, row.stop_frame) for row in found.activities]
    assert rows == [
        ("transition", 0, 20),
        ("Right Foot Strike", 20, 70),
        ("Left Foot Strike", 70, 85),
        ("Right Foot Off", 85, 120),
        ("Right Foot Strike", 120, 200),
    ]
    assert (found.n_frames, found.fps) == (200, 100)
    assert found.provenance["labels"]["format"] == "c3d"


def test_cycles_between_events_of_one_name(tmp_path) -> None:
    path = write_c3d(tmp_path / "gait.c3d", GAIT)
    found = read_events(path, names=["right foot  strike"])
    rows = [(row.label, row.start_frame, row.stop_frame) for row in found.activities]
    assert rows == [("", 0, 20), ("Right Foot Strike", 20, 120), ("", 120, 200)]
    with pytest.raises(ParameterError, match="names of events must be a list of texts, not 'Right"):
        read_events(path, names="Right Foot Strike")
    with pytest.raises(ReadError, match="has one event 'Right Foot Off', but a span needs two"):
        read_events(path, names=["Right Foot Off"])
    with pytest.raises(ReadError, match="no event 'Jump'; there are Left Foot Strike, Right"):
        read_events(path, names=["Jump"])


@given(
    st.sets(st.integers(0, 199), min_size=1, max_size=12),
    st.sampled_from([25.0, 59.94, 100.0, 119.88, 200.0]),
)
@settings(max_examples=25)
def test_events_come_at_their_frames_and_go_through_other_formats(
    tmp_path_factory, frames, fps
) -> None:
    folder = tmp_path_factory.getbasetemp()
    events = [(frame / fps, "", f"event {frame}") for frame in sorted(frames)]
    found = read_segments(write_c3d(folder / "events.c3d", events, fps=fps))
    named = [row for row in found.activities if row.label]
    assert {row.start_frame: row.label for row in named} == {f: f"event {f}" for f in frames}
    write_segments(found, folder / "events.eaf")
    again = read_segments(folder / "events.eaf")
    assert again.cuts().tolist() == found.cuts().tolist()
    assert again.activities.label.tolist() == found.activities.label.tolist()


def test_files_without_events_and_other_files(tmp_path) -> None:
    with pytest.raises(ReadError, match="has no events"):
        read_segments(write_c3d(tmp_path / "none.c3d", []))
    with pytest.raises(ReadError, match="has no events"):  # all of them after the end
        read_segments(write_c3d(tmp_path / "late.c3d", [(5.0, "", "late")]))
    found = read_segments(write_c3d(tmp_path / "gait.c3d", GAIT))
    with pytest.raises(WriteError, match="c3d can only be read: write segments to .csv, .json"):
        write_segments(found, tmp_path / "new.c3d")


def test_events_of_real_files(data_dir) -> None:
    found = read_segments(data_dir / "formats" / "Eb015pi.c3d")
    assert [row.label for row in found.activities if row.label] == ["RIC", "RHS", "RTO"]
    assert found.cuts().tolist() == [136, 270, 366]
    assert found.n_frames == 450


TIMES = [0.1, 0.31234, 0.75, 1.1]
NAMES = ["left foot strike", "right foot off", "Jump", "Right Foot Strike"]
WRITTEN = ["Left Foot Strike", "Right Foot Off", "Jump", "Right Foot Strike"]
FILES = ["Dec_real.c3d", "Eb015pi.c3d", "Eb015pr.c3d", "Eb015si.c3d", "sample_propulsion.c3d",
         "walkingOptiTrack.c3d"]  # fmt: skip


def read_layout(path: Path) -> Layout:
    return Layout(load(path))


def read_other_parameters(path: Path) -> dict[tuple[str, str], object]:
    """Return the parameters of a file without those that writing changes."""
    parameters = parse_c3d(load(path)).parameters
    kept = [
        place for place in parameters.places if place[0] != "EVENT" and place[1] != "DATA_START"
    ]
    return {place: parameters.stored(*place) for place in kept}


@pytest.mark.parametrize("name", FILES)
def test_a_copy_has_the_events_and_all_else_of_its_source(data_dir, tmp_path, name: str) -> None:
    source, copy = data_dir / "formats" / name, tmp_path / "copy.c3d"
    before = parse_c3d(load(source))
    assert write_events(source, copy, TIMES, NAMES) == len(NAMES)
    after = parse_c3d(load(copy))
    np.testing.assert_array_equal(after.points, before.points)
    np.testing.assert_array_equal(after.analog, before.analog)
    expected = sorted([*before.events, *zip(TIMES, WRITTEN, strict=True)])
    assert [name for _, name in after.events] == [name for _, name in expected]
    np.testing.assert_allclose(
        [at for at, _ in after.events], [at for at, _ in expected], atol=1e-5
    )
    assert read_other_parameters(copy) == read_other_parameters(source)
    old, new = read_layout(source), read_layout(copy)
    grown = new.start - old.start
    assert grown >= 0
    assert grown % BLOCK == 0
    assert new.content.data[new.start :] == old.content.data[old.start :]
    first, second = (bytearray(each.content.data[:BLOCK]) for each in (old, new))
    first[16:18] = second[16:18] = b""  # the pointer to the data
    assert first == second
    if old.parameters.processor != MIPS:  # which ezc3d does not read
        theirs = ezc3d.c3d(str(copy))
        ours, known = theirs["parameters"]["EVENT"], ezc3d.c3d(str(source))
        assert ours["USED"]["value"][0] == len(expected)
        assert [each for each in ours["LABELS"]["value"] if each in ("Foot Off", "Jump")] == [
            "Foot Off", "Jump"]  # fmt: skip
        minutes, seconds = ours["TIMES"]["value"]
        skipped = (before.first_frame - 1) / before.rate
        for at in TIMES:
            assert np.abs(60 * minutes + seconds - skipped - at).min() < 1e-5
        np.testing.assert_array_equal(theirs["data"]["points"], known["data"]["points"])
        np.testing.assert_array_equal(theirs["data"]["analogs"], known["data"]["analogs"])
        start = theirs["parameters"]["POINT"]["DATA_START"]["value"][0]
        assert start in (0, 1 + new.start // BLOCK)  # 0: the file has none


@given(st.lists(st.tuples(st.floats(0, 1.99), st.sampled_from(NAMES)), max_size=60), st.booleans())
@settings(max_examples=25)
def test_writing_twice_adds_nothing(tmp_path_factory, events, marked: bool) -> None:
    folder = tmp_path_factory.getbasetemp()
    source = write_c3d(folder / "source.c3d", GAIT if marked else [])
    times, names = [at for at, _ in events], [name for _, name in events]
    added = write_events(source, folder / "once.c3d", times, names)
    assert len(parse_c3d(load(folder / "once.c3d")).events) == added + len(GAIT) * marked
    assert write_events(folder / "once.c3d", folder / "twice.c3d", times, names) == 0
    assert (folder / "twice.c3d").read_bytes() == (folder / "once.c3d").read_bytes()


def test_what_people_marked_stands(tmp_path: Path) -> None:
    source, copy = write_c3d(tmp_path / "gait.c3d", GAIT), tmp_path / "copy.c3d"
    added = write_events(source, copy, [0.21, 0.25, 1.6], ["right foot strike", "jump", "jump"])
    assert added == 2
    events = parse_c3d(load(copy)).events
    assert sum(name == "Right Foot Strike" for _, name in events) == 2
    parameters = ezc3d.c3d(str(copy))["parameters"]["EVENT"]
    assert parameters["CONTEXTS"]["value"] == ["Right", "Left", "Right", "Right", "", ""]
    assert len(parameters["ICON_IDS"]["value"]) == 6


def test_what_cannot_be_written_is_said(tmp_path: Path) -> None:
    source = write_c3d(tmp_path / "gait.c3d", GAIT)
    before = source.read_bytes()
    with pytest.raises(WriteError, match="is the recording itself: name another file"):
        write_events(source, source, TIMES, NAMES)
    with pytest.raises(WriteError, match=r"must end in \.c3d"):
        write_events(source, tmp_path / "copy.csv", TIMES, NAMES)
    with pytest.raises(WriteError, match="cannot take 304 events: a C3D file holds 255 at most"):
        write_events(source, tmp_path / "copy.c3d", [0.001 * i for i in range(300)], ["hop"] * 300)
    with pytest.raises(ParameterError, match="no time 99 s in the recording, which lasts 2 s"):
        write_events(source, tmp_path / "copy.c3d", [99.0], ["hop"])
    with pytest.raises(ParameterError, match="1 times, but 2 names"):
        write_events(source, tmp_path / "copy.c3d", [0.5], ["hop", "hop"])
    with pytest.raises(ReadError, match="is not a C3D file: events can only"):
        write_events(tmp_path / "walk.bvh", tmp_path / "copy.c3d", TIMES, NAMES)
    (tmp_path / "text.c3d").write_text("no recording")
    with pytest.raises(ReadError):
        write_events(tmp_path / "missing.c3d", tmp_path / "text.c3d", TIMES, NAMES)
    with pytest.raises(ReadError):
        write_events(tmp_path / "text.c3d", tmp_path / "copy.c3d", TIMES, NAMES)
    assert source.read_bytes() == before
    assert not (tmp_path / "copy.c3d").exists()


@example(1049, 0)  # the record of labels is lost
@given(st.integers(1, 3000), st.integers(0, 255))
@settings(max_examples=60)
def test_a_damaged_file_is_refused_or_read_as_before(tmp_path_factory, place, value) -> None:
    folder = tmp_path_factory.getbasetemp()
    data = bytearray(write_c3d(folder / "sound.c3d", GAIT).read_bytes())
    data[place] = value
    source, copy = folder / "odd.c3d", folder / "copy.c3d"
    source.write_bytes(data)
    try:
        before = parse_c3d(FileContent(source, bytes(data)))
        write_events(source, copy, [1.5], ["Jump"])
    except (kineme.errors.KinemeError, ValueError, OverflowError):
        return
    after = parse_c3d(load(copy))
    np.testing.assert_array_equal(after.points, before.points)
    assert len(after.events) == len(before.events) + 1


def test_the_command_writes_them(tmp_path: Path) -> None:
    walk = synthesize([Action("walk", 4)], fps=100, seed=1).motion
    names = {"LeftFoot": "LHEE", "LeftToeBase": "LTOE", "RightFoot": "RHEE", "RightToeBase": "RTOE",
             "LeftUpLeg": "LASI", "RightUpLeg": "RASI", "Head": "HEAD"}  # fmt: skip
    joints = [walk.skeleton.names.index(name) for name in names]
    points = 1000 * walk.positions[:, joints][..., [2, 0, 1]].transpose(2, 1, 0)
    points = np.concatenate([points, np.ones((1, *points.shape[1:]))])
    source, copy = tmp_path / "walk.c3d", tmp_path / "copy.c3d"
    write_c3d(source, [], markers=names.values(), points=points)
    done = CliRunner().invoke(app, ["events", str(source), "--c3d", str(copy)])
    assert done.exit_code == 0, done.output
    assert "copy.c3d" in done.output
    again = CliRunner().invoke(app, ["events", str(copy), "--c3d", str(tmp_path / "again.c3d")])
    assert "0 events added" in again.output
    events = foot_events(kineme.read(source))
    found = parse_c3d(load(copy)).events
    np.testing.assert_allclose([at for at, _ in found], events.times, atol=1e-5)
    assert sorted(name.lower() for _, name in found) == sorted(events.names.tolist())
    timed = ["events", str(source), "--fps", "50", "--c3d", str(copy)]
    assert CliRunner().invoke(app, timed).exit_code == 2
