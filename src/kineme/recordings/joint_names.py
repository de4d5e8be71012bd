"""Find joints by their names: the table of names and the matcher.

`NAMES` lists how rigs, marker sets, keypoint models and sensors call each part of the body. To
support another naming, add to the table and nowhere else.

*Notation.* A line of the table names one point, or several with the joint in their middle. ``*``
stands for the side, L or R. Names are compared in a plain form: upper case, the side first, only
letters and digits. ``R.Wrist.Med``, ``r_wrist_med`` and ``WristMedR`` are all RWRISTMED.

*Matching.* A joint is the first line with all its points in the recording. Lines that match on both
sides come before those that match on one. Names of markers must equal the line. Names of rigs also
match without their namespace and numbers (``mixamorig:LeftHand_035``). If none is equal, words may
precede the line (``m_avg_L_Ankle``); the fewest such words win (``foot_l`` before
``weapon_foot_l``), then the point nearer to the root.

Sources: marker sets of Vicon Plug-in Gait; CMU Graphics Lab (41 markers); OptiTrack Motive
(Baseline, Biomech, Conventional); Qualisys Animation; CAST (Cappozzo et al. 1995); OpenSim's
example models; keypoints of COCO, OpenPose BODY_25 and MediaPipe; rigs of CMU and HDM05 ASF,
cgspeed, Mixamo, HumanIK, Perception Neuron, SMPL, Xsens, Rokoko, Biped, Unreal, VRM and Kinect.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import lru_cache

SIDES = ("left", "right")

# fmt: off
NAMES: dict[str, tuple[str, ...]] = {
    "pelvis": (
        "PELVIS",
        "LASI RASI LPSI RPSI", "LASI RASI SACR",  # Plug-in Gait
        "LFWT RFWT LBWT RBWT",  # CMU
        "LWAISTFRONT RWAISTFRONT LWAISTBACK RWAISTBACK",  # OptiTrack, Qualisys
        "LIAS RIAS LIPS RIPS",  # CAST, OptiTrack Biomech
        "LASIS RASIS LPSIS RPSIS", "LASIS RASIS VSACRAL",  # OpenSim
        "MIDHIP",  # OpenPose
        "HIPS", "LHIP RHIP", "LASI RASI", "LASIS RASIS",
    ),
    # One side of the pelvis replaces the hip in marker sets without it.
    "*_waist": ("*ASI *PSI", "*FWT *BWT", "*WAISTFRONT *WAISTBACK", "*IAS *IPS", "*ASIS *PSIS",
                "*ASI", "*ASIS"),
    "*_waist_front": ("*ASIS", "*ASI", "*IAS", "*FWT"),
    "*_waist_back": ("*PSIS", "*PSI", "*IPS", "*BWT"),
    "sacrum": ("VSACRAL", "SACR", "SACRAL"),
    "*_hip": ("*HIP",),
    "*_hip_centre": ("*HJC",),
    "*_thigh": ("*UPLEG", "*UPPERLEG", "*THIGH", "*FEMUR"),
    "*_knee": ("*KNEE", "*KJC", "*KNEELAT *KNEEMED", "*KNEEOUT *KNEEIN", "*FLE *FME", "*KNE",
               "*KNEEOUT", "*KNEELAT", "*LEK", "*FLE"),
    "*_shank": ("*LEG", "*LOWERLEG", "*SHIN", "*CALF"),
    "*_ankle": ("*ANKLE", "*AJC", "*ANKLELAT *ANKLEMED", "*ANKLEOUT *ANKLEIN", "*LMAL *MMAL",
                "*FAL *TAM", "*LM *MM", "*ANK", "*ANKLEOUT", "*ANKLELAT", "*FAL", "*LM"),
    "*_outer_ankle": ("*ANK", "*ANKLEOUT", "*ANKLELAT", "*LMAL", "*FAL", "*LM"),
    "*_foot": ("*FOOT",),
    "*_rear_foot": ("*HEEL *MIDFOOTSUP", "*HEEL", "*HEE"),  # OpenSim's gait models
    "*_heel": ("*HEEL", "*HEE", "*CALCANEUS", "*FCC", "*CAL", "*CALC", "*CA", "*FERSE"),
    "*_toe": ("*TOE", "*TOEBASE", "*TOES", "*BIGTOE", "*TOETIP", "*FOOTINDEX", "*MT", "*MTP",
              "*FM", "*MTH", "*HALLUX", "*HLX", "*ZEHE"),
    "head": ("HEAD", "LFHD RFHD LBHD RBHD", "LFHD RFHD", "LBHD RBHD",
             "HEADTOP HEADFRONT HEADSIDE", "HEADTOP LHEAD RHEAD HEADFRONT",
             "LTEMPLE RTEMPLE TOPHEAD", "HEAD1 HEAD2 HEAD3", "HEADTOP"),
    "face": ("LEAR REAR", "NOSE"),
    "neck": ("NECK", "C7", "C7STUDY"),  # OpenCap and other sets without a marker on the head
    "*_shoulder": ("*SHOULDER", "*SJC", "*SHO", "*SHOULDERTOP", "*ACROMION", "*ACROMIUM", "*ACR"),
    "*_upper_arm": ("*UPPERARM", "*ARM"),
    "*_elbow": ("*ELBOW", "*EJC", "*ELBOWLAT *ELBOWMED", "*ELBOWOUT *ELBOWIN", "*HLE *HME",
                "*ELB", "*ELBOWOUT", "*ELBOWLAT", "*ELBLAT"),
    "*_forearm": ("*FOREARM",),
    "*_wrist": ("*WRIST", "*WJC", "*WRA *WRB", "*WRISTOUT *WRISTIN", "*WRISTLAT *WRISTMED",
                "*RSP *USP", "*WRA", "*WRB", "*WRISTOUT"),
    "*_hand": ("*HAND", "*FIN"),
    # Where sensors are worn: lf_gyr_x, footl_gyr_x.
    "*_foot_sensor": ("*FOOT", "FOOT*", "*F"),
    "*_shank_sensor": ("*SHANK", "SHANK*", "*S", "*ANKLE", "ANKLE*"),  # strapped above the ankle
}
"""Names of the points that make each part, the preferred line first."""
# fmt: on

PARENTS = {
    "pelvis": None,
    **dict.fromkeys(("left_hip", "right_hip"), "pelvis"),
    "left_ankle": "left_hip",
    "right_ankle": "right_hip",
    **dict.fromkeys(("head", "left_wrist", "right_wrist"), "pelvis"),
}
"""Parents of the joints of a body made from points, parents first."""
_BODY = (
    ("pelvis",),
    ("*_hip", "*_hip_centre", "*_waist", "*_thigh"),
    ("*_ankle", "*_foot", "*_rear_foot"),
    ("head", "face", "neck"),
    ("*_wrist", "*_hand"),
)

RIGS: dict[str, tuple[frozenset[str], dict[str, str]]] = {
    # A joint of an ASF has the name of the bone that begins there. The program of Voegele et al.
    # follows the tips of ltibia, rtibia, head, lwrist and rwrist.
    "ASF": (
        frozenset({"ltibia", "rtibia", "head", "lradius", "lwrist", "rwrist"}),
        {"left_ankle": "lfoot", "right_ankle": "rfoot", "head": "head_end",
         "left_wrist": "lhand", "right_wrist": "rhand"},
    ),
}  # fmt: skip
"""Rigs with misleading joint names: the names that identify each, and the joints to use."""

TWIST = frozenset({"TWIST", "ROLL"})
"""Words in names of joints that only twist a bone."""
CROWN = frozenset({"END", "TOP", "TIP", "NUB", "CROWN", "SITE"})
"""Words in the name of the end site of a head."""
GYROSCOPE = frozenset({"GYR", "GYRO", "GYROSCOPE", "OMEGA", "ANGULARVELOCITY"})
"""Words in names of gyroscope channels."""
SENSOR = re.compile(
    r"acc(el\w*)?|gyr(o\w*)?|mag(net\w*)?|imu|emg|grf|forces?|moments?|torques?|cop|gravity|"
    r"angular|angles?|rot(ation)?|euler|attitude|velocity|vel|quat(ernion)?|orient(ation)?|"
    r"omega|[agwm]",
    re.IGNORECASE,
)
"""Matches a word that marks coordinates as those of a sensor, not of a joint."""

_OTHERS = TWIST | {"IK", "POLE", "TARGET", "CTRL", "PROP", "GOAL"}
_OTHER_PARTS = (["UP"], ["UPPER"], ["FORE"], ["LOWER"], ["LOW"])
_LETTERS = {"L": "L", "LEFT": "L", "R": "R", "RIGHT": "R"}
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_SIDE_AT_THE_END = re.compile(r"([A-Z]+)([lr])")  # ASISr; of markers only
_SIDE_INSIDE = re.compile("(left|right)", re.IGNORECASE)  # leftfoot
_MOST_WORDS = 4  # of a name in the table
_NAMELESS = re.compile(r"\*.*|unlabel+ed.*|c_\d{3,}|\d+", re.IGNORECASE)


def find_joints(
    names: Sequence[str],
    wanted: Iterable[Sequence[str]],
    *,
    usable: Collection[int] | None = None,
    exact: bool = False,
    single: bool = False,
) -> dict[str, tuple[int, ...]]:
    """Return the points whose mean is the joint, for each joint that is found.

    ``names`` has one per point, parents before children. ``wanted`` lists for each joint the parts
    in `NAMES` to look for, the preferred one first, which also names the joint, with "left" and
    "right" for ``*``. ``usable`` are the indices of the points to choose from, all by default.
    ``exact`` compares full names only, as for markers; ``single`` ignores lines of several points.

    Examples
    --------
    >>> find_joints(["Hips", "LeftFoot", "RightFoot"], [("pelvis",), ("*_ankle", "*_foot")])
    {'pelvis': (0,), 'left_ankle': (1,), 'right_ankle': (2,)}
    """
    points = range(len(names)) if usable is None else sorted(usable)
    # The first of several points with one name counts: it is nearer to the root.
    equal = {simplify_name(names[point]): point for point in reversed(points)}
    levels = [equal] if exact else _index_rig(tuple(names), tuple(points))
    found: dict[str, tuple[int, ...]] = {}
    for parts in wanted:
        lines = [line for part in parts for line in NAMES[part] if not (single and " " in line)]
        letters = {parts[0].replace("*", side): side[0].upper() for side in SIDES}
        for at in levels:
            for joint, chosen in _choose(lines, letters, at).items():
                found.setdefault(joint, chosen)
    return found


def find_body(names: Sequence[str], usable: Collection[int]) -> dict[str, tuple[int, ...]]:
    """Return the markers or keypoints whose mean is the joint, for each joint in `PARENTS`.

    A side of the pelvis replaces a missing hip: it shows where the body faces, but is no estimate
    of the joint's centre. Names do not include the subject's; ``usable`` are the indices of the
    points to choose from.
    """
    return find_joints(names, _BODY, usable=usable, exact=True)


def find_rig_joints(names: Sequence[str]) -> tuple[str, dict[str, int]]:
    """Return the key in `RIGS` that matches a skeleton, or "", and the joints it defines."""
    for rig, (bones, joints) in RIGS.items():
        if bones.issubset(names):
            return rig, {joint: names.index(at) for joint, at in joints.items() if at in names}
    return "", {}


@lru_cache(maxsize=4096)
def mentions(name: str, *parts: str, side: str = "") -> bool:
    """Return whether a name contains a part, on any side unless one is given.

    Examples
    --------
    >>> mentions("LeftToeBase_End", "*_toe"), mentions("lf_gyr_x", "*_foot_sensor", side="right")
    (True, False)
    """
    letters = [side[0].upper()] if side else ["L", "R", ""]
    # A line with spaces lists several markers, so it is not a single name.
    lines = [line for part in parts for line in NAMES[part] if " " not in line]
    return has_word(name, {line.replace("*", letter) for line in lines for letter in letters})


def has_word(name: str, words: Collection[str]) -> bool:
    """Return whether consecutive words of a name, with or without its side, form one of ``words``.

    Numbers are ignored.
    """
    side, spelled = _split_rig_name(name)
    runs = {
        "".join(spelled[start : start + length])
        for start in range(len(spelled))
        for length in range(1, _MOST_WORDS + 1)
    }
    return not runs.union(side + run for run in runs).isdisjoint(words)


def simplify_name(name: str) -> str:
    """Return a name in the plain form of `NAMES`.

    Examples
    --------
    >>> simplify_name("R.ASIS"), simplify_name("ASISr"), simplify_name("leftFoot_2")
    ('RASIS', 'RASIS', 'LFOOT2')
    """
    if ends := _SIDE_AT_THE_END.fullmatch(name):
        return ends[2].upper() + ends[1]
    side, words = _split(name)
    return side + "".join(words)


def is_nameless(name: str) -> bool:
    """Return whether the name of a marker was generated by a program, such as ``*12``."""
    return _NAMELESS.fullmatch(name.rpartition(":")[2]) is not None


@lru_cache(maxsize=4096)
def _split(name: str) -> tuple[str, tuple[str, ...]]:
    """Return the side in a name (L, R or empty) and its other words."""
    parts = (part for word in _WORD.findall(name) for part in _SIDE_INSIDE.split(word))
    words = [part.upper() for part in parts if part]
    for place, word in enumerate(words):
        if word in _LETTERS:
            return _LETTERS[word], (*words[:place], *words[place + 1 :])
    return "", tuple(words)


def _split_rig_name(name: str, *, numbers: bool = False) -> tuple[str, list[str]]:
    """Return the side and the words of a name without its namespace or path."""
    side, words = _split(re.split(r"[:|]", name)[-1])
    return side, [word for word in words if numbers or not word.isdigit()]


@lru_cache(maxsize=16)
def _index_rig(names: tuple[str, ...], points: tuple[int, ...]) -> list[dict[str, int]]:
    """Return two indexes of a rig's points: by whole names, and also by ends of names."""
    ranked = []
    for point in points:
        side, words = _split_rig_name(names[point], numbers=True)
        ranked.append((0, 0, point, side + "".join(words)))
        words = [word for word in words if not word.isdigit()]
        for before in range(max(0, len(words) - _MOST_WORDS), len(words)):
            # Helpers are no joints, and an upper leg is no leg.
            if _OTHERS.intersection(words[:before]) or words[before - 1 : before] in _OTHER_PARTS:
                continue
            ranked.append((before, 1, point, side + "".join(words[before:])))
    equal: dict[str, int] = {}
    every: dict[str, int] = {}
    for before, _, point, name in sorted(ranked):
        every.setdefault(name, point)
        if before == 0:
            equal.setdefault(name, point)
    return [equal, every]


def _choose(
    lines: Sequence[str], letters: Mapping[str, str], at: Mapping[str, int]
) -> dict[str, tuple[int, ...]]:
    """Return the points of the joints of both sides, from the best of several ways to find them.

    ``lines`` are names of one point or several, with ``*`` for a letter of the side, best first.
    The first line that is found on both sides is used, else the first that is found on each.
    """
    candidates = {
        joint: [_find_points(line.replace("*", letter), at) for line in lines]
        for joint, letter in letters.items()
    }
    # Left and right are compared with each other, so both use the same markers.
    shared = next(
        (i for i, each in enumerate(zip(*candidates.values(), strict=True)) if all(each)), None
    )
    chosen = {
        joint: next(filter(None, choices), ()) if shared is None else choices[shared]
        for joint, choices in candidates.items()
    }
    return {joint: points for joint, points in chosen.items() if points}


def _find_points(line: str, at: Mapping[str, int]) -> tuple[int, ...]:
    """Return the points that a line names, or none if one of them is missing."""
    points = line.split()
    return tuple(at[name] for name in points) if all(name in at for name in points) else ()
