"""Tables of Vicon's Nexus, OptiTrack's Motive and Qualisys' QTM, valid and invalid."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from marker_samples import PLUG_IN_GAIT, make_walk, to_millimetres

import kineme
from kineme.errors import ReadError
from reading import read

POINTS = make_walk()
AXES = ",".join("XYZ" * len(PLUG_IN_GAIT))


def join_cells(*cells: object) -> str:
    return ",".join(map(str, cells)) + "\n"


def to_nexus(before: str = "", names: list[str] | None = None) -> str:
    """Millimetres, z up, frames from 101 on."""
    given = names or [f"Ann:{name}" for name in PLUG_IN_GAIT]
    head = f"{before}Trajectories\n100\n,,{',,,'.join(given)},,\nFrame,Sub Frame,{AXES}\n"
    millimetres = to_millimetres(POINTS).reshape(len(POINTS), -1)
    rows = [join_cells(101 + i, 0, *map(repr, line)) for i, line in enumerate(millimetres.tolist())]
    return head + join_cells("", "", *["mm"] * POINTS[0].size) + "".join(rows)


def to_motive(kinds: list[str] | None = None, *, told: bool = True) -> str:
    """Metres, y up; a rigid body with rotations before the markers."""
    kinds = kinds or ["Marker"] * len(PLUG_IN_GAIT)
    heads = [
        ["Type", *["Rigid Body"] * 7, *(kind for kind in kinds for _ in "XYZ")],
        ["Name", *["Wand"] * 7, *(f'"Ann:{name}"' for name in PLUG_IN_GAIT for _ in "XYZ")],
        ["", *["Rotation"] * 4, *["Position"] * (3 + POINTS[0].size)],
    ]
    values = POINTS.reshape(len(POINTS), -1).tolist()
    rows = [
        join_cells(i, i / 120, 0, 0, 0, 1, 5, 5, 5, *map(repr, v)) for i, v in enumerate(values)
    ]
    return (
        "Format Version,1.23,Take Name,Walk,Capture Frame Rate,240.0,Export Frame Rate,120.0,"
        "Length Units,Meters,Coordinate Space,Global\n\n"
        + "".join(join_cells("", cells[0] if told else "", *cells[1:]) for cells in heads)
        + f"Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,{AXES}\n"
        + "".join(rows)
    )


def to_qtm(points: np.ndarray = POINTS, *, titled: bool) -> str:
    """Millimetres, z up; ``titled`` adds a line of names, and columns of frame and time."""
    head = [
        f"NO_OF_FRAMES\t{len(points)}",
        f"NO_OF_CAMERAS\t8\nNO_OF_MARKERS\t{len(PLUG_IN_GAIT)}\nFREQUENCY\t100\nDESCRIPTION\t--",
        "TIME_STAMP\t2026-03-04, 10:20:33.123\t432.1\nDATA_INCLUDED\t3D",
        "EVENT\tstart\t10\t0.1\nEVENT\tstop\t20\t0.2",
        "\t".join(["MARKER_NAMES", *PLUG_IN_GAIT]),
    ]
    names = [f"{name} {axis}" for name in PLUG_IN_GAIT for axis in "XYZ"]
    head += ["\t".join(["Frame", "Time", *names])] * titled
    lines = [
        "\t".join(map(str, [*([i + 1, i / 100] * titled), *frame.ravel().tolist()]))
        for i, frame in enumerate(to_millimetres(points))
    ]
    return "\n".join([*head, *lines, ""])


@pytest.mark.parametrize(
    ("text", "fps", "program"),
    [
        (to_nexus(), 100, "Nexus"),
        (to_nexus("Devices\n1000\n,,EMG,\nFrame,Sub Frame,a\n,,V\n101,0,0.5\n\n"), 100, "Nexus"),
        (to_nexus() + "\nModel Outputs\n100\n,,Ann:CoM,,\nFrame,Sub Frame,X,Y,Z\n", 100, "Nexus"),
        (to_motive(), 120, "Motive"),
        (to_motive(told=False), 120, "Motive"),
        (to_motive(["Bone"] * len(PLUG_IN_GAIT)), 120, "Motive"),
        (to_qtm(titled=False), 100, "QTM"),
        (to_qtm(titled=True), 100, "QTM"),
    ],
    ids=["nexus", "devices", "model outputs", "motive", "older motive", "bones", "qtm", "titled"],
)
def test_markers_under_rows_of_names(tmp_path: Path, text: str, fps: float, program: str) -> None:
    motion = read(tmp_path, "a.csv", text)
    assert motion.fps == fps
    assert motion.provenance.format == f"{program} table"
    at = [motion.joint(name) for name in PLUG_IN_GAIT]
    assert np.allclose(motion.positions[:, at], POINTS, atol=1e-6)
    assert "Wand" not in motion.skeleton.names
    assert motion.joint("left_ankle") >= 0


def test_a_marker_of_qtm_at_the_origin_was_not_seen(tmp_path: Path) -> None:
    points = POINTS.copy()
    points[10:14, 0] = 0
    motion = read(tmp_path, "a.csv", to_qtm(points, titled=True))
    found = motion.positions[:, [motion.joint(name) for name in PLUG_IN_GAIT]]
    assert np.linalg.norm(found - POINTS, axis=-1).max() < 0.05


def test_markers_that_nobody_named_are_left_out(tmp_path: Path) -> None:
    names = [*(f"Ann:{name}" for name in PLUG_IN_GAIT[:-1]), "*12"]
    motion = read(tmp_path, "a.csv", to_nexus(names=names))
    assert PLUG_IN_GAIT[-1] not in motion.skeleton.names
    assert "1 point without a name left out" in motion.provenance.notes


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (
            to_nexus().replace("\n100\n", "\nfast\n"),
            r"'fast' is not a frame rate: give fps= \(--fps\)",
        ),
        (to_nexus().replace("mm", "m", 1), "line 5: markers are in m and mm: export all"),
        (to_nexus().replace("X,Y,Z", "A,B,C"), "line 4: no name found above the axes"),
        (to_motive().replace("Frame,Time", "Zeit"), "no line with 'Frame'"),
        (to_nexus().replace("101,0,", "101,"), "line 6: 55 cells, but 56 columns"),
    ],
)
def test_bad_tables(tmp_path: Path, text: str, reason: str) -> None:
    with pytest.raises(ReadError, match=reason):
        read(tmp_path, "a.csv", text)


def test_devices_alone_are_channels(tmp_path: Path) -> None:
    signals = read(tmp_path, "a.csv", to_nexus().replace("Trajectories", "Devices"), fps=100)
    assert isinstance(signals, kineme.Signals)


def test_channels_of_such_a_table_are_still_there(tmp_path: Path) -> None:
    signals = read(tmp_path, "a.csv", to_nexus(), fps=100, columns=["X"])
    assert isinstance(signals, kineme.Signals)


def test_motive_strays_hide_no_rigid_bodies(tmp_path: Path) -> None:
    columns = [("Rigid Body", name) for name in ("Hips", "Head")]
    columns += [("Marker", "Hips:Marker1"), ("Marker", "Stray")]
    head = ["Format Version,1.23,Export Frame Rate,60,Length Units,Meters", ""]
    for label, cells in (
        ("Type", [kind for kind, _ in columns]),
        ("Name", [name for _, name in columns]),
        ("", ["Position"] * 4),
    ):
        head.append(f",{label}," + ",".join(cell for cell in cells for _ in range(3)))
    head.append("Frame,Time (Seconds)," + ",".join(["X,Y,Z"] * 4))
    rows = [f"{i},{i / 60},0,0.9,0,0,1.6,0,0.1,0.9,0,,," for i in range(60)]
    motion = read(tmp_path, "a.csv", "\n".join([*head, *rows]))
    assert motion.skeleton.names == ("Hips", "Head")
