"""Where pelvis, hips, ankles, head and wrists are, from markers or keypoints of the usual sets.

A joint of the body is the middle of the points of the first line in `TABLE`
that the recording has whole, left and right the same where both have one. ``*``
stands for the side, L or R. Names are compared in a plain form: upper case, the
side in front, nothing but letters and digits (``R.Wrist.Med``, ``r_wrist_med``
and ``WristMedR`` are all RWRISTMED), without the name of the subject
(``Subject:LANK``).

A hip stands for its side of the pelvis: the line from the right hip to the left
tells where the body faces. It is the middle of the front and back markers, and
not an estimate of the joint's centre.

Sources: marker sets of Vicon Plug-in Gait; CMU Graphics Lab (41 markers);
OptiTrack Motive (Baseline, Biomech, Conventional); Qualisys Animation; CAST
(Cappozzo et al. 1995); OpenSim's example models; keypoints of COCO, OpenPose
BODY_25 and MediaPipe; joint names of BVH, ASF and SMPL skeletons.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence

TABLE: dict[str, tuple[str, ...]] = {
    "pelvis": (
        "PELVIS",
        "LASI RASI LPSI RPSI",  # Plug-in Gait
        "LASI RASI SACR",
        "LFWT RFWT LBWT RBWT",  # CMU
        "LWAISTFRONT RWAISTFRONT LWAISTBACK RWAISTBACK",  # OptiTrack, Qualisys
        "LIAS RIAS LIPS RIPS",  # CAST, OptiTrack Biomech
        "LASIS RASIS LPSIS RPSIS",  # OpenSim
        "LASIS RASIS VSACRAL",
        "MIDHIP",  # OpenPose
        "HIPS",
        "LHIP RHIP",
        "LASI RASI",
        "LASIS RASIS",
    ),
    "*_hip": (
        "*HIP",
        "*HJC",
        "*ASI *PSI",
        "*FWT *BWT",
        "*WAISTFRONT *WAISTBACK",
        "*IAS *IPS",
        "*ASIS *PSIS",
        "*ASI",
        "*ASIS",
        "*UPLEG",
        "*FEMUR",
    ),
    "*_ankle": (
        "*ANKLE",
        "*AJC",
        "*ANKLELAT *ANKLEMED",
        "*ANKLEOUT *ANKLEIN",
        "*LMAL *MMAL",
        "*FAL *TAM",  # CAST
        "*ANK",
        "*ANKLEOUT",
        "*FAL",
        "*FOOT",
        "*HEEL *MIDFOOTSUP",  # OpenSim's gait models
        "*HEEL",
        "*HEE",
    ),
    "head": (
        "HEAD",
        "LFHD RFHD LBHD RBHD",
        "LFHD RFHD",
        "LBHD RBHD",
        "HEADTOP HEADFRONT HEADSIDE",
        "HEADTOP LHEAD RHEAD HEADFRONT",
        "LTEMPLE RTEMPLE TOPHEAD",
        "HEAD1 HEAD2 HEAD3",
        "HEADTOP",
        "LEAR REAR",
        "NOSE",
        "NECK",  # OpenCap and other sets without a marker on the head
        "C7",
        "C7STUDY",
    ),
    "*_wrist": (
        "*WRIST",
        "*WJC",
        "*WRA *WRB",
        "*WRISTOUT *WRISTIN",
        "*WRISTLAT *WRISTMED",
        "*RSP *USP",  # CAST
        "*WRA",
        "*WRB",
        "*WRISTOUT",
        "*HAND",
        "*FIN",
    ),
}
"""For each joint the points that make it, the preferred ones first."""

PARENTS = {
    "pelvis": None,
    "left_hip": "pelvis",
    "right_hip": "pelvis",
    "left_ankle": "left_hip",
    "right_ankle": "right_hip",
    "head": "pelvis",
    "left_wrist": "pelvis",
    "right_wrist": "pelvis",
}
"""Small tree that they form, parents first; every other point hangs on the pelvis."""

_SIDES = {"l": "L", "left": "L", "r": "R", "right": "R"}
_SIDE_AT_THE_END = re.compile(r"([A-Z]+)([lr])")
_NAMELESS = re.compile(r"\*.*|unlabel+ed.*|c_\d{3,}|\d+", re.IGNORECASE)
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")


def find_body(names: Sequence[str], usable: Collection[int]) -> dict[str, tuple[int, ...]]:
    """For each joint of the body that the points at usable indices make up, whose middle it is.

    Names are those of all points, without the subject's.
    """
    at: dict[str, int] = {}
    for point in sorted(usable):
        at.setdefault(plain(names[point]), point)
    found = {}
    for part, lines in TABLE.items():
        sides = {part.replace("*", side): side[0].upper() for side in ("left", "right")}
        made = {
            joint: [_made_of(line, side, at) for line in lines] for joint, side in sides.items()
        }
        both_sides = [all(choices) for choices in zip(*made.values(), strict=True)]
        for joint, choices in made.items():
            chosen = (
                choices[both_sides.index(True)]
                if any(both_sides)
                else next(filter(None, choices), ())
            )
            if chosen:
                found[joint] = chosen
    return {joint: found[joint] for joint in PARENTS if joint in found}


def plain(name: str) -> str:
    """Return a name as `TABLE` has it: ``R.ASIS`` and ``ASISr`` are ``RASIS``."""
    ends = _SIDE_AT_THE_END.fullmatch(name)
    words = list(ends.groups()) if ends else _WORD.findall(name)
    for place, word in enumerate(words):
        if word.lower() in _SIDES:
            words.insert(0, _SIDES[words.pop(place).lower()])
            break
    return "".join(words).upper()


def is_nameless(name: str) -> bool:
    """Return whether a program has called a marker so that nobody had named, as ``*12``."""
    return _NAMELESS.fullmatch(name.rpartition(":")[2]) is not None


def of_one_subject(names: Sequence[str], person: str | None = None) -> tuple[list[str], list[str]]:
    """Return the names without the subject's, and the subjects whose points make up a pelvis.

    ``Ann:LANK`` becomes ``LANK`` for that person of those subjects, else the first, or where
    all names begin with the same one; points of others keep their full names.
    """
    points: dict[str, list[int]] = {}
    for i, name in enumerate(names):
        points.setdefault(name.rpartition(":")[0], []).append(i)
    short = [name.rpartition(":")[2] for name in names]
    subjects = [who for who, members in points.items() if "pelvis" in find_body(short, members)]
    chosen = names[0].rpartition(":")[0] if len(points) == 1 else ""
    if subjects:
        chosen = person if person in subjects else subjects[0]
    members = set(points.get(chosen, ()))
    return [short[i] if i in members else name for i, name in enumerate(names)], subjects


def described(body: Mapping[str, Iterable[int]], names: Sequence[str]) -> str:
    """One line for people: ``left ankle from LANK, ...``."""
    return ", ".join(
        f"{joint.replace('_', ' ')} from {' '.join(names[i] for i in made_of)}"
        for joint, made_of in body.items()
    )


def _made_of(line: str, side: str, at: Mapping[str, int]) -> tuple[int, ...]:
    """Return the points that a line of the table names, none unless all are there."""
    points = line.replace("*", side).split()
    return tuple(at[name] for name in points) if all(name in at for name in points) else ()
