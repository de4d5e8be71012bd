"""Slow, literal versions of the formulas: the oracle of every fast path."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from kineme.motion import Motion

Floats = NDArray[np.float64]


# --- features: one frame and one joint at a time, on scipy rotations --------------------------


def pose_features(motion: Motion, joints: Sequence[int]) -> Floats:
    """Features of a motion whose root is its pelvis and has the body's left at +x."""
    rows = []
    for pose, quaternions in zip(motion.positions, motion.rotations, strict=True):
        to_left = Rotation.from_quat(quaternions[0], scalar_first=True).apply([1.0, 0.0, 0.0])
        turn = Rotation.from_euler("y", np.arctan2(to_left[2], to_left[0]))
        rows.append(np.concatenate([turn.apply(pose[joint] - pose[0]) for joint in joints]))
    return np.array(rows)


def stack(features: Floats, offsets: Sequence[int]) -> Floats:
    n = len(features)
    rows = []
    for t in range(n):
        row = []
        for offset in sorted(offsets):
            at = t + offset
            if at < 0:
                row.append(features[0] + at * (features[min(1, n - 1)] - features[0]))
            elif at >= n:
                beyond = at - (n - 1)
                row.append(features[-1] + beyond * (features[-1] - features[max(n - 2, 0)]))
            else:
                row.append(features[at])
        rows.append(np.concatenate(row))
    return np.array(rows)


# --- evaluation ---------------------------------------------------------------------------


def one_to_one(wanted, given):
    """The best share of frames over every assignment of found labels to classes."""
    from itertools import permutations

    classes, names = sorted(set(wanted)), sorted(set(given))
    fixed = "transition" in names
    if fixed:
        names.remove("transition")
        classes = [c for c in classes if c != "transition"]
    slots = classes + [None] * len(names)
    best = 0
    for chosen in set(permutations(slots, len(names))):
        to = dict(zip(names, chosen))
        if fixed:
            to["transition"] = "transition"
        best = max(best, sum(to[g] == w for g, w in zip(given, wanted)))
    return best / len(wanted)


def strict_tolerant(truth, found):
    """The paper's accuracy with closed spans, one interval at a time."""
    last = truth.frames - 1
    intervals, start = [], 0
    for earliest, latest in zip(truth.earliest, truth.latest):
        intervals += [(start, earliest, True), (earliest, latest, False)]
        start = latest
    intervals.append((start, last, True))
    owned = [[] for _ in intervals]
    for a, b in zip(found.borders[:-1], found.borders[1:]):
        b = min(b, last)
        shares = [max(0, min(b, e) - max(a, s) + 1) / (b - a + 1) for s, e, _ in intervals]
        owned[shares.index(max(shares))].append((a, b))
    covered = lengths = covered_certain = lengths_certain = 0
    for (s, e, certain), own in zip(intervals, owned):
        inside = 0
        if own:
            inside = max(0, min(e, max(b for _, b in own)) - max(s, min(a for a, _ in own)) + 1)
        covered += inside
        lengths += e - s + 1
        if certain:
            covered_certain += inside
            lengths_certain += e - s + 1
    return covered / lengths, covered_certain / lengths_certain


def warped_cost(cost):
    """Dynamic time warping by its recursion."""
    total = np.full((cost.shape[0] + 1, cost.shape[1] + 1), np.inf)
    total[0, 0] = 0
    for i in range(cost.shape[0]):
        for j in range(cost.shape[1]):
            total[i + 1, j + 1] = cost[i, j] + min(total[i, j], total[i, j + 1], total[i + 1, j])
    return total[-1, -1]


