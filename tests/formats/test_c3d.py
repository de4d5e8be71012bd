"""C3D files: every encoding, corner cases, and real recordings."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from marker_samples import DEC, INTEL, MIPS, PLUG_IN_GAIT, make_walk, to_c3d, to_millimetres
from typer.testing import CliRunner

import kineme
from growth import measure_peak
from kineme.cli.app import app
from kineme.cycles import landmarks
from kineme.errors import KinemeWarning, ReadError, SeveralPeopleError
from kineme.features import pose_features
from kineme.formats.files import FileContent, load
from kineme.formats.markers.c3d_file import parse_c3d
from kineme.formats.options import choose_person
from kineme.labels.c3d_events import write_events
from kineme.studio.loading import LoadedRecording, RecordingCache
from kineme.studio.storage.sidecars import ListedRecording
from reading import read

REAL = ["Dec_real", "Eb015pi", "Eb015pr", "Eb015si", "sample_propulsion", "walkingOptiTrack"]
POINTS = to_millimetres(make_walk())


def parse(data: bytes):
    return parse_c3d(FileContent(Path("a.c3d"), data))


@pytest.mark.parametrize("processor", [INTEL, DEC, MIPS])
@pytest.mark.parametrize("real", [True, False])
def test_every_encoding_holds_the_same(tmp_path: Path, processor: int, real: bool) -> None:
    analog = np.arange(60 * 4 * 2, dtype=float).reshape(60, 4, 2)
    scales = {("ANALOG", "SCALE"): np.float32([2, 3]), ("ANALOG", "GEN_SCALE"): np.float32([0.5])}
    scales |= {("ANALOG", "OFFSET"): np.int16([-1, 100])}
    data = to_c3d(POINTS, PLUG_IN_GAIT, processor=processor, real=real, analog=analog, more=scales)
    file = parse(data)
    assert file.labels == PLUG_IN_GAIT
    assert np.abs(file.points - POINTS).max() <= (1e-3 if real else 0.05 + 1e-9)
    assert (file.analog_rate, file.analog_labels) == (400.0, ["emg0", "emg1"])
    assert np.allclose(file.analog, (analog.reshape(-1, 2) - [-1, 100]) * [1, 1.5])
    motion = read(tmp_path, "take.c3d", data)
    assert motion.fps == 100.0
    assert np.allclose(
        motion.positions[:, motion.joint("C7")], make_walk()[:, PLUG_IN_GAIT.index("C7")], atol=1e-4
    )


def test_the_body_of_plug_in_gait(tmp_path: Path) -> None:
    motion = read(tmp_path, "take.c3d", to_c3d(POINTS, [f"Ann:{name}" for name in PLUG_IN_GAIT]))
    at = dict(zip(motion.skeleton.names, motion.positions[0], strict=True))
    assert np.allclose(at["pelvis"], (0, 1, 0), atol=1e-4)
    assert np.allclose(at["left_wrist"], (0.3, 0.9, 0), atol=1e-4)
    assert np.allclose(at["head"], (0, 1.65, 0), atol=1e-4)
    ankle = motion.joint("left_ankle")
    assert motion.skeleton.names[motion.skeleton.parents[ankle]] == "left_hip"
    features = pose_features(motion).reshape(-1, 5, 3)
    assert (features[:, 0, 0] > 0.05).all()  # the left ankle is on the left
    assert np.allclose(features[:, 2, 1], 0.65, atol=1e-4)  # the head above the pelvis


def test_wrong_and_saturated_counts(tmp_path: Path) -> None:
    still = np.tile(to_millimetres(make_walk(1)[:, :4]), (66_000, 1, 1))
    labels = PLUG_IN_GAIT[:4]
    saturated = to_c3d(still, labels)
    ends = {("TRIAL", "ACTUAL_START_FIELD"): np.int16([1, 0])}
    ends |= {("TRIAL", "ACTUAL_END_FIELD"): np.array([66_000 - 65_536, 1], np.int16)}
    assert len(parse(saturated).points) == 65_535
    assert len(parse(to_c3d(still, labels, more=ends)).points) == 66_000
    as_float = {("POINT", "FRAMES"): np.float32([66_000])}
    assert len(parse(to_c3d(still, labels, more=as_float)).points) == 66_000


def miscount(header: int, used: int) -> bytes:
    """A file with eight points, of which header and parameters state another number."""
    points = 100 * np.arange(1, 9)[:, None] + np.tile(np.arange(3.0), (40, 1, 1))
    labels, more = [f"M{i}" for i in range(8)], {("POINT", "USED"): np.int16([used])}
    data = bytearray(to_c3d(points, labels, more=more))
    data[2:4] = header.to_bytes(2, "little")
    return bytes(data)


@pytest.mark.parametrize(("header", "used"), [(8, 7), (7, 8), (8, 12), (12, 8)])
def test_the_count_that_fits_the_file_is_taken_and_said(tmp_path, header, used) -> None:
    with pytest.warns(KinemeWarning, match=f"the header counts {header} points .* parameters"):
        motion = read(tmp_path, "take.c3d", miscount(header, used))
    plain = read(tmp_path, "take.c3d", miscount(8, 8))
    np.testing.assert_array_equal(motion.positions, plain.positions)


def test_where_no_count_fits_the_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="17 points .* parameters 18 .* neither fits"):
        read(tmp_path, "take.c3d", miscount(17, 18))


def test_more_than_255_labels() -> None:
    labels = [f"m{i}" for i in range(300)]
    file = parse(to_c3d(np.ones((3, 300, 3)), labels))
    assert file.labels == labels


def test_events_count_from_the_first_frame(tmp_path: Path) -> None:
    events = {
        ("EVENT", "USED"): np.int16([2]),
        ("EVENT", "CONTEXTS"): ["Left", "Right"],
        ("EVENT", "LABELS"): ["Foot Strike", "Foot Off"],
        ("EVENT", "TIMES"): np.float32([[1, 0.75], [0, 2.5]]),
    }
    motion = read(tmp_path, "take.c3d", to_c3d(POINTS, PLUG_IN_GAIT, first=201, more=events))
    assert motion.provenance.events == ((0.5, "Right Foot Off"), (58.75, "Left Foot Strike"))
    assert "the first frame is frame 201 of the capture" in motion.provenance.notes


def test_the_note_of_events_names_ten(tmp_path: Path) -> None:
    events = {
        ("EVENT", "USED"): np.int16([12]),
        ("EVENT", "CONTEXTS"): ["Left"] * 12,
        ("EVENT", "LABELS"): ["Foot Strike"] * 12,
        ("EVENT", "TIMES"): np.float32([[0, 0.1 * number] for number in range(12)]),
    }
    motion = read(tmp_path, "take.c3d", to_c3d(POINTS, PLUG_IN_GAIT, more=events))
    (note,) = (each for each in map(str, motion.provenance.notes) if each.startswith("events: "))
    assert note.count(" at ") == 10
    assert note.endswith("at 0.90 s and 2 more")


def test_modelled_and_nameless_points_are_left_out(tmp_path: Path) -> None:
    labels = [*PLUG_IN_GAIT, "LKneeAngles", "*12", "C_101", "Unlabeled 7", "C7b"]
    points = np.concatenate([POINTS, np.full((60, 5, 3), 90.0)], axis=1)
    more = {("POINT", "ANGLES"): ["LKneeAngles"]}
    names = read(tmp_path, "take.c3d", to_c3d(points, labels, more=more)).skeleton.names
    assert {"C7", "C7b"} <= set(names)
    assert not {"LKneeAngles", "*12", "C_101", "Unlabeled 7"} & set(names)


def test_contacts_on_force_plates_count_frames_of_points(tmp_path: Path) -> None:
    force = np.zeros((600, 2))
    force[200:300, 0], force[250:450, 1] = -700, -700
    data = to_c3d(POINTS, PLUG_IN_GAIT, real=True, analog=force.reshape(60, 10, 2))
    (tmp_path / "take.c3d").write_bytes(data)
    options = ["--columns", "*", "--left", "emg0", "--right", "emg1"]
    outputs = ["-o", str(tmp_path / "events.csv"), "--labels", str(tmp_path / "labels.csv")]
    done = CliRunner().invoke(app, ["events", str(tmp_path / "take.c3d"), *options, *outputs])
    assert done.exit_code == 0, done.output
    frames = np.loadtxt(tmp_path / "events.csv", delimiter=",", skiprows=1, usecols=1)
    assert frames == pytest.approx([20, 25, 30, 45], abs=0.2)
    assert kineme.read_segments(tmp_path / "labels.csv").n_frames == 60  # as the motion


def test_two_subjects(tmp_path: Path) -> None:
    labels = [f"{who}:{name}" for who in ("Ann", "Bob") for name in PLUG_IN_GAIT] + ["Box:top"]
    points = np.concatenate([POINTS, POINTS + 1000, POINTS[:, :1]], axis=1)
    with pytest.warns(KinemeWarning, match="2 subjects: the body used is that of 'Ann'"):
        motion = read(tmp_path, "take.c3d", to_c3d(points, labels))
    assert np.allclose(motion.positions[0, motion.joint("pelvis")], (0, 1, 0), atol=1e-4)
    assert "Box:top" in motion.skeleton.names
    assert not [name for name in motion.skeleton.names if name.startswith("Bob")]
    other = kineme.read(tmp_path / "take.c3d", person="Bob")
    assert np.allclose(other.positions[0, other.joint("pelvis")], (1, 2, -1), atol=1e-4)
    assert landmarks(other)["left_knee"] == other.joint("LKNE")
    assert "person Bob of 2" in other.provenance.notes
    for person in ("bob", "1"):
        assert kineme.read(tmp_path / "take.c3d", person=person).provenance.person == "Bob"
    with pytest.raises(SeveralPeopleError, match="no person 'Eve': choose from Ann, Bob"):
        kineme.read(tmp_path / "take.c3d", person="Eve")
    assert choose_person("take.c3d", ["Ann", "ANN"], "Ann") == "Ann"
    with pytest.raises(SeveralPeopleError, match="no person 'ann': choose from Ann, ANN"):
        choose_person("take.c3d", ["Ann", "ANN"], "ann")


def test_the_name_of_a_single_subject_is_checked(tmp_path: Path) -> None:
    data = to_c3d(POINTS, [f"Ann:{name}" for name in PLUG_IN_GAIT])
    assert read(tmp_path, "take.c3d", data, person="ann").provenance.person == "Ann"
    with pytest.raises(SeveralPeopleError, match="no person 'Bob': choose from Ann"):
        read(tmp_path, "take.c3d", data, person="Bob")


def test_events_of_two_subjects_stay_apart(tmp_path: Path) -> None:
    labels = [f"{who}:{name}" for who in ("Ann", "Bob") for name in PLUG_IN_GAIT]
    more = {
        ("SUBJECTS", "NAMES"): ["Ann", "Bob"],
        ("EVENT", "USED"): np.int16([2]),
        ("EVENT", "CONTEXTS"): ["Left", "General"],
        ("EVENT", "LABELS"): ["Foot Strike", "Start"],
        ("EVENT", "TIMES"): np.float32([[0, 0.2], [0, 0.1]]),
        ("EVENT", "SUBJECTS"): ["Ann", ""],
    }
    source, copy = tmp_path / "two.c3d", tmp_path / "copy.c3d"
    source.write_bytes(to_c3d(np.concatenate([POINTS, POINTS + 1000], axis=1), labels, more=more))
    strike = "left foot strike"
    assert write_events(source, copy, [0.21, 0.4], [strike, strike], subject="Bob") == 2
    read = {who: kineme.read(copy, person=who).provenance.events for who in ("Ann", "Bob")}
    ours, theirs = ([round(at, 2) for at, _ in read[who]] for who in ("Ann", "Bob"))
    assert (ours, theirs) == ([0.1, 0.2], [0.1, 0.21, 0.4])


def test_what_the_file_does_not_say_is_inferred_and_said(tmp_path: Path) -> None:
    bare = to_c3d(POINTS, PLUG_IN_GAIT, unit=None, y_screen=None)
    motion = read(tmp_path, "take.c3d", bare)
    assert np.allclose(motion.positions[0, motion.joint("pelvis")], (0, 1, 0), atol=1e-4)
    notes = " ".join(motion.provenance.notes)
    assert "unit mm inferred" in notes
    assert "up axis z inferred" in notes
    with pytest.raises(ReadError, match="no frame rate: give fps="):
        read(tmp_path, "take.c3d", to_c3d(POINTS, PLUG_IN_GAIT, rate=0.0))
    assert read(tmp_path, "take.c3d", to_c3d(POINTS, PLUG_IN_GAIT, rate=0.0), fps=50).fps == 50


def test_gaps(tmp_path: Path) -> None:
    points = POINTS.copy()
    c7, t10 = (PLUG_IN_GAIT.index(name) for name in ("C7", "T10"))
    points[10:30, c7] = np.nan  # 0.2 s: filled
    filled = read(tmp_path, "take.c3d", to_c3d(points, PLUG_IN_GAIT))
    wanted = make_walk()[:, c7]
    assert np.abs(filled.positions[:, filled.joint("C7")] - wanted).max() < 1e-4
    assert any("1 point, 20 positions in all" in note for note in filled.provenance.notes)
    points[10:31, t10] = np.nan  # longer: left out
    with pytest.warns(KinemeWarning, match=r"T10 \(frames 10 to 30\)"):
        assert "T10" not in read(tmp_path, "take.c3d", to_c3d(points, PLUG_IN_GAIT)).skeleton.names


def test_markers_without_gaps_make_the_body_where_they_can(tmp_path: Path) -> None:
    points = POINTS.copy()
    points[10:40, PLUG_IN_GAIT.index("LWRB")] = np.nan
    with pytest.warns(KinemeWarning, match="left out for gaps above 0.2 s: LWRB"):
        motion = read(tmp_path, "take.c3d", to_c3d(points, PLUG_IN_GAIT))
    assert motion.gaps == ()
    assert any("left wrist from LWRA, right wrist from RWRA" in n for n in motion.provenance.notes)


def test_a_body_seen_in_no_frame(tmp_path: Path) -> None:
    points = POINTS.copy()
    points[:30, PLUG_IN_GAIT.index("LANK")] = np.nan
    points[30:, PLUG_IN_GAIT.index("RANK")] = np.nan
    with pytest.raises(
        ReadError, match="the body is never complete: LANK, RANK are never seen together"
    ):
        read(tmp_path, "take.c3d", to_c3d(points, PLUG_IN_GAIT))


def test_a_point_at_the_origin_was_not_seen() -> None:
    points = POINTS.copy()
    points[5, 3] = 0.0
    file = parse(to_c3d(points, PLUG_IN_GAIT))
    assert np.argwhere(np.isnan(file.points[:, :, 0])).tolist() == [[5, 3]]


def test_truncated_and_wrong_files(tmp_path: Path) -> None:
    data = to_c3d(POINTS, PLUG_IN_GAIT)
    with pytest.warns(KinemeWarning, match="60 frames declared, 59 found and kept"):
        assert read(tmp_path, "take.c3d", data[:-10]).n_frames == 59
    with pytest.raises(ReadError, match="truncated"):
        parse(b"")
    for cut, reason in [
        (100, "truncated"),
        (600, "truncated|no points"),
        (1300, "less than one frame"),
    ]:
        with pytest.raises(ReadError, match=reason):
            read(tmp_path, "take.c3d", data[:cut])
    with pytest.raises(ReadError, match="processor type 7 is not Intel"):
        read(tmp_path, "take.c3d", data[:515] + b"\x07" + data[516:])


def test_memory_follows_the_file_and_not_what_it_declares() -> None:
    data = to_c3d(POINTS, PLUG_IN_GAIT, more={("POINT", "FRAMES"): np.float32([1e9])})
    assert len(parse(data).points) == 60
    assert measure_peak(lambda: parse(data)) < 20 * len(data)


@pytest.mark.parametrize("name", [name for name in REAL if name != "Eb015si"])
def test_real_files_hold_what_ezc3d_finds(data_dir: Path, name: str) -> None:
    ezc3d = pytest.importorskip("ezc3d")
    path = data_dir / "formats" / f"{name}.c3d"
    theirs, ours = ezc3d.c3d(os.fspath(path)), parse_c3d(load(path))
    points = theirs["data"]["points"][:3].transpose(2, 1, 0)
    assert ours.labels == theirs["parameters"]["POINT"]["LABELS"]["value"][: len(ours.labels)]
    assert np.array_equal(np.isnan(ours.points), np.isnan(points))
    assert np.nanmax(np.abs(ours.points - points)) <= 1e-6 * np.nanmax(np.abs(points))
    analog = theirs["data"]["analogs"][0].T
    if analog.size:
        assert np.allclose(ours.analog, analog, rtol=1e-5, atol=1e-6)
    assert ours.rate == pytest.approx(theirs["header"]["points"]["frame_rate"])


def test_the_same_take_in_three_encodings(data_dir: Path) -> None:
    intel, real, sgi = (
        parse_c3d(load(data_dir / "formats" / f"Eb015{kind}.c3d")) for kind in ("pi", "pr", "si")
    )
    assert np.array_equal(intel.points, sgi.points, equal_nan=True)
    assert np.allclose(intel.points, real.points, atol=0.05, equal_nan=True)
    assert intel.events == sgi.events == ((2.72, "RIC"), (5.4, "RHS"), (7.32, "RTO"))


ANALOG = np.random.default_rng(0).standard_normal((60, 4, 6))


def write_laboratory(folder: Path, labels, **parameters) -> Path:
    """A C3D with analog channels of these names."""
    more = {("ANALOG", "LABELS"): labels}
    more |= {tuple(name.split("__")): value for name, value in parameters.items()}
    channels = ANALOG[:, :, : len(labels)]
    data = to_c3d(to_millimetres(make_walk()), PLUG_IN_GAIT, analog=channels, more=more)
    path = folder / "laboratory.c3d"
    path.write_bytes(data)
    return path


@pytest.mark.parametrize(
    ("labels", "more", "muscles"),
    [
        (["Fx1", "Fz1", "EMG1", "L Tibialis", "CH5"], {}, ["EMG1", "L Tibialis"]),
        (
            ["Voltage.1", "Voltage.2"],
            {"ANALOG__DESCRIPTIONS": ["Force plate", "Analog EMG::Voltage"]},
            ["Voltage.2"],
        ),
        (["a", "b", "c"], {"ANALOG__UNITS": ["N", "mV", "V"]}, ["b"]),
        (["LTA", "R_GM", "RF1"], {"ANALOG__UNITS": ["V", "V", "V"]}, ["LTA", "R_GM"]),
        (["emg1", "emg2"], {"FORCE_PLATFORM__CHANNEL": np.int16([1])}, ["emg2"]),
        (["Soleus: EMG 1", "Soleus: ACC X"], {"ANALOG__UNITS": ["V", "g"]}, ["Soleus: EMG 1"]),
    ],
)
def test_muscles_of_a_laboratory(tmp_path, labels, more, muscles) -> None:
    path = write_laboratory(tmp_path, labels, **more)
    signals = kineme.read(path, emg=True)
    assert list(signals.names) == muscles
    left = ", ".join(name for name in labels if name not in muscles)
    said = f"channels read as muscles: {', '.join(muscles)}; left out: {left}"
    assert signals.provenance.notes == (said,)
    assert list(kineme.read(path, columns=()).names) == labels
    assert list(kineme.read(path, columns=labels[:1], emg=True).names) == labels[:1]


def test_channels_beside_a_motion_are_curves_of_its_frames(tmp_path) -> None:
    path = write_laboratory(tmp_path, ["Fx1", "EMG1"])
    loaded = LoadedRecording(ListedRecording(path), RecordingCache())
    heads = loaded.curves().head().curves
    number = next(
        i for i, head in enumerate(heads) if (head.name, head.group) == ("EMG1", "analog")
    )
    tile = loaded.curves().tile(loaded.get_source, number, 0, 0)
    muscle = ANALOG[:, :, 1]
    ends = np.stack([muscle.min(axis=1), muscle.max(axis=1)], axis=1)
    np.testing.assert_allclose(np.frombuffer(tile, "<f4").reshape(-1, 2), ends, rtol=1e-5)


def test_analog_channels_without_a_rate_of_their_own() -> None:
    """ezc3d#52: Xsens leaves out ANALOG:RATE."""
    analog = np.zeros((60, 4, 2))
    file = parse(to_c3d(POINTS, PLUG_IN_GAIT, analog=analog))
    assert file.parameters.number("ANALOG", "RATE", default=-1.0) == -1.0
    assert file.analog_rate == 400
