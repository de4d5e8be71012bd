"""Events of C3D files as labels; the files are written by ezc3d."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kineme.errors import ReadError, WriteError
from kineme.labels import read_segments, write_segments
from kineme.labels.c3d_events import read_events

ezc3d = pytest.importorskip("ezc3d")


def c3d(path: Path, events: list[tuple[float, str, str]], *, fps=100.0, frames=200) -> Path:
    """A file with one marker and these events: second, side, name."""
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [fps]
    file["parameters"]["POINT"]["LABELS"]["value"] = ["LASI"]
    points = np.ones((4, 1, frames))
    file["data"]["points"] = points
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
    found = read_segments(c3d(tmp_path / "gait.c3d", GAIT))
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
    path = c3d(tmp_path / "gait.c3d", GAIT)
    found = read_events(path, names=["Right Foot Strike"])
    assert found.cuts().tolist() == [20, 120]
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
    found = read_segments(c3d(folder / "events.c3d", events, fps=fps))
    named = [row for row in found.activities if row.label]
    assert {row.start_frame: row.label for row in named} == {f: f"event {f}" for f in frames}
    write_segments(found, folder / "events.eaf")
    again = read_segments(folder / "events.eaf")
    assert again.cuts().tolist() == found.cuts().tolist()
    assert again.activities.label.tolist() == found.activities.label.tolist()


def test_files_without_events_and_other_files(tmp_path) -> None:
    with pytest.raises(ReadError, match="has no events"):
        read_segments(c3d(tmp_path / "none.c3d", []))
    with pytest.raises(ReadError, match="has no events"):  # all of them after the end
        read_segments(c3d(tmp_path / "late.c3d", [(5.0, "", "late")]))
    found = read_segments(c3d(tmp_path / "gait.c3d", GAIT))
    with pytest.raises(WriteError, match="c3d is only read: segments go into .csv, .json"):
        write_segments(found, tmp_path / "new.c3d")


def test_events_of_real_files(data_dir) -> None:
    found = read_segments(data_dir / "formats" / "Eb015pi.c3d")
    assert [row.label for row in found.activities if row.label] == ["RIC", "RHS", "RTO"]
    assert found.cuts().tolist() == [136, 270, 366]
    assert found.n_frames == 450