def cloud_distance(points, i, j, *, half):
    """Kovar and Gleicher's distance by trying every turn in steps of 0.1 degrees."""
    a, b = (points[f - half : f + half + 1].reshape(-1, 3) for f in (i, j))
    best = np.inf
    for angle in np.arange(0, 2 * np.pi, np.radians(0.1)):
        c, s = np.cos(angle), np.sin(angle)
        turned = b @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
        difference = a - turned
        difference[:, [0, 2]] -= difference[:, [0, 2]].mean(axis=0)
        best = min(best, (difference**2).sum() / len(a))
    return best**0.5


# --- formats: positions straight from the text of a file, one joint and frame at a time -------


def amc_positions(asf: str, amc: str, frames: Sequence[int]) -> list[dict[str, Floats]]:
    """Where each bone starts and ends, in metres, by bone: [start, tip]; CMU's dialect only."""
    unit = 0.0254 / float(asf.split("length")[1].split()[0])
    bones = {}
    for block in asf.split(":bonedata")[1].split(":hierarchy")[0].split("begin")[1:]:
        line = {words[0]: words[1:] for words in map(str.split, block.splitlines()) if words}
        bones[line["name"][0]] = line
    parents = {}
    for line in asf.split(":hierarchy")[1].splitlines():
        for child in line.split()[1:]:
            parents[child] = line.split()[0]
    records = re.split(r"^\d+\s*$", amc, flags=re.MULTILINE)[1:]
    results = []
    for frame in frames:
        values = {words[0]: words[1:] for words in map(str.split, records[frame].splitlines()) if words}
        move = [float(x) for x in values["root"]]
        at = {"root": np.array([[0.0, 0, 0], [0, 0, 0]]) + unit * np.array(move[:3])}
        turned = {"root": Rotation.from_euler("xyz", move[3:], degrees=True)}
        waiting = list(parents)
        while waiting:
            name = waiting.pop(0)
            if parents[name] not in at:
                waiting.append(name)
                continue
            bone = bones[name]
            frame_of = Rotation.from_euler("xyz", [float(x) for x in bone["axis"][:3]], degrees=True)
            angles = dict(zip(bone.get("dof", []), map(float, values.get(name, [])), strict=True))
            own = Rotation.from_euler(
                "xyz", [angles.get("rx", 0), angles.get("ry", 0), angles.get("rz", 0)], degrees=True
            )
            turned[name] = turned[parents[name]] * frame_of * own * frame_of.inv()
            way = unit * float(bone["length"][0]) * np.array([float(x) for x in bone["direction"]])
            start = at[parents[name]][1]
            at[name] = np.array([start, start + turned[name].apply(way)])
        results.append(at)
    return results


def bvh_positions(text: str, frames: Sequence[int]) -> list[list[Floats]]:
    """Where each joint and end site is, in file units and order; tidy files only."""
    hierarchy, motion = text.split("MOTION")
    rows = [line.split() for line in motion.strip().splitlines()[2:]]
    results = []
    for frame in frames:
        row = [float(x) for x in rows[frame]]
        at, stack = [], []
        offset = None
        for line in hierarchy.splitlines():
            words = line.split()
            if not words or words[0] in ("HIERARCHY", "ROOT", "JOINT", "{"):
                continue
            above = stack[-1] if stack else (np.zeros(3), Rotation.identity())
            if words[0] == "OFFSET":
                offset = np.array([float(x) for x in words[1:]])
                at.append(above[0] + above[1].apply(offset))
                stack.append((at[-1], above[1]))
            elif words[0] == "CHANNELS":
                stack.pop()
                above = stack[-1] if stack else (np.zeros(3), Rotation.identity())
                own = Rotation.identity()
                for channel in words[2:]:
                    value, row = row[0], row[1:]
                    axis = "XYZ".index(channel[0])
                    if "position" in channel:
                        offset[axis] = value
                    else:
                        own = own * Rotation.from_euler("xyz"[axis], value, degrees=True)
                at[-1] = above[0] + above[1].apply(offset)
                stack.append((at[-1], above[1] * own))
            elif words[0] == "}":
                stack.pop()
        results.append(at)
    return results
