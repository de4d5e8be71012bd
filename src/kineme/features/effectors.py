"""End effectors: the ankles, the head and the wrists of any skeleton.

Section 3.1 of Voegele, Krueger and Klein (2014) describes a pose by five points
that move most: both feet, the head and both hands. They are found

1. where the user says they are;
2. by the usual names (CMU and HDM05 ASF, cgspeed, Mixamo, HumanIK, Perception
   Neuron, SMPL, Xsens, Rokoko, Biped, Unreal, Kinect, ...), see ``naming``;
3. by the shape of the skeleton, see ``topology``.

For the names of CMU's ASF files the points are those of the authors' program:
the tips of ltibia, rtibia, head, lwrist and rwrist. Elsewhere the ankle and
wrist joints, and the crown of the head where the skeleton has one.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import check_type, is_one_of
from kineme.errors import EndEffectorError
from kineme.features.naming import find_by_name, words_of
from kineme.features.topology import find_by_shape
from kineme.recordings import Motion, Skeleton

PARTS = ("left_ankle", "right_ankle", "head", "left_wrist", "right_wrist")
Names = Mapping[str, str] | Sequence[str]

# Joint at the tip of each of the bones that the authors' program follows.
_ASF_TIPS = dict(zip(PARTS, ("lfoot", "rfoot", "head_end", "lhand", "rhand"), strict=True))
_ASF_BONES = frozenset({"ltibia", "rtibia", "head", "lradius", "lwrist", "rwrist"})
_WORDS = {"ankle": ("ankle", "foot"), "head": ("head",), "wrist": ("wrist", "hand")}
_CROWN = frozenset({"end", "top", "tip", "nub", "crown", "site"})


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
        """Joints in the order of the features: ankles, head, wrists, left before right."""
        return self.left_ankle, self.right_ankle, self.head, self.left_wrist, self.right_wrist

    def describe(self, skeleton: Skeleton) -> str:
        """One line for people: ``left ankle = LeftFoot (by name), ...``."""
        return ", ".join(
            f"{part.replace('_', ' ')} = {skeleton.names[joint]} ({how})"
            for part, joint, how in zip(PARTS, self.indices, self.how, strict=True)
        )


def end_effectors(source: Skeleton | Motion, *, names: Names | None = None) -> EndEffectors:
    """Ankles, head and wrists of a skeleton.

    Parameters
    ----------
    source : Skeleton or Motion
        A skeleton, or a motion: then its most upright pose, not the rest pose, tells the shape
        where names do not help.
    names : mapping of str to str or sequence of str, optional
        Joint names by part ("left_ankle", "right_ankle", "head", "left_wrist", "right_wrist"; those
        left out are searched for), or all five in this order.

    Raises
    ------
    EndEffectorError
        A part was not found, or a given name is not in the skeleton.

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
    # The first source that names a part wins: the user, ASF names, usual names, shape.
    found = {part: (joint, "as named") for part, joint in _named(skeleton, names).items()}
    _add(found, _find_by_asf_names(skeleton), "by ASF name")
    _add(found, _find_by_names(skeleton), "by name")
    if len(found) < len(PARTS):
        _add(found, find_by_shape(skeleton.parents, _upright_pose(source)), "by shape")
    missing = [part.replace("_", " ") for part in PARTS if part not in found]
    if missing:
        raise EndEffectorError(
            f"{_listed(missing)} not found among the joints {_joint_list(skeleton)}; "
            + remedy(skeleton),
            reason=f"no {_listed(missing, 'or')} among the joints",
        )
    joints = [found[part][0] for part in PARTS]
    # One joint that serves as two parts would count twice.
    if len(set(joints)) < len(PARTS):
        twice = next(joint for joint in joints if joints.count(joint) > 1)
        reason = f"joint {skeleton.names[twice]!r} serves as two end effectors"
        raise EndEffectorError(
            f"{reason}; name five different joints with --effectors", reason=reason
        )
    return EndEffectors(*joints, how=tuple(found[part][1] for part in PARTS))


def remedy(skeleton: Skeleton) -> str:
    """How a recording becomes that of a body in which the end effectors were not found."""
    if max(skeleton.parents) < 0:  # where a body stands and faces, a pelvis tells
        return (
            "to be looked at as a body, the markers of pelvis, ankles, head and wrists need the "
            "names of a marker set (LASI, RASI, LPSI, RPSI, LANK, ...)"
        )
    parts = ",".join(PARTS).upper()
    return f"name all five with --effectors {parts} (effectors=... in Python)"


def _listed(words: list[str], last: str = "and") -> str:
    """Return the words as people list them: ``a, b and c``."""
    return f" {last} ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def _add(found: dict[str, tuple[int, str]], more: Mapping[str, int], how: str) -> None:
    for part, joint in more.items():
        found.setdefault(part, (joint, how))


def _are_five(names: object) -> bool:
    if isinstance(names, str) or not isinstance(names, Collection):
        return False
    return len(names) == len(PARTS)


def _named(skeleton: Skeleton, names: Names | None) -> dict[str, int]:
    if names is None:
        return {}
    if not isinstance(names, Mapping):
        if not _are_five(names):
            raise EndEffectorError(
                f"five joint names are needed ({', '.join(PARTS)}), not {names!r}"
            )
        names = dict(zip(PARTS, names, strict=True))
    for part, name in names.items():
        if part not in PARTS:
            raise EndEffectorError(f"no part is called {part!r}; there are {', '.join(PARTS)}")
        if not is_one_of(name, skeleton.names):
            raise EndEffectorError(
                f"no joint is called {name!r} (given for {part}); there are {_joint_list(skeleton)}"
            )
    return {part: skeleton.names.index(name) for part, name in names.items()}


def _find_by_asf_names(skeleton: Skeleton) -> dict[str, int]:
    names = skeleton.names
    if not _ASF_BONES.issubset(names):
        return {}
    return {part: names.index(tip) for part, tip in _ASF_TIPS.items() if tip in names}


def _find_by_names(skeleton: Skeleton) -> dict[str, int]:
    found = {}
    for part in PARTS:
        side, _, kind = part.rpartition("_")
        joint = find_by_name(skeleton.names, _WORDS[kind], side or None)
        if joint is not None:
            found[part] = _crown(skeleton, joint) if kind == "head" else joint
    return found


def _crown(skeleton: Skeleton, head: int) -> int:
    """Return the leaf that ends the head joint, or the head joint itself."""
    leaves = [
        joint
        for joint, parent in enumerate(skeleton.parents)
        if parent == head
        and (joint in skeleton.end_sites or _CROWN.intersection(words_of(skeleton.names[joint])))
    ]
    # Of several ends the farthest one is the crown.
    return max(leaves, key=lambda j: float(np.linalg.norm(skeleton.offsets[j])), default=head)


def _upright_pose(source: Skeleton | Motion) -> NDArray[np.float64]:
    if isinstance(source, Motion):
        heights = source.positions[:, :, 1]
        # The frame with the largest difference in height.
        upright: NDArray[np.float64] = source.positions[np.ptp(heights, axis=1).argmax()]
        return upright
    pose = source.offsets.copy()
    # Parents come before children, so each is placed already.
    for joint, parent in enumerate(source.parents):
        if parent >= 0:
            pose[joint] += pose[parent]
    return pose


def _joint_list(skeleton: Skeleton, most: int = 60) -> str:
    shown = ", ".join(skeleton.names[:most])
    hidden = len(skeleton.names) - most
    return shown if hidden <= 0 else f"{shown} and {hidden} more"
