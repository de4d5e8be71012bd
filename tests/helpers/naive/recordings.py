"""Positions from the text of a file, features of a pose: one frame and one joint at a time."""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import null_space
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from kineme.recordings import Motion

Floats = NDArray[np.float64]


# --- formats: positions straight from the text of a file, one joint and frame at a time -------


def compute_amc_positions(asf: str, amc: str, frames: Sequence[int]) -> list[dict[str, Floats]]:
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
        values = {
            words[0]: words[1:] for words in map(str.split, records[frame].splitlines()) if words
        }
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
            frame_of = Rotation.from_euler(
                "xyz", [float(x) for x in bone["axis"][:3]], degrees=True
            )
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


def compute_bvh_positions(text: str, frames: Sequence[int]) -> list[list[Floats]]:
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


# --- features: one frame and one joint at a time, on scipy rotations --------------------------


def pose_features(motion: Motion, joints: Sequence[int]) -> Floats:
    """Compute features of a motion whose root is the pelvis, with the body's left at +x."""
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


# --- bundling and mirroring: one frame, one value at a time -----------------------------------


def bundle(features, *, neighbors, variance):
    """Bundle features frame by frame, with a general minimiser for each median."""
    center = features.mean(axis=0)
    _, stretch, axes = np.linalg.svd(features - center, full_matrices=False)
    count = 1
    while (stretch[:count] ** 2).sum() < variance * (stretch**2).sum():
        count += 1
    axes = axes[: max(count, 3)]
    points = (features - center) @ axes.T
    directions = smooth_directions(points)
    moved = []
    for i, (point, direction) in enumerate(zip(points, directions)):
        others = [j for j in range(len(points)) if j != i]
        others.sort(key=lambda j: np.linalg.norm(points[j] - point))
        nearest = points[others[: max(neighbors, len(axes))]]
        across = null_space(direction[None])  # columns: a basis of the hyperplane

        def mean_distance(step, across=across, point=point, nearest=nearest):
            return np.linalg.norm(point + across @ step - nearest, axis=1).mean()

        start = across.T @ (nearest.mean(axis=0) - point)
        best = minimize(mean_distance, start, method="BFGS", options={"gtol": 1e-7})
        moved.append(point + across @ best.x)
    return np.array(moved) @ axes + center


def smooth_directions(points):
    """Average five-point derivatives with binomial weights over existing frames."""
    n = len(points)

    def point(t):
        if t < 0:
            return points[0] + t * (points[1] - points[0])
        if t >= n:
            return points[-1] + (t - n + 1) * (points[-1] - points[-2])
        return points[t]

    slopes = [
        (point(t - 2) - 8 * point(t - 1) + 8 * point(t + 1) - point(t + 2)) / 12 for t in range(n)
    ]
    directions = []
    for t in range(n):
        near = [(comb(10, k), t + k - 5) for k in range(11) if 0 <= t + k - 5 < n]
        mean = sum(weight * slopes[at] for weight, at in near) / sum(weight for weight, _ in near)
        directions.append(mean / np.linalg.norm(mean))
    return np.array(directions)


def mirror_pose(pose):
    """Exchange left and right in the 15 numbers of one frame."""
    left_ankle, right_ankle, head, left_wrist, right_wrist = np.reshape(pose, (5, 3)).tolist()
    exchanged = [right_ankle, left_ankle, head, right_wrist, left_wrist]
    return [number for x, y, z in exchanged for number in (-x, y, z)]


def merge_cuts(main, mirrored, gap):
    """Return the main cuts, and mirrored cuts that are far from the main ones before and after."""
    added = []
    for cut in mirrored:
        before = [m for m in main if m <= cut]
        after = [m for m in main if m >= cut]
        if (not before or cut - max(before) > gap) and (not after or min(after) - cut > gap):
            added.append(cut)
    return sorted({*main, *added})
