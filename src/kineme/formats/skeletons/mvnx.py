"""Read MVNX: exports of Xsens' MVN suits, as XML.

A ``subject`` has ``segments`` with labels, a ``frameRate``, and ``frames``. Each ``frame`` of type
``normal`` has the ``position`` of each segment's origin (metres, z up) and its ``orientation``
(quaternions w, x, y, z, from the segment to the world). Frames of other types are calibration
poses. The origin of a segment is the joint at its start. The 23 segments of the body are read;
props, fingers, sensors and joint angles are ignored. Without orientations the motion has positions
only.

Source: Xsens, "MVN User Manual", chapter on the file format MVNX.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from xml.etree import ElementTree as ET

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.files import NoEntities
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions, choose_person
from kineme.formats.registry import Format
from kineme.formats.skeletons.placing import build_motion
from kineme.formats.units import to_metres, turn_upright
from kineme.recordings import Motion, Skeleton

KINDS = ("position", "orientation")
"""Elements of a frame that are read."""

_LIMBS = {
    "Shoulder": "T8", "UpperArm": "Shoulder", "ForeArm": "UpperArm", "Hand": "ForeArm",
    "UpperLeg": "Pelvis", "LowerLeg": "UpperLeg", "Foot": "LowerLeg", "Toe": "Foot",
}  # fmt: skip
PARENTS = {
    "Pelvis": "", "L5": "Pelvis", "L3": "L5", "T12": "L3", "T8": "T12", "Neck": "T8",
    "Head": "Neck",
    **{f"{side}{part}": parent if parent in ("T8", "Pelvis") else f"{side}{parent}"
       for side in ("Right", "Left") for part, parent in _LIMBS.items()},
}  # fmt: skip
"""Parent of each segment of the body."""


@dataclass
class Subject:
    """A subject with the values of each frame."""

    name: str
    rate: float
    segments: list[str] = field(default_factory=list)
    values: dict[str, list[Floats]] = field(default_factory=lambda: {kind: [] for kind in KINDS})


def read_mvnx(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of a subject in an MVNX file."""
    people = _parse_subjects(content)
    if not people:
        raise content.error("it has no subject")
    names_of_people = [each.name for each in people]
    person = choose_person(content.path, names_of_people, options.person, "subjects")
    subject = people[names_of_people.index(person)]
    names = [name for name in PARENTS if name in subject.segments]
    if "Pelvis" not in names:
        raise content.error("none of its segments is a 'Pelvis'")
    n, chosen = len(subject.segments), [subject.segments.index(name) for name in names]
    parents = [_find_parent(name, names) for name in names]
    positions = _stack_frames(content, subject, "position", 3 * n).reshape(-1, n, 3)[:, chosen]
    if not np.isfinite(positions).all():
        raise content.error("positions are not all numbers")
    fps = content.choose_rate(options.fps, subject.rate, "it states no frameRate")
    left_out = [name for name in subject.segments if name not in PARENTS]
    notes = [f"segments left out: {', '.join(left_out)}"] if left_out else []
    provenance = content.provenance("MVNX", notes).of_person(person, names_of_people)
    if not subject.values["orientation"]:
        positions = to_metres(options.unit or "m") * turn_upright(positions, options.up or "z")
        # Offsets come from the frame with the largest height.
        tallest = positions[np.ptp(positions[:, :, 1], axis=1).argmax()]
        offsets = tallest - np.where(np.array(parents)[:, None] < 0, tallest, tallest[parents])
        skeleton = Skeleton(tuple(names), tuple(parents), offsets)
        return Motion(skeleton, positions, fps, rotations=None, provenance=provenance)
    world = _stack_frames(content, subject, "orientation", 4 * n).reshape(-1, n, 4)[:, chosen]
    if len(positions) != len(world):
        raise content.error("some frames have no orientations: export all frames with them")
    lengths = np.linalg.norm(world, axis=2, keepdims=True)
    if not (np.isfinite(lengths).all() and (lengths > 0).all()):
        raise content.error("orientations are not all numbers")
    world = world / lengths  # unit quaternions
    local, offsets = world.copy(), np.zeros((len(names), 3))
    # Convert world rotations to rotations relative to the parent.
    for joint, parent in enumerate(parents):
        if parent >= 0:
            inverse = rot.conjugate(world[:, parent])
            local[:, joint] = rot.multiply(inverse, world[:, joint])
            offset_per_frame = rot.rotate(inverse, positions[:, joint] - positions[:, parent])
            # Measured bone lengths vary slightly, so use the median.
            offsets[joint] = np.median(offset_per_frame, axis=0)
    return build_motion(
        Skeleton(tuple(names), tuple(parents), offsets),
        local,
        {0: positions[:, 0]},
        fps,
        unit=options.unit or "m",
        up=options.up or "z",
        provenance=provenance,
    )


class _SubjectParser(NoEntities):
    """Parser target that collects subjects and keeps nothing else."""

    def __init__(self, content: FileContent) -> None:
        self.content = content
        self.people: list[Subject] = []
        self._normal = False
        self._text: list[str] | None = None  # text of the current element

    def start(self, tag: str, attributes: Mapping[str, str]) -> None:
        name = tag.rpartition("}")[2]
        if name == "subject":
            rate = _to_number(attributes.get("frameRate", ""))
            self.people.append(Subject(attributes.get("label", ""), rate))
        elif name == "segment" and self.people:
            self.people[-1].segments.append(attributes.get("label", ""))
        elif name == "frame":
            self._normal = attributes.get("type", "normal") == "normal"
        elif name in KINDS and self._normal and self.people:
            self._text = []

    def data(self, text: str) -> None:
        if self._text is not None:
            self._text.append(text)

    def end(self, tag: str) -> None:
        name = tag.rpartition("}")[2]
        if self._text is None or name not in KINDS:
            return
        words, self._text = "".join(self._text).split(), None
        try:
            self.people[-1].values[name].append(np.array(words, np.float64))
        except ValueError:
            raise self.content.error(f"the {name} of a frame is not a number") from None


def _parse_subjects(content: FileContent) -> list[Subject]:
    """Return the subjects in a file; raise ReadError if it is truncated."""
    target = _SubjectParser(content)
    parser = ET.XMLParser(target=target)  # noqa: S314 (see NoEntities)
    try:
        parser.feed(content.data)
        parser.close()
    except ET.ParseError as error:
        raise content.error(f"is not complete XML: {error}") from None
    return target.people


def _stack_frames(content: FileContent, subject: Subject, kind: str, width: int) -> Floats:
    frames = subject.values[kind]
    if not frames:
        raise content.error(f"no frame has a {kind} of segments: export it with them")
    if any(len(values) != width for values in frames):
        raise content.error(f"a frame does not have {width} values in {kind}")
    return np.stack(frames)


def _find_parent(name: str, names: list[str]) -> int:
    """Return the index of the nearest ancestor of a segment that exists, -1 for none."""
    parent = PARENTS[name]
    while parent and parent not in names:
        parent = PARENTS[parent]
    return names.index(parent) if parent else -1


def _to_number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return 0.0


FORMAT = Format("MVNX", (".mvnx",), lambda head: b"<mvnx" in head, read_mvnx)
