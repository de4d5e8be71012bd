"""Find the end effectors of any skeleton: ankles, head and wrists.

Section 3.1 of Voegele, Krueger and Klein (2014) describes a pose by the five points
that move most: both feet, the head and both hands. They are found

1. by the names that the user gives;
2. by the usual names, see `kineme.recordings.joint_names`;
3. by the shape of the skeleton, see `find_by_shape`.

For the joint names of CMU's ASF files they are the points of the authors' program:
the tips of ltibia, rtibia, head, lwrist and rwrist. Otherwise they are the ankle and
wrist joints, and the crown of the head or the head joint.

In the shape of a skeleton, limbs are pairs of branches of one joint whose longest paths
have the same bone lengths. The two longest pairs are legs and arms; the pair that ends
lower in the given pose is the legs. The two longest bones of a limb (thigh and shin, upper
arm and forearm) end at the ankle or wrist; bones that begin at the same place on both sides
(clavicles) do not count. The head is the end of the longest other branch at the joint
where the arms begin. Left and right follow from the direction f of the feet: with y
up, left is y x f.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import check_type, is_one_of, join_names
from kineme.errors import EndEffectorError, MotionError
from kineme.recordings import Motion, Skeleton
from kineme.recordings.joint_names import CROWN, find_joints, find_rig_joints, has_word
from kineme.recordings.kinematics import place_at_rest

Names = Mapping[str, str] | Sequence[str]
_SAME_LENGTH = 0.15
"""Largest relative difference of the bones of a pair of limbs."""
_MAX_BRANCHES = 32
"""Largest number of branches of one joint that are compared in pairs: the longest ones."""
_MIN_FOOT = 0.1
"""Shortest foot that gives a direction, as a share of the length of the leg."""
PARTS = ("left_ankle", "right_ankle", "head", "left_wrist", "right_wrist")
MAX_SHOWN = 10
"""Largest number of joints that a message lists by name."""
_NAMED = (("*_ankle", "*_foot"), ("head",), ("*_wrist", "*_hand"))
GROUND_PERCENTILE = 5.0
"""Percentile of the heights of a point that counts as its lowest height."""


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
    """Return the joints that the user named, by part; raise EndEffectorError for others."""
    if names is None:
        return {}
    if not isinstance(names, Mapping):
        value: object = names
        is_list = isinstance(value, Collection) and not isinstance(value, str)
        if not is_list or len(names) != len(PARTS):
            given = join_names([*map(str, names)]) if is_list else repr(value)
            raise EndEffectorError(f"five joint names are needed ({', '.join(PARTS)}), not {given}")
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
    """Return the end effectors with known names; for the head, its crown if it has one."""
    named = find_joints(skeleton.names, _NAMED, single=True)
    found = {part: points[0] for part, points in named.items()}
    if "head" in found:
        leaves = [
            joint
            for joint, parent in enumerate(skeleton.parents)
            if parent == found["head"]
            and (joint in skeleton.end_sites or has_word(skeleton.names[joint], CROWN))
        ]
        # The crown is the end farthest from the head joint, which stands in if there is none.
        found["head"] = max(
            leaves,
            key=lambda j: float(np.linalg.norm(skeleton.offsets[j])),
            default=found["head"],
        )
    return found


def _find_upright_pose(source: Skeleton | Motion) -> NDArray[np.float64]:
    if isinstance(source, Motion):
        heights = source.positions[:, :, 1]
        # The frame with the largest difference in height.
        upright: NDArray[np.float64] = source.positions[np.ptp(heights, axis=1).argmax()]
        return upright
    return place_at_rest(source)


@dataclass(frozen=True)
class _Limb:
    """A limb of a skeleton, by indices of joints."""

    parent: int
    """Joint at which the limb branches off."""
    branch: int
    """First joint of the limb."""
    top: int
    """Where its first long bone begins."""
    end: int
    """Where its second long bone ends."""
    tip: int
    """Its farthest joint."""
    length: float
    """Length of all bones."""


def find_by_shape(parents: Sequence[int], pose: Floats) -> dict[str, int]:
    """Return joints by part ("left_ankle", ..., "head"), as far as they are found by shape.

    A root has the parent -1. The pose (joints, 3), in metres with y up, is one in which the legs
    are the lower limbs.
    """
    paths, lengths = _find_longest_paths(parents, pose)
    pairs = _find_limb_pairs(parents, paths, lengths, pose)[:2]
    if len(pairs) < 2:
        return {}
    # The legs end lower than the arms.
    legs, arms = sorted(pairs, key=lambda pair: float(pose[[limb.end for limb in pair], 1].sum()))
    joints = _find_head(parents, arms, paths, lengths)
    left = _find_left(legs, pose)
    if left is not None:
        for part, pair in (("ankle", legs), ("wrist", arms)):
            # Sorted along the direction to the left, the right limb comes first.
            right_limb, left_limb = sorted(pair, key=lambda limb: float(pose[limb.top] @ left))
            joints |= {f"left_{part}": left_limb.end, f"right_{part}": right_limb.end}
    return joints


def _find_longest_paths(
    parents: Sequence[int], pose: Floats
) -> tuple[list[list[int]], list[float]]:
    """Return the longest path from each joint to a leaf, and its length from the joint's parent."""
    paths: list[list[int]] = [[joint] for joint in range(len(parents))]
    below = [0.0] * len(parents)
    # A root has no parent: use index 0 instead.
    bones = np.linalg.norm(pose - pose[np.maximum(parents, 0)], axis=1).tolist()
    # Children come after parents, so iterate backwards.
    for joint in range(len(parents) - 1, -1, -1):
        parent = parents[joint]
        if parent >= 0 and bones[joint] + below[joint] > below[parent]:
            below[parent] = bones[joint] + below[joint]
            paths[parent] = [parent, *paths[joint]]
    return paths, [bone + rest for bone, rest in zip(bones, below, strict=True)]


