"""Keypoints of detectors and trackers: layouts, choice of person, confidences, invalid files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from keypoint_samples import (
    COCO,
    OPENPOSE,
    as_json,
    check_sample,
    is_standing,
    make_coco,
    make_frame,
    make_mmpose,
    make_openpose,
    make_person,
    measure_wave,
    project,
    to_sleap_csv,
    to_sleap_h5,
    write_trc,
)
from typer.testing import CliRunner

import kineme
from growth import measure_peak
from kineme.cli.app import app
from kineme.errors import KinemeWarning, ReadError
from kineme.formats import ReadOptions, list_people
from kineme.formats.keypoints.detectors import LAYOUTS as MMPOSE
from kineme.formats.keypoints.people import track_people
from kineme.formats.listing import holds_recording
from reading import read


@pytest.mark.parametrize("count", [25, 18, 17, 26])
def test_openpose_in_a_folder(tmp_path: Path, count: int) -> None:
    for i, frame in enumerate(make_openpose(count)):
        (tmp_path / f"walk_{i:012d}_keypoints.json").write_text(json.dumps(frame))
    (tmp_path / "notes.txt").write_text("x")
    motion = kineme.read(tmp_path, fps=25)
    check_sample(motion, "OpenPose")
    assert motion.fps == 25
    assert (motion.positions[:, :, 2] == 0).all()
    with pytest.raises(
        ReadError, match="keypoints have no frame rate: give that of the video with fps="
    ):
        kineme.read(tmp_path)


def test_openpose_frames_without_anybody_are_gaps(tmp_path: Path) -> None:
    frames = make_openpose(frames=40)
    for i in (3, 4):
        frames[i]["people"] = []
    for i in range(15, 27):
        frames[i]["people"] = []
    for i, frame in enumerate(frames):
        if i != 33:  # a file that is missing
            (tmp_path / f"{i}.json").write_text(json.dumps(frame))
    with pytest.warns(KinemeWarning, match="frames 15 to 26"):
        motion = kineme.read(tmp_path, fps=25)
    assert motion.n_frames == 40
    assert motion.gaps == ((15, 27),)
    assert any("gaps up to 0.2 s filled" in note for note in motion.provenance.notes)


def test_openpose_in_one_file(tmp_path: Path) -> None:
    frames = make_openpose()
    motion = read(tmp_path, "a.json", frames, fps=25)
    numbered = read(tmp_path, "b.json", {str(i): f for i, f in enumerate(frames)}, fps=25)
    assert np.array_equal(motion.positions, numbered.positions)
    one = read(tmp_path, "c.json", frames[0], fps=25)
    assert one.n_frames == 1


def test_openpose_in_space_is_taken_where_it_is_there(tmp_path: Path) -> None:
    body = make_person(OPENPOSE[25])
    frames = make_openpose()
    for i, frame in enumerate(frames):
        solid = make_frame(body[i], key="pose_keypoints_3d")["people"][0]
        frame["people"][0]["pose_keypoints_3d"] = solid["pose_keypoints_3d"] if i != 4 else []
    motion = read(tmp_path, "a.json", frames, fps=25)
    assert motion.n_frames == 30
    assert not any("two-dimensional" in note for note in motion.provenance.notes)
    assert measure_wave(motion) == pytest.approx(0.8, abs=0.05)


def test_a_folder_of_two_videos_is_refused(tmp_path: Path) -> None:
    for i, frame in enumerate(make_openpose(frames=3)):
        (tmp_path / f"a_{i}_keypoints.json").write_text(json.dumps(frame))
    (tmp_path / "b_1_keypoints.json").write_text(json.dumps(frame))
    with pytest.raises(ReadError, match=r"frame 1 is in a_1_key.*in b_1_keypoints.json: put each"):
        kineme.read(tmp_path, fps=25)


def test_a_folder_of_anything_else(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("x")
    with pytest.raises(ReadError, match="is a folder without OpenPose files"):
        kineme.read(tmp_path)
    (tmp_path / "notes_1.json").write_text("{}")
    with pytest.raises(ReadError, match="is a folder without OpenPose files"):
        kineme.read(tmp_path, fps=30)
    (tmp_path / "frame_2.json").write_text(json.dumps(make_openpose(frames=1)[0]))
    (tmp_path / "frame_1.json").write_text("{}")
    with pytest.raises(ReadError, match="frame_1.json: it has no 'people'"):
        kineme.read(tmp_path, fps=30)
    (tmp_path / "frame_1.json").write_text('{"people": [')
    with pytest.raises(ReadError, match="frame_1.json, line 1: is not a complete JSON file"):
        kineme.read(tmp_path, fps=30)


def test_all_people_get_a_table_each(tmp_path: Path) -> None:
    one, other = (project(make_person(OPENPOSE[25], 200), x) for x in (300, 1200))
    frames = [make_frame(*both) for both in zip(one, other, strict=True)]
    (tmp_path / "a.json").write_text(json.dumps(frames))
    assert list_people(tmp_path / "a.json", ReadOptions(fps=25)) == ("0", "1")
    asked = ["segment", f"{tmp_path / 'a.json'}", "--fps", "25", "--preset", "uniform"]
    done = CliRunner().invoke(app, [*asked, "--person", "all", "-o", f"{tmp_path / 'a.csv'}"])
    assert done.exit_code == 0, done.output
    assert sorted(path.name for path in tmp_path.glob("a*.csv")) == ["a_0.csv", "a_1.csv"]
    for who in ("0", "1"):
        assert f"note: person {who} of 2" in done.output
        table = kineme.read_segments(tmp_path / f"a_{who}.csv")
        assert f"person {who} of 2" in table.provenance["notes"]
    (tmp_path / "b.json").write_text(json.dumps(make_openpose(frames=200)))
    asked[1] = f"{tmp_path / 'b.json'}"
    done = CliRunner().invoke(app, [*asked, "--person", "all", "-o", f"{tmp_path / 'b.csv'}"])
    assert done.exit_code == 0, done.output
    assert (tmp_path / "b.csv").exists()  # one alone needs no number
    done = CliRunner().invoke(
        app, ["info", f"{tmp_path / 'a.json'}", *asked[2:4], "--person", "all"]
    )
    assert all(f"person {who} of 2" in done.output for who in "01")


def test_one_of_several_people(tmp_path: Path) -> None:
    left = project(make_person(OPENPOSE[25]), 300)
    right = project(make_person(OPENPOSE[25])[::-1], 1200)
    frames = []
    for i, (one, other) in enumerate(zip(left, right)):
        frames.append(make_frame(*([one, other] if i % 2 else [other, one])))
    with pytest.raises(ReadError, match=r"2 people .* person= \(--person\): 0 \(30 frames from"):
        read(tmp_path, "a.json", frames, fps=25)
    motions = [read(tmp_path, "a.json", frames, fps=25, person=who) for who in (0, "1")]
    for motion in motions:  # the same person throughout
        assert np.abs(np.diff(motion.positions[:, motion.joint("pelvis"), 0])).max() < 0.05
    ways = [np.ptp(motion.positions[[0, -1], motion.joint("pelvis"), 0]) for motion in motions]
    assert ways[0] == pytest.approx(ways[1])
    with pytest.raises(ReadError, match="there is no person '7': choose from 0"):
        read(tmp_path, "a.json", frames, fps=25, person=7)


def test_who_left_does_not_take_over_who_stayed() -> None:
    rng = np.random.default_rng(0)
    body = rng.uniform(size=(17, 3)) * [80, 250, 0]
    frames, points, who = [], [], []
    for frame in range(400):
        # The first one kicks and then walks past the place where the second one was seen last.
        kick = 60 * np.sin(frame / 3) + 3 * max(frame - 200, 0)
        for person, x in enumerate((kick, 350.0)[: 1 + (frame < 100)]):
            frames.append(frame)
            points.append(body + rng.normal(0, 2, body.shape) * [1, 1, 0] + [x, 0, 0])
            who.append(person)
    assert track_people(np.array(frames), np.array(points)) == who


def test_somebody_in_passing_is_left_out(tmp_path: Path) -> None:
    frames = make_openpose()
    frames[10]["people"].append(
        make_frame(project(make_person(OPENPOSE[25], 1))[0] + 700)["people"][0]
    )
    motion = read(tmp_path, "a.json", frames, fps=25)
    assert any("1 seen only briefly are left out" in n for n in motion.provenance.notes)
    assert 0.6 < measure_wave(motion) < 1.0


def test_keypoints_that_are_not_sure_are_gaps(tmp_path: Path) -> None:
    frames = make_openpose()
    wrist = 3 * OPENPOSE[25].index("LWrist")
    keypoints = frames[12]["people"][0]["pose_keypoints_2d"]
    keypoints[wrist : wrist + 3] = [keypoints[wrist] + 150, keypoints[wrist + 1], 0.29]
    motion = read(tmp_path, "a.json", frames, fps=25)
    assert any("1 position below confidence 0.3 not used" in n for n in motion.provenance.notes)
    assert np.abs(np.diff(motion.positions[:, motion.joint("left_wrist")], axis=0)).max() < 0.3
    trusting = read(tmp_path, "a.json", frames, fps=25, confidence=0.1)
    assert np.abs(np.diff(trusting.positions[:, motion.joint("left_wrist")], axis=0)).max() > 0.5
    with pytest.raises(ReadError, match="every marker has a gap"):
        read(tmp_path, "a.json", frames, fps=25, confidence=0.95)


def test_coco(tmp_path: Path) -> None:
    check_sample(read(tmp_path, "a.json", make_coco(), fps=30), "COCO")
    photos = {"images": [{"id": i + 1} for i in range(30)], "annotations": make_coco()}
    with pytest.raises(ReadError, match="no keypoints found in it: .* COCO .a list with"):
        read(tmp_path, "a.json", photos, fps=30)
    assert not holds_recording(tmp_path / "a.json")


def test_coco_with_people_and_names_of_images(tmp_path: Path) -> None:
    both = make_coco(idx=1) + make_coco(idx=4, x=1300)
    for entry in both:
        entry["image_id"] = f"{entry['image_id']}.jpg"
    with pytest.raises(ReadError, match=r"2 people are in it: .* 1 \(30 frames .*, 4 \(30 frames"):
        read(tmp_path, "a.json", both, fps=30)
    assert is_standing(read(tmp_path, "a.json", both, fps=30, person=4))
    for entry in both:
        entry["idx"] = [float(entry["idx"])]  # as AlphaPose writes it
    assert read(tmp_path, "a.json", both, fps=30, person=1).provenance.people == ("1", "4")


def test_a_number_that_two_people_share_is_ignored(tmp_path: Path) -> None:
    left, right = (make_coco(idx=[0.0], x=x) for x in (400, 1300))
    # Untracked AlphaPose: the order within a frame may change.
    pairs = [pair[:: 1 - 2 * (i % 2)] for i, pair in enumerate(zip(left, right, strict=True))]
    motion = read(tmp_path, "a.json", [entry for pair in pairs for entry in pair], fps=30, person=0)
    assert motion.provenance.people == ("0", "1")
    alone = read(tmp_path, "b.json", left, fps=30)
    assert np.allclose(motion.positions, alone.positions)


@pytest.mark.parametrize("named", [False, True])
@pytest.mark.parametrize("count", [17, 26])
def test_mmpose(tmp_path: Path, named: bool, count: int) -> None:
    motion = read(tmp_path, "a.json", make_mmpose(MMPOSE[count], named=named), fps=30)
    check_sample(motion, "MMPose")
    floats = json.loads(as_json(make_mmpose(MMPOSE[count], named=named)), parse_int=float)
    assert read(tmp_path, "b.json", floats, fps=30).n_frames == motion.n_frames
    assert set(MMPOSE[count]) <= set(motion.skeleton.names)


def test_mmpose_of_whole_bodies_people_and_lifters(tmp_path: Path) -> None:
    whole = make_mmpose((*MMPOSE[133], *(f"nose_{i}" for i in range(110))), named=False)
    motion = read(tmp_path, "a.json", whole, fps=30)
    assert is_standing(motion)
    assert motion.joint("left_heel") >= 0
    assert not any(name.startswith("nose_") for name in motion.skeleton.names)
    both = make_mmpose(xs=(500.0, 1300.0))
    with pytest.raises(ReadError, match="2 people are in it"):
        read(tmp_path, "a.json", both, fps=30)
    for frame in both["instance_info"]:
        for number, each in enumerate(frame["instances"]):
            each["track_id"] = number + 7
    assert is_standing(read(tmp_path, "a.json", both, fps=30, person=8))
    lifted = make_mmpose()
    poses = make_person(COCO)[..., [0, 2, 1]] * [1, -1, 1]
    for frame, pose in zip(lifted["instance_info"], poses.tolist(), strict=True):
        frame["instances"][0]["keypoints"] = pose
    assert is_standing(read(tmp_path, "a.json", lifted, fps=30))


def test_sleap_csv(tmp_path: Path) -> None:
    tracks = {"ann": project(make_person(COCO)), "bob": project(make_person(COCO), 1200)}
    with pytest.raises(ReadError, match=r"2 people .*: ann \(30 frames from 0 on\), bob"):
        read(tmp_path, "a.csv", to_sleap_csv(tracks, COCO), fps=30)
    motion = read(tmp_path, "a.csv", to_sleap_csv(tracks, COCO), fps=30, person="bob")
    check_sample(motion, "SLEAP")
    one = read(tmp_path, "a.csv", to_sleap_csv({"": tracks["ann"]}, COCO), fps=30)
    assert is_standing(one)


@pytest.mark.parametrize("new", [False, True])
def test_sleap_analysis_files(tmp_path: Path, new: bool) -> None:
    pytest.importorskip("h5py")
    tracks = np.stack([project(make_person(COCO)), project(make_person(COCO), 1200)])
    tracks[1, 12:14] = np.nan
    data = to_sleap_h5(tracks, COCO, ["ann", "bob"], new)
    with pytest.raises(ReadError, match="2 people"):
        read(tmp_path, "a.analysis.h5", data, fps=30)
    motion = read(tmp_path, "a.h5", data, fps=30, person="bob")
    check_sample(motion, "SLEAP")


def test_hdf5_of_anything_else(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["df_with_missing/table"] = np.zeros(3)
    with pytest.raises(ReadError, match="no 'tracks' and 'node_names' among df_with_missing"):
        kineme.read(tmp_path / "a.h5", fps=30)
    with h5py.File(tmp_path / "b.h5", "w") as file:
        file.create_dataset("tracks", shape=(10**6, 2, 5, 10**6), dtype="f8", chunks=(1, 2, 5, 10))
    with pytest.raises(ReadError, match="claims to unpack far more than it contains"):
        kineme.read(tmp_path / "b.h5", fps=30)


def to_deeplabcut(*people: np.ndarray, individuals: str = "", separator: str = ",") -> str:
    """A table of the keypoints of COCO, (frames, 17, 2) of each person."""
    names = [name for _ in people for name in COCO for _ in range(3)]
    head = [
        ["scorer", *["net"] * len(names)],
        ["bodyparts", *names],
        ["coords", *["x", "y", "likelihood"] * (len(names) // 3)],
    ]
    if individuals:
        head.insert(1, ["individuals", *(name for name in individuals.split() for _ in COCO * 3)])
    rows = [
        [i, *(cell for row in rows for x, y in row.tolist() for cell in (x, y, 0.9))]
        for i, rows in enumerate(zip(*people, strict=True))
    ]
    return "\n".join(separator.join(map(str, row)) for row in [*head, *rows])


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_deeplabcut(tmp_path: Path, separator: str) -> None:
    points = project(make_person(COCO))
    text = to_deeplabcut(points, separator=separator)
    check_sample(read(tmp_path, "a.csv", text, fps=30), "DeepLabCut")
    with pytest.raises(ReadError, match="no column 'time' or 'fps' found: give fps="):
        read(tmp_path, "a.csv", text)
    unsure = text.replace(f"{separator}0.9", f"{separator}0.5", 1)
    motion = read(tmp_path, "a.csv", unsure, fps=30)
    assert "1 position below confidence 0.6 not used" in motion.provenance.notes
    assert (motion.positions[:, :, 2] == 0).all()


def test_deeplabcut_with_several_individuals(tmp_path: Path) -> None:
    points = project(make_person(COCO))
    text = to_deeplabcut(points, points + 700, individuals="ann bob")
    with pytest.raises(ReadError, match=r"2 individuals .*\(--person\): ann, bob"):
        read(tmp_path, "a.csv", text, fps=30)
    assert is_standing(read(tmp_path, "a.csv", text, fps=30, person="bob"))
    with pytest.raises(ReadError, match="no person 'eve': choose from ann, bob"):
        read(tmp_path, "a.csv", text, fps=30, person="eve")


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("{", "line 1: is not a complete JSON file"),
        ("[" * 100_000, "is not a complete JSON file"),
        ("{}", "no keypoints found in it"),
        ('[{"people": 3}]', "frame 0 has no list of 'people'"),
        ('[{"people": [3]}]', "a person without pose_keypoints_3d"),
        ('[{"people": [{}]}]', "a person without pose_keypoints_3d, pose_keypoints_2d"),
        ('[{"people": [{"pose_keypoints_2d": [1, 2, "a"]}]}]', "not a list of numbers"),
        ('[{"people": [{"pose_keypoints_2d": [1, 2, 3]}]}]', "keypoints: 15, 17, 18"),
        ('[{"people": []}]', "no person found in any frame"),
        (
            '{"0": {"people": []}, "99999999999": {"people": []}}',
            "no person found|cannot be frame num",
        ),
    ],
)
def test_bad_json(tmp_path: Path, content: str, reason: str) -> None:
    with pytest.raises(ReadError, match=reason) as caught:
        read(tmp_path, "a.json", content, fps=30)
    assert "\n" not in str(caught.value)


def test_memory_follows_the_file_and_not_its_numbers(tmp_path: Path) -> None:
    frames = dict(zip(("0", "1", "900000000"), make_openpose(frames=3)))
    (tmp_path / "a.json").write_bytes(as_json(frames))

    def refuse() -> None:
        with pytest.raises(ReadError, match="these cannot be frame numbers"):
            kineme.read(tmp_path / "a.json", fps=30)

    assert measure_peak(refuse) < 2_000_000


def test_openpose_of_a_whole_body(tmp_path: Path) -> None:
    names = (*OPENPOSE[133], *(f"nose_{i}" for i in range(110)))
    frames = [make_frame(points) for points in project(make_person(names))]
    motion = read(tmp_path, "a.json", frames, fps=25)
    assert is_standing(motion)
    assert not any(name.startswith("nose_") for name in motion.skeleton.names)


@pytest.mark.parametrize("sign", [1, -1], ids=["y up", "y down"])
def test_pixels_of_sports2d_are_a_body(tmp_path: Path, sign: int) -> None:
    """It states metres above pixels."""
    names = ["Hip", "RHip", "RKnee", "RAnkle", "LHip", "LKnee", "LAnkle", "Neck", "Head", "Nose"]
    names += ["RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist"]
    points = 110 * make_person(tuple(names)) * (1, sign, 1)
    motion = kineme.read(write_trc(tmp_path / "walk_px_person00.trc", points, names, "m"))
    assert is_standing(motion)
    assert 0.7 < measure_wave(motion) < 1.0


@pytest.mark.parametrize("top", ["Neck", "C7", "C7_study"])
def test_a_trc_without_a_head_has_a_body(tmp_path: Path, top: str) -> None:
    """As OpenCap leaves them."""
    names = ["midHip", "RHip", "RKnee", "RAnkle", "LHip", "LKnee", "LAnkle"]
    names += ["RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist"]
    points = np.concatenate([make_person(tuple(names)), make_person(("Neck",))], axis=1)
    motion = kineme.read(write_trc(tmp_path / "a.trc", points, [*names, top], "m"))
    assert is_standing(motion)
    assert not kineme.segment(motion).provenance["notes"][0].startswith("no body")


def test_ultralytics_people_by_frame(tmp_path: Path) -> None:
    """A frame without anybody keeps its place."""
    x = [100.0 + 10 * (i % 3) for i in range(17)]
    y = [50.0 + 20 * i for i in range(17)]
    box = {"x1": 0, "y1": 0, "x2": 1, "y2": 1}
    keypoints = {"x": x, "y": y, "visible": [0.9] * 17}
    person = {"name": "person", "box": box, "track_id": 1, "keypoints": keypoints}
    frames = [[person] if i != 5 else [] for i in range(40)]
    motion = read(tmp_path, "a.json", frames, fps=30)
    assert motion.n_frames == 40
    assert "left_knee" in motion.skeleton.names
    # The same as fractions of the image, as with normalize=True.
    keypoints.update(x=[value / 1280 for value in x], y=[value / 720 for value in y])
    with pytest.warns(KinemeWarning, match="unknown size, assumed square"):
        read(tmp_path, "a.json", [[person]] * 40, fps=30)
