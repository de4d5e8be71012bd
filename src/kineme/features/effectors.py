"""Find the end effectors of any skeleton: ankles, head and wrists.

Section 3.1 of Voegele, Krueger and Klein (2014) describes a pose by the five points
that move most: both feet, the head and both hands. They are found

1. by the names that the user gives;
2. by the usual names, see `kineme.recordings.joint_names`;
3. by the shape of the skeleton, see ``topology``.

For the joint names of CMU's ASF files they are the points of the authors' program:
the tips of ltibia, rtibia, head, lwrist and rwrist. Otherwise they are the ankle and
wrist joints, and the crown of the head or the head joint.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import check_type, is_one_of, join_names
from kineme.errors import EndEffectorError, MotionError
from kineme.features.topology import find_by_shape
from kineme.recordings import Motion, Skeleton
from kineme.recordings.joint_names import CROWN, find_joints, find_rig_joints, has_word
from kineme.recordings.kinematics import place_at_rest

PARTS = ("left_ankle", "right_ankle", "head", "left_wrist", "right_wrist")
Names = Mapping[str, str] | Sequence[str]

MAX_SHOWN = 60
"""Largest number of joints that a message lists by name."""
_NAMED = (("*_ankle", "*_foot"), ("head",), ("*_wrist", "*_hand"))


@dataclass(frozen=True)
class EndEffectors:
    """Joint index of each part, and how each was found.

    ``how`` has one entry per part in the order of ``indices``: "as named",
    "by ASF name", "by name" or "by shape".

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> kineme.end_effectors(motion).how
    ('by name', 'by name', 'by name', 'by name', 'by name')
    """

    left_ankle: int
    right_ankle: int
    head: int
    left_wrist: int
    right_wrist: int
    how: tuple[str, ...] = field(kw_only=True)

    @property
    def indices(self) -> tuple[int, int, int, int, int]:
        """Return the joints in the order of features: ankles, head, wrists, left before right."""
        return self.left_ankle, self.right_ankle, self.head, self.left_wrist, self.right_wrist

    def describe(self, skeleton: Skeleton) -> str:
        """Describe the end effectors in one line: ``left ankle = LeftFoot (by name), ...``."""
        return ", ".join(
            f"{part.replace('_', ' ')} = {skeleton.names[joint]} ({how})"
            for part, joint, how in zip(PARTS, self.indices, self.how, strict=True)
        )


def end_effectors(source: Skeleton | Motion, *, names: Names | None = None) -> EndEffectors:
    """Find the ankles, head and wrists of a skeleton.

    Parameters
    ----------
    source : Skeleton or Motion
        If names do not help, the shape of the skeleton is used: in its most upright pose for a
        motion, or in its rest pose.
    names : mapping of str to str or sequence of str, optional
        Joint names by part ("left_ankle", "right_ankle", "head", "left_wrist", "right_wrist";
        missing parts are searched), or all five in this order.

    Raises
    ------
    EndEffectorError
        A part was not found, or the skeleton has no joint of a given name.

    References
    ----------
    Voegele et al. 2014, section 3.1; the choice of tips as in the authors'
    program.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> effectors = kineme.end_effectors(motion)
    >>> motion.skeleton.names[effectors.head]
    'Head_end'
    """
    check_type(source, (Motion, Skeleton), "end_effectors", "kineme.read(path) gives a motion")
    skeleton = source.skeleton if isinstance(source, Motion) else source
    # In order of priority: names given by the user, names of a known rig, usual names, shape.
    rig, rig_joints = find_rig_joints(skeleton.names)
    ways = [(_find_named(skeleton, names), "as named"), (rig_joints, f"by {rig} name"),
            (_find_by_names(skeleton), "by name")]  # fmt: skip
    if len({part for joints, _ in ways for part in joints}) < len(PARTS):
        ways.append((find_by_shape(skeleton.parents, _find_upright_pose(source)), "by shape"))
    found_parts = {part: (at, how) for joints, how in reversed(ways) for part, at in joints.items()}
    missing = [part.replace("_", " ") for part in PARTS if part not in found_parts]
    if missing:
        raise EndEffectorError(
            f"{_list_words(missing)} not found among the joints "
            f"{join_names(skeleton.names, MAX_SHOWN)}; " + suggest_remedy(skeleton),
            reason=f"no {_list_words(missing, 'or')} among the joints",
        )
    joints = [found_parts[part][0] for part in PARTS]
    # A joint must not serve as two parts.
    if len(set(joints)) < len(PARTS):
        duplicate = next(joint for joint in joints if joints.count(joint) > 1)
        reason = f"joint {skeleton.names[duplicate]!r} is used for two end effectors"
        raise EndEffectorError(
            f"{reason}; name five different joints with --effectors", reason=reason
        )
    return EndEffectors(*joints, how=tuple(found_parts[part][1] for part in PARTS))


def suggest_remedy(skeleton: Skeleton) -> str:
    """Say how to make the end effectors of a recording known, if they were not found."""
    if max(skeleton.parents) < 0:  # markers: the body's own frame also needs a pelvis
        return (
            "rename the markers of pelvis, ankles, head and wrists as in a marker set "
            "(LASI, RASI, LPSI, RPSI, LANK, ...) to segment them as a body"
        )
    parts = ",".join(PARTS).upper()
    return f"name all five with --effectors {parts} (effectors=... in Python)"


def _list_words(words: list[str], last: str = "and") -> str:
    """Join words to a list: ``a, b and c``."""
    return f" {last} ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def _find_named(skeleton: Skeleton, names: Names | None) -> dict[str, int]:
    if names is None:
        return {}
    if not isinstance(names, Mapping):
        value: object = names
        is_list = isinstance(value, Collection) and not isinstance(value, str)
        if not is_list or len(names) != len(PARTS):
            raise EndEffectorError(
                f"five joint names are needed ({', '.join(PARTS)}), not {names!r}"
            )
        names = dict(zip(PARTS, names, strict=True))
    for part, name in names.items():
        if part not in PARTS:
            raise EndEffectorError(f"no part is called {part!r}; there are {', '.join(PARTS)}")
        if not is_one_of(name, skeleton.names):
            raise EndEffectorError(
                f"no joint is called {name!r} (given for {part}); there are "
                + join_names(skeleton.names, MAX_SHOWN)
            )
    return {part: skeleton.names.index(name) for part, name in names.items()}


def _find_by_names(skeleton: Skeleton) -> dict[str, int]:
    named = find_joints(skeleton.names, _NAMED, single=True)
    found = {part: points[0] for part, points in named.items()}
    return found | {"head": _find_crown(skeleton, found["head"])} if "head" in found else found


def _find_crown(skeleton: Skeleton, head: int) -> int:
    """Return the end of the head joint, or the head joint itself if it has none."""
    leaves = [
        joint
        for joint, parent in enumerate(skeleton.parents)
        if parent == head
        and (joint in skeleton.end_sites or has_word(skeleton.names[joint], CROWN))
    ]
    # The crown is the farthest of several ends.
    return max(leaves, key=lambda j: float(np.linalg.norm(skeleton.offsets[j])), default=head)


def _find_upright_pose(source: Skeleton | Motion) -> NDArray[np.float64]:
    if isinstance(source, Motion):
        heights = source.positions[:, :, 1]
        # The frame with the largest difference in height.
        upright: NDArray[np.float64] = source.positions[np.ptp(heights, axis=1).argmax()]
        return upright
    return place_at_rest(source)


def measure_body_size(motion: Motion, effectors: EndEffectors) -> float:
    """Return the length of the bones from the ankles to the head, in metres.

    This is the mean length of the legs plus that of the trunk, at rest. It is close to
    the height of the person. In a motion without rotations, the length of a bone is the
    median distance of its ends.

    Raises
    ------
    MotionError
        The bones have no length.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features import measure_body_size
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> round(measure_body_size(motion, kineme.end_effectors(motion)), 2)
    1.72
    """
    legs = [
        _measure_chain(motion, joint) for joint in (effectors.left_ankle, effectors.right_ankle)
    ]
    size = float(np.mean(legs)) + _measure_chain(motion, effectors.head)
    if not size > 0:
        remedy = "" if max(motion.skeleton.parents) >= 0 else f": {suggest_remedy(motion.skeleton)}"
        raise MotionError(
            "the bones between ankles and head have no length, as in markers without a pelvis"
            + remedy
        )
    return size


def _measure_chain(motion: Motion, joint: int) -> float:
    """Return the length of the bones from a joint up to the hips."""
    length = 0.0
    parent = motion.skeleton.parents[joint]
    # The carrier is the hips joint, where the chain ends.
    while parent >= 0 and joint != motion.skeleton.carrier:
        if motion.rotations is None:
            bone = motion.positions[:, joint] - motion.positions[:, parent]
            length += float(np.median(np.linalg.norm(bone, axis=-1)))
        else:
            length += float(np.linalg.norm(motion.skeleton.offsets[joint]))
        joint, parent = parent, motion.skeleton.parents[parent]
    return length