def _find_limb_pairs(
    parents: Sequence[int], paths: list[list[int]], lengths: list[float], pose: Floats
) -> list[tuple[_Limb, _Limb]]:
    """Return the pairs of similar branches of one joint, the longest first."""
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(parents):
        # Skip branches that are a single joint.
        if parent >= 0 and len(paths[joint]) > 1:
            children.setdefault(parent, []).append(joint)
    pairs = []
    for branches in children.values():
        longest = sorted(branches, key=lambda joint: -lengths[joint])[:_MAX_BRANCHES]
        # Sort by joint again, so that the order in a pair does not depend on lengths.
        for one, other in combinations(sorted(longest), 2):
            if pair := _pair_limbs(parents, paths[one], paths[other], pose):
                pairs.append(pair)
    return sorted(pairs, key=lambda pair: -pair[0].length - pair[1].length)


def _pair_limbs(
    parents: Sequence[int], one: list[int], other: list[int], pose: Floats
) -> tuple[_Limb, _Limb] | None:
    """Return two branches as a pair of limbs, or None if their bones differ."""
    if len(one) != len(other):
        return None
    paths = np.array([one, other])
    # Joint at which each bone begins, (2, bones).
    starts = np.asarray(parents)[paths]
    bones = np.linalg.norm(pose[paths] - pose[starts], axis=2)
    # Summed differences of the bones, as a share of the length of one branch.
    if np.abs(bones[0] - bones[1]).sum() > _SAME_LENGTH * bones[0].sum():
        return None
    # Bones such as clavicles begin at the same place on both sides.
    is_separate = np.any(pose[starts[0]] != pose[starts[1]], axis=1)
    # The two longest bones, in order down the limb; at ties the upper ones.
    long_bones = np.sort(np.argsort(-(bones[0] * is_separate), kind="stable")[:2])
    upper, lower = long_bones[0], long_bones[-1]
    left_and_right = [
        _Limb(
            parents[path[0]],
            path[0],
            top=parents[path[upper]],
            end=path[lower],
            tip=path[-1],
            length=length,
        )
        for path, length in zip((one, other), bones.sum(axis=1).tolist(), strict=True)
    ]
    return left_and_right[0], left_and_right[1]


def _find_left(legs: tuple[_Limb, _Limb], pose: Floats) -> Floats | None:
    """Return the direction to the body's left in the pose, or None if feet give no direction."""
    # Sum of both feet, from the ankle to the tip.
    feet = sum((pose[leg.tip] - pose[leg.end] for leg in legs), start=np.zeros(3))
    ahead = np.array([feet[0], 0.0, feet[2]])
    if np.linalg.norm(ahead) < _MIN_FOOT * legs[0].length:
        return None
    return np.cross([0.0, 1.0, 0.0], ahead)


def _find_head(
    parents: Sequence[int], arms: tuple[_Limb, _Limb], paths: list[list[int]], lengths: list[float]
) -> dict[str, int]:
    """Return the end of the longest branch at the chest that is not an arm."""
    chest, used = arms[0].parent, {arm.branch for arm in arms}
    others = [j for j, parent in enumerate(parents) if parent == chest and j not in used]
    return {"head": paths[max(others, key=lambda j: lengths[j])][-1]} if others else {}


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


def measure_speed(path: Floats, fps: float) -> Floats:
    """Return the speed of a point (frames, dims) in metres per second; 0 for a single frame."""
    if len(path) < 2:
        return np.zeros(len(path))
    return np.asarray(np.linalg.norm(np.gradient(path, axis=0), axis=1) * fps)


def find_low_and_slow(
    path: Floats, fps: float, *, height: float, speed: float
) -> NDArray[np.bool_]:
    """Return the frames in which a point (frames, 3), in metres with y up, stands.

    It stands while it is less than ``height`` metres above its lowest height, and slower than
    ``speed`` metres per second.
    """
    # A low percentile is robust to tracking errors, unlike the minimum.
    low = path[:, 1] < np.percentile(path[:, 1], GROUND_PERCENTILE) + height
    return np.asarray(low & (measure_speed(path, fps) < speed))
