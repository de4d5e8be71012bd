"""MVNX of Xsens' suits: a random walking body is read back, and invalid files give a reason."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import kineme
from kineme.errors import ReadError, SeveralPeopleError
from kineme.formats import list_people
from kineme.formats.skeletons.mvnx import PARENTS
from kineme.recordings import Motion, Skeleton

NAMES = tuple(PARENTS)
HEIGHTS = {
    "Pelvis": 0.95, "Neck": 0.25, "UpperLeg": -0.02, "LowerLeg": -0.42, "Foot": -0.4, "Toe": -0.08,
    "UpperArm": 0.0, "ForeArm": -0.28, "Hand": -0.25,
}  # fmt: skip


def make_suit(frames: int = 12) -> Motion:
    """Somebody in a suit who bends all joints a little, y up."""
    rng = np.random.default_rng(3)
    parents = [NAMES.index(PARENTS[name]) if PARENTS[name] else -1 for name in NAMES]
    offsets = np.zeros((len(NAMES), 3))
    for i, name in enumerate(NAMES):
        part = name.removeprefix("Right").removeprefix("Left")
        side = 0.0 if part == name else 0.1 if name.startswith("Left") else -0.1
        offsets[i] = (side * (part in ("Shoulder", "UpperLeg")), HEIGHTS.get(part, 0.1), 0.02)
    turns = Rotation.from_rotvec(rng.normal(scale=0.2, size=(frames * len(NAMES), 3)))
    rotations = turns.as_quat(scalar_first=True).reshape(frames, len(NAMES), 4)
    places = np.repeat(offsets[None], frames, axis=0)
    places[:, 0] += np.linspace(0, 2, frames)[:, None] * [0, 0, 1]
    skeleton = Skeleton(NAMES, tuple(parents), offsets)
    return Motion.from_rotations(skeleton, rotations, 60, translations=places)


def to_mvnx(motion: Motion, *, more: str = "", name: str = "Anna", positions: bool = True) -> str:
    """As MVN writes it: z up, world orientations, a frame of calibration first."""
    up = Rotation.from_euler("x", 90, degrees=True)
    world = np.empty((motion.n_frames, len(NAMES), 4))
    for joint, parent in enumerate(motion.skeleton.parents):
        own = Rotation.from_quat(motion.rotations[:, joint], scalar_first=True)
        before = up if parent < 0 else Rotation.from_quat(world[:, parent], scalar_first=True)
        world[:, joint] = (before * own).as_quat(scalar_first=True)
    frames = []
    for i, frame in enumerate(motion.positions):
        values = {"orientation": world[i].ravel().tolist()}
        if positions:
            values["position"] = up.apply(frame.copy()).ravel().tolist()
        inside = "".join(f"<{key}>{' '.join(map(repr, v))}</{key}>" for key, v in values.items())
        frames.append(f'<frame time="{i}" index="{i}" type="normal">{inside}<jointAngle/></frame>')
    segments = "".join(f'<segment label="{name}" id="{i}"/>' for i, name in enumerate(NAMES, 1))
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<mvnx xmlns="http://www.xsens.com/mvn/mvnx" version="4">'
        f'<subject label="{name}" frameRate="60" segmentCount="23"><segments>{segments}{more}'
        '</segments><frames><frame type="identity"><orientation>1 0 0 0</orientation>'
        f"<position>0 0 0</position></frame>{''.join(frames)}</frames></subject></mvnx>"
    )


def read(folder: Path, text: str, **options: object) -> Motion:
    (folder / "a.mvnx").write_text(text, encoding="utf-8")
    return kineme.read(folder / "a.mvnx", **options)


def test_a_suit_comes_back(tmp_path: Path) -> None:
    motion = make_suit()
    found = read(tmp_path, to_mvnx(motion))
    assert (found.fps, found.n_frames, found.skeleton.names) == (60, 12, NAMES)
    assert found.provenance.format == "MVNX"
    assert found.rotations is not None
    assert np.allclose(found.positions, motion.positions, atol=1e-9)
    kineme.write(found, tmp_path / "a.bvh")
    again = kineme.read(tmp_path / "a.bvh", unit="cm", up="y")
    at = [again.joint(name) for name in NAMES]
    assert np.allclose(again.positions[:, at], motion.positions, atol=1e-4)
    kineme.pose_features(found)


def test_positions_without_orientations(tmp_path: Path) -> None:
    motion = make_suit()
    text = re.sub(r'(type="normal">)<orientation>.*?</orientation>', r"\1", to_mvnx(motion))
    found = read(tmp_path, text)
    assert (found.fps, found.skeleton.names, found.rotations) == (60, NAMES, None)
    assert found.skeleton.parents == motion.skeleton.parents
    assert np.allclose(found.positions, motion.positions, atol=1e-9)
    assert np.abs(read(tmp_path, text, unit="cm").positions).max() < 0.1
    text = to_mvnx(motion).replace("<orientation>", "<x>", 3).replace("</orientation>", "</x>", 3)
    with pytest.raises(ReadError, match="some frames have no orientations"):
        read(tmp_path, text)


def test_a_layout_without_orientations(data_dir: Path) -> None:
    motion = kineme.read(data_dir / "layouts" / "mvnx_no_orientation.mvnx")
    assert (motion.skeleton.n_joints, motion.fps, motion.rotations) == (23, 60, None)
    places = {name: motion.positions[:, motion.joint(name), 1] for name in ("Head", "Pelvis")}
    assert (places["Head"] > places["Pelvis"] + 0.3).all()  # metres, and y is up


def test_a_prop_and_a_missing_segment(tmp_path: Path) -> None:
    motion = make_suit()
    text = to_mvnx(motion)
    renamed = text.replace('label="L3"', 'label="Prop1"')
    found = read(tmp_path, renamed)
    assert found.provenance.notes == ("segments left out: Prop1",)
    assert found.skeleton.names[found.skeleton.parents[found.joint("T12")]] == "L5"


def test_one_of_several_subjects(tmp_path: Path) -> None:
    one = to_mvnx(make_suit(), name="Anna")
    other = to_mvnx(replace(make_suit(), positions=make_suit().positions + 1), name="Bob")
    text = one.replace("</mvnx>", other[other.index("<subject") :])
    with pytest.raises(SeveralPeopleError, match="Anna, Bob"):
        read(tmp_path, text)
    bob = read(tmp_path, text, person="Bob")
    assert bob.positions[0, 0, 0] > 0.5
    assert (bob.provenance.person, bob.provenance.people) == ("Bob", ("Anna", "Bob"))
    assert list_people(tmp_path / "a.mvnx") == ("Anna", "Bob")


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        (lambda text: text[: len(text) // 2], "is not complete XML"),
        (lambda text: text.replace('label="Pelvis"', 'label="Hip"'), "'Pelvis'"),
        (lambda text: text.replace('frameRate="60"', ""), "no frameRate: give fps"),
        (lambda text: text.replace("subject", "actor"), "it has no subject"),
        (lambda text: text.replace('"normal"', '"npose"'), "no frame has a position"),
        (lambda text: text.replace("</position>", " 1</position>", 2), r"does not have \d+ values"),
        (
            lambda text: text.replace("<position>", "<position>x ", 2),
            "position of a frame is not a number",
        ),
        (lambda text: text.replace("<position>", "<position>nan ", 2), r"does not have \d+ values"),
        (lambda _: to_mvnx(make_suit(), positions=False), "no frame has a position"),
    ],
)
def test_wrong_files(tmp_path: Path, spoil, reason: str) -> None:
    with pytest.raises(ReadError, match=reason):
        read(tmp_path, spoil(to_mvnx(make_suit(2))))


def test_entities_do_not_grow(tmp_path: Path) -> None:
    levels = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 12))
    head = f'<?xml version="1.0"?><!DOCTYPE mvnx [<!ENTITY e0 "ha">{levels}]>'
    with pytest.raises(ReadError, match="it has a document type declaration, which is not allowed"):
        read(tmp_path, f"{head}<mvnx><subject label='x'>&e11;</subject></mvnx>")
