"""Slow, literal versions of the formulas: the oracle of every fast path."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import combinations, pairwise
from math import comb

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import null_space
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from kineme.recordings import Motion

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


def amc_rows(text: str, counts: Mapping[str, int]) -> list[list[float]] | None:
    """Number and values of each frame, whose bones come in this order; None if they do not."""
    words, rows = text.split(), []
    try:
        while words:
            row = [float(words.pop(0))]
            for name, count in counts.items():
                if words.pop(0) != name:
                    return None
                row += [float(words.pop(0)) for _ in range(count)]
            rows.append(row)
    except (IndexError, ValueError):
        return None
    return rows


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


# --- neighbour graph and warping paths: pair by pair ------------------------------------------
# A graph is a dict of stored pairs {(i, j): distance}; a path is a list of pairs.


def neighbors(features, others=None, *, radius, k=None, max_lag=None):
    others = features if others is None else others
    pairs = {}
    for i, x in enumerate(features):
        for j, y in enumerate(others):
            distance = np.sqrt(sum((a - b) ** 2 for a, b in zip(x, y, strict=True)))
            if distance <= radius and (max_lag is None or abs(j - i) <= max_lag):
                pairs[i, j] = np.float32(distance)
    return pairs if k is None else nearest(pairs, k)


def nearest(pairs, k):
    kept = {}
    for row in {i for i, _ in pairs}:
        found = sorted((distance, j) for (i, j), distance in pairs.items() if i == row)
        kept |= {(row, j): distance for distance, j in found[:k]}
    return kept


def components(pairs, steps):
    """The first pair, in order of rows and columns, that each pair is connected with."""
    edges = {pair: set() for pair in pairs}
    for t, j in pairs:
        for a, b in steps:
            if (t + a, j + b) in pairs:
                edges[t, j].add((t + a, j + b))
                edges[t + a, j + b].add((t, j))
    firsts = {}
    for pair in sorted(pairs):
        waiting = [] if pair in firsts else [pair]
        while waiting:
            at = waiting.pop()
            if at not in firsts:
                firsts[at] = pair
                waiting += edges[at]
    return firsts


def cheapest_paths(pairs, rows, columns, *, steps, skip_penalty, zero_cost, separation=None):
    """Paths and costs of every component of a box, by relaxing edges until nothing changes."""
    inside = {
        (t, j): float(distance) or zero_cost
        for (t, j), distance in pairs.items()
        if rows[0] <= t < rows[1] and columns[0] <= j < columns[1]
    }
    firsts = components(inside, steps)
    found = []
    for first in set(firsts.values()):
        nodes = sorted(pair for pair in inside if firsts[pair] == first)
        top, bottom = nodes[0][0], nodes[-1][0]
        if top == bottom:
            continue
        best = {node: (inside[node], [node]) for node in nodes if node[0] == top}
        changed = True
        while changed:
            changed = False
            for t, j in list(best):
                for a, b in steps:
                    to = (t + a, j + b)
                    if to not in inside:
                        continue
                    passed_over = max(0, a - 1) + max(0, b - 1)
                    cost = best[t, j][0] + inside[to] + skip_penalty * passed_over
                    if to not in best or cost < best[to][0] - 1e-12:
                        best[to] = (cost, [*best[t, j][1], to])
                        changed = True
        kept = []
        for cost, path in sorted(best[node] for node in best if node[0] == bottom):
            away = separation if separation is not None else np.inf
            if all(abs(path[0][1] - other[0][1]) >= away for _, other in kept):
                kept.append((cost, path))
        found += kept
    return found


# --- segmentation: the rules as written, frames counted from 1 inside -------------------------


def growing_squares(pairs, n, *, min_gap, min_count, min_distance):
    """Forward and backward cuts (0-based) of square regions, each count taken anew."""

    def count(a, b):
        return sum(a <= t + 1 <= b and a <= j + 1 <= b for t, j in pairs)

    c = {}
    sf = last = 1
    z = 0
    for i in range(2, n + 1):
        c[i] = count(sf, i)
        if c[i] == c.get(i - 1):
            z += 1
            if z == min_gap:
                if any(c.get(f, 0) > min_count for f in range(last, i + 1)):
                    last, sf = i - z, i
                z = 0
        else:
            z = 0
    forward = peaks(c, min_count, min_distance)

    c = {}
    ef = last = n
    z = 0
    for i in range(n - 1, 0, -1):
        c[i] = count(i, ef)
        if i in forward:
            last = ef = i
        elif c[i] == c.get(i + 1):
            z += 1
            if z == min_gap:
                z = 0
                if any(c.get(f, 0) > min_count for f in range(i, last + 1)):
                    last = ef = i
        else:
            z = 0
    backward = [min(peak + min_gap, n) for peak in peaks(c, min_count, min_distance)]
    return [cut - 1 for cut in forward], [cut - 1 for cut in backward]


def peaks(c, min_height, min_distance):
    """Keys of ``c`` at peaks: a rise before, and a fall at the next change after."""
    found = []
    for i in sorted(c):
        if i - 1 in c and c[i] > c[i - 1] and c[i] > min_height:
            after = i
            while after in c and c[after] == c[i]:
                after += 1
            if after in c and c[after] < c[i]:
                found.append(i)
    kept = []
    for peak in sorted(found, key=lambda i: (-c[i], i)):
        if all(abs(peak - other) > min_distance for other in kept):
            kept.append(peak)
    return sorted(kept)


def scanned_lines(pairs, n, *, min_gap, min_count):
    """Forward and backward cuts (0-based) of regions scanned line by line."""
    forward, backward = [], []
    s, blob, z = 1, 0, 0
    for i in range(1, n + 1):
        c = sum(t + 1 == i and s <= j + 1 <= i for t, j in pairs)
        blob += c
        if c > 0:
            z = 0
        else:
            z += 1
            if z >= min_gap and blob > min_count:
                forward.append(i - z)
                s, blob, z = i - z, 0, 0
    e, blob, z = n, 0, 0
    for i in range(n, 0, -1):
        c = sum(t + 1 == i and i <= j + 1 <= e for t, j in pairs)
        blob += c
        if i in forward:
            e, blob, z = i, 0, 0
        elif c > 0:
            z = 0
        else:
            z += 1
            if z >= min_gap and blob > min_count:
                backward.append(i + z)
                e, blob, z = i + z, 0, 0
    return [cut - 1 for cut in forward], sorted(cut - 1 for cut in backward)


def inner_neighbors(pairs, borders):
    """For each frame the neighbours in its own block."""
    block_of = [b for b in range(len(borders) - 1) for _ in range(borders[b], borders[b + 1])]
    counts = [0] * len(block_of)
    for i, j in pairs:
        counts[i] += block_of[i] == block_of[j]
    return counts


def symmetric_paths(paths, share):
    """Which paths have another, or themselves, that matches their frames the other way round."""
    return [
        any(
            sum(t in {j for _, j in q} for t, _ in p) >= share * len(p)
            and sum(j in {t for t, _ in q} for _, j in p) >= share * len(p)
            for q in paths
        )
        for p in paths
    ]


def chosen_cuts(paths, activity, *, min_length):
    """Starts of paths at a distance from the activity's ends and from starts of longer ones."""
    first, last = activity
    kept = []
    for path in sorted(paths, key=len, reverse=True):
        cut = path[0][1]
        if first + min_length <= cut <= last - min_length:
            if not any(abs(cut - other) < min_length for other in kept):
                kept.append(cut)
    return sorted(kept)


def linked_segments(paths, borders, g, *, coverage, interpolate):
    """Segments that paths through segment g cover enough of, and the share covered."""

    def overlap(a, b, c, d):
        return len(set(range(a, b + 1)) & set(range(c, d + 1))) / (b - a + 1)

    def row(path, v):
        reached = [at for at in range(len(path)) if path[at][1] <= v] or [0]
        t, j = path[reached[-1]]
        if j < v and reached[-1] + 1 < len(path):
            return int(np.floor((t + 1 + path[reached[-1] + 1][0] + 1) / 2 + 0.5)) - 1
        return t

    links = []
    for path in paths:
        f0, f1 = path[0][1], path[-1][1]
        for h in range(len(borders) - 1):
            r0, r1 = borders[h], borders[h + 1]
            if r1 < f0 or r0 > f1:
                continue
            rows = (row(path, r0), row(path, r1)) if interpolate else (path[0][0], path[-1][0])
            share = min(overlap(r0, r1, f0, f1), overlap(borders[g], borders[g + 1], *rows))
            if share >= coverage:
                links.append((h, share))
    return links


def clusters(links, connection):
    """Labels by first appearance: segments that links lead between, both ways if strong."""
    n = len(links)
    reached = np.eye(n, dtype=bool)
    for g, targets in enumerate(links):
        reached[g, list(targets)] = True
    if connection == "weak":
        reached |= reached.T
    for _ in range(n):
        reached = (reached.astype(int) @ reached.astype(int)) > 0
    together = reached & reached.T
    firsts = [int(np.argmax(row)) for row in together]
    order = sorted(set(firsts))
    return [order.index(first) for first in firsts]


# --- ACA and HACA (Zhou, De la Torre, Hodgins 2013): the programs' loops, entry by entry ---


def dtak(kernel, a_weights, b_weights):
    """Dynamic time alignment kernel of two segments, from the kernel between their frames."""
    n, m = kernel.shape
    table = np.empty((n, m))
    for i in range(n):
        for j in range(m):
            k, wi, wj = kernel[i, j], a_weights[i], b_weights[j]
            steps = [(wi + wj) * k] if i == j == 0 else []
            if i:
                steps.append(table[i - 1, j] + wi * k)
            if j:
                steps.append(table[i, j - 1] + wj * k)
            if i and j:
                steps.append(table[i - 1, j - 1] + (wi + wj) * k)
            table[i, j] = max(steps)
    return table[-1, -1] / (sum(a_weights) + sum(b_weights))


def propagated_kernel(kernel, longest):
    """Entry (a, b), a < b: the best square of width 1 to longest that has it as a corner."""
    n = len(kernel)
    out = np.eye(n)
    for w in range(1, longest + 1):
        for i in range(n - w):
            for j in range(i + 1, n - w):
                shared = min(kernel[i, j], kernel[i + w, j + w])
                for a, b in ((i, j), (i + w, j + w), (i, j + w), (i + w, j)):
                    if a < b:
                        out[a, b] = out[b, a] = max(out[a, b], shared)
    return out


def covers(n, shortest, longest):
    """Every way to cut n frames into lengths of shortest to longest."""
    if n == 0:
        return [[]]
    ways = []
    for last in range(shortest, min(longest, n) + 1):
        ways += [[*way, last] for way in covers(n - last, shortest, longest)]
    return ways


def cover_cost(costs, lengths):
    """Total cost of consecutive windows of these lengths."""
    stops = np.cumsum(lengths)
    return sum(costs[stop - 1, length - 1] for stop, length in zip(stops, lengths, strict=True))


def first_segmentation(labels, shortest, longest):
    """Segment lengths as the program's ``mergeDP`` finds them, its slip included."""
    n = len(labels)
    best, length_at = [0.0] + [None] * n, [0] * (n + 1)
    for v in range(1, n + 1):
        for length in range(shortest, min(longest, v) + 1):
            if best[v - length] is None:
                continue
            window = list(labels[v - length : v])
            cost = best[v - length] + length - max(window.count(c) for c in set(window))
            if best[v] is None or shortest < best[v]:
                best[v], length_at[v] = cost, length
    lengths, v = [], n
    while v:
        lengths.insert(0, length_at[v])
        v -= length_at[v]
    return lengths


# --- PCA and probabilistic PCA segmentation (Barbič et al. 2004), one model at a time ---


def pca_cut(features, first, lag):
    """First frame whose projection error rises by more than mean + 3 deviations, or None."""

    def spectrum(count):
        part = features[:count]
        return np.linalg.svd(part - part.mean(axis=0), compute_uv=False) ** 2

    n = len(features)
    if n < first + 2 * lag:
        return None
    start = spectrum(first)
    kept = next(r for r in range(1, len(start) + 1) if start[:r].sum() / start.sum() > 0.9)
    error = {i: spectrum(i)[kept:].sum() for i in range(first, n + 1)}
    rises = []
    for i in range(first + lag, n + 1):
        rise = error[i] - error[i - lag]
        if len(rises) >= lag and rise > np.mean(rises) + 3 * np.std(rises):
            return i
        rises.append(rise)
    return None


def ppca_distances(features, ahead, growth):
    """H by number of frames modelled."""
    found = {}
    for count in range(ahead, len(features) - ahead + 1, growth):
        part, following = features[:count], features[count : count + ahead]
        _, sigma, axes = np.linalg.svd(part - part.mean(axis=0), full_matrices=True)
        variances = np.zeros(features.shape[1])
        variances[: len(sigma)] = sigma**2 / (count - 1)
        share = np.cumsum(variances) / variances.sum()
        kept = min(int(np.argmax(share > 0.95)) + 1, len(variances) - 1)
        variances[kept:] = variances[kept:].mean()
        inverse = np.linalg.inv(axes.T @ np.diag(variances) @ axes)
        off = following - part.mean(axis=0)
        found[count] = np.mean([x @ inverse @ x for x in off])
    return found


def ppca_cut(features, ahead, growth):
    """First peak of H a tenth of its range above the lowest H before it, or None."""
    found = ppca_distances(features, ahead, growth)
    counts, values = list(found), list(found.values())
    for i in range(1, len(values) - 1):
        peak = values[i] > values[i - 1] and values[i] >= values[i + 1]
        if peak and values[i] - min(values[:i]) >= (max(values) - min(values)) / 10:
            return counts[i]
    return None


# --- bundling and mirroring: one frame, one value at a time -----------------------------------


def bundle(features, *, neighbors, variance):
    """Features bundled frame by frame; each median by a general minimiser."""
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
    """Five-point derivatives, averaged with binomial weights over the frames there are."""
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


def mirrored_pose(pose):
    """One frame's 15 numbers with left and right exchanged."""
    left_ankle, right_ankle, head, left_wrist, right_wrist = np.reshape(pose, (5, 3)).tolist()
    exchanged = [right_ankle, left_ankle, head, right_wrist, left_wrist]
    return [number for x, y, z in exchanged for number in (-x, y, z)]


def merged_cuts(main, mirrored, gap):
    """The main cuts and the mirrored ones far enough from the main ones before and after."""
    added = []
    for cut in mirrored:
        before = [m for m in main if m <= cut]
        after = [m for m in main if m >= cut]
        if (not before or cut - max(before) > gap) and (not after or min(after) - cut > gap):
            added.append(cut)
    return sorted({*main, *added})


# --- segments, and how often each repeats itself; bands are written out as full matrices -------


def division_cost(similarity, borders, penalty):
    """What a division costs: per segment its length, less its mean similarity, plus the penalty."""
    return sum(
        stop - start - similarity[start:stop, start:stop].sum() / (stop - start) + penalty
        for start, stop in pairwise(borders)
    )


def divisions(n, longest):
    """All borders of n samples in segments of such lengths."""
    return [
        [0, *inner, n]
        for count in range(n)
        for inner in combinations(range(1, n), count)
        if all(b - a <= longest for a, b in pairwise([0, *inner, n]))
    ]


def dips(row, least):
    """(depth, column) of each dip of a row without equal values, deepest first.

    A dip is a column lower than those beside it. It is as deep as one must
    climb to reach a lower column, the lowest as deep as the row is high.
    """
    last = len(row) - 1
    found = []
    for c in range(len(row)):
        if (c > 0 and row[c - 1] < row[c]) or (c < last and row[c + 1] < row[c]):
            continue
        lower = [d for d in range(len(row)) if row[d] < row[c]]
        tops = [max(row[min(c, d) : max(c, d) + 1]) for d in lower] or [max(row)]
        depth = min(tops) - row[c]
        if depth >= least and 0 < c < last:
            found.append((depth, c))
    return sorted(found, reverse=True)


def matched_lengths(gains, full):
    """The largest sum of a warping path through the gains, and the paths that have it.

    Of each such path, its length, and how much of it counts, by gains as shares of ``full``.
    Paths begin before the corner; steps of (1, 1) weigh 2, those of (1, 2) and (2, 1) weigh 3.
    """

    def ends(i, j, total, counted):
        """(sum, length, counted) of every path that goes on from here, wherever it ends."""
        yield total, j + 1, counted
        for down, right in ((1, 1), (1, 2), (2, 1)):
            a, b = i + down, j + right
            if a < len(gains) and b < len(gains[0]):
                share = min(max(gains[a][b] / full, 0), 1)
                sums = total + (down + right) * gains[a][b]
                yield from ends(a, b, sums, counted + right * share)

    found = list(ends(-1, -1, 0, 0))
    best = max(total for total, _, _ in found)
    return best, {(length, counted) for total, length, counted in found if total == best}


def poses_at(poses, path, lengths):
    """The pose of the last frame at which the path is no longer than each of these lengths."""
    last = [max((f for f in range(len(poses)) if path[f] <= x), default=0) for x in lengths]
    return np.array([poses[f] for f in last])


def unexplained(parts, centering):
    """One minus the squared correlation, if positive, of each part with the mean of all others."""
    rows = [(part - centering * part.mean(axis=0)).ravel() for part in parts]
    found = []
    for k, row in enumerate(rows):
        others = np.mean(rows[:k] + rows[k + 1 :], axis=0)
        found.append(1 - max(row @ others, 0) ** 2 / ((row @ row) * (others @ others)))
    return found


def explained(poses, path, visits, repetitions):
    """The share of each repetition's frames that the mean of the others explains, at its size."""
    repetitions = [part - part.mean(axis=0) for part in repetitions]
    count, places = len(repetitions), len(repetitions[0])
    left = 0.0
    for k, (first, last) in enumerate(pairwise(visits)):
        mean = np.mean(repetitions[:k] + repetitions[k + 1 :], axis=0)
        size = max((repetitions[k] * mean).sum(), 0) / max((mean**2).sum(), 1e-12)
        phases = (path[first:last] - path[first]) / max(path[last] - path[first], 1e-12)
        fitted = [np.interp(phases, (np.arange(places) + 0.5) / places, each) for each in mean.T]
        rest = poses[first:last] - size * np.array(fitted).T
        share = rest.var(axis=0).sum() * (count - 1) / count / poses[first:last].var(axis=0).sum()
        left += min(share, 1.0) * (last - first)
    return 1 - left / (visits[-1] - visits[0])


def left_of(repetitions):
    """What the mean of the others, at its best size, leaves of repetitions, summed."""
    rows = [part.ravel() for part in repetitions]
    left = 0.0
    for k, row in enumerate(rows):
        mean = np.mean(rows[:k] + rows[k + 1 :], axis=0)
        size = max(row @ mean, 0) / (mean @ mean)
        left += ((row - size * mean) ** 2).sum() * (len(rows) - 1) / len(rows)
    return left


def best_parting(repetitions):
    """The least share that means of the first and of the last leave of what one mean leaves."""
    cuts = range(2, len(repetitions) - 1)
    rough = 0.02 * np.square(repetitions).sum()
    one = left_of(repetitions) + rough
    two = [left_of(repetitions[:cut]) + left_of(repetitions[cut:]) + rough for cut in cuts]
    return min([1.0, *(each / one for each in two)])


def similarities(movements):
    """One minus the least squared distance of two movements, rolled, over their variances."""
    spreads = [((each - each.mean(axis=0)) ** 2).sum() for each in movements]
    return [
        [
            1 - min(((np.roll(a, by, axis=0) - b) ** 2).sum() for by in range(len(a))) / (s + t)
            for b, t in zip(movements, spreads)
        ]
        for a, s in zip(movements, spreads)
    ]


def spread(view, start, stop):
    """Half the distances of each two samples of a span, by its length."""
    inside = view[start:stop]
    return sum(np.linalg.norm(a - b) for a in inside for b in inside) / (2 * len(inside))


def follow_end(poses, path, lengths, mean, near, full):
    gains = [
        [near - ((pose - place) ** 2).sum() for place in mean]
        for pose in poses_at(poses, path, lengths)
    ]
    return matched_lengths(gains, near - full)


def similarity_band(features, unit, width):
    """One minus the distance of each sample to itself and those after it, in units."""
    n = len(features)
    found = np.zeros((n, width))
    for i in range(n):
        for lag in range(min(width, n - i)):
            found[i, lag] = 1 - np.linalg.norm(features[i] - features[i + lag]) / unit
    return found


def mean_distances(features, segments, unit):
    """The mean distance of the samples of each two segments, in units."""
    return [
        [
            np.mean([[np.linalg.norm(features[a] - features[b]) for b in h] for a in g]) / unit
            for h in segments
        ]
        for g in segments
    ]


def smoothed(rows, smoothing):
    """Means of the rows so near, and by how much these change per frame."""
    n = len(rows)
    around = [(max(f - smoothing, 0), min(f + smoothing, n - 1)) for f in range(n)]
    poses = np.array([rows[a : b + 1].mean(axis=0) for a, b in around])
    return poses, [np.linalg.norm(poses[b] - poses[a]) / max(b - a, 1) for a, b in around]


def division(poses, path, visits, places, near, followed_for, centering, scattered):
    """Ends before the first visit and after the last, what counts, is unexplained."""
    end, at = path[-1], np.array([path[visit] for visit in visits])
    lengths = np.diff(at)
    length = sorted(lengths)[len(lengths) // 2]
    inner = [
        poses_at(poses, path, a + (b - a) * ((np.arange(places) + 0.5) / places))
        for a, b in pairwise(at)
    ]
    steps = (np.arange(int(places * followed_for)) + 0.5) / places
    ends, mean = [], np.mean(inner, axis=0)
    full = 0.9 * near
    if len(inner) > 1:  # the usual variance of places, of all but one
        full = min(scattered * np.var(inner, axis=0, ddof=1).sum(axis=1).mean(), full)
    for reached, expected in (
        (at[0] - steps * length, mean[::-1]),
        (at[-1] + steps * length, mean),
    ):
        inside = reached[(reached >= 0) & (reached <= end)]
        found = poses_at(poses, path, inside)
        gains = near - ((found[:, None] - expected) ** 2).sum(axis=2) if len(found) else []
        ends.append(np.divide(_longest(gains, near - full), places))
    (before, counted_before), (after, counted_after) = ends
    outside = max(at[0] - before * length, 0) + max(end - at[-1] - after * length, 0)
    if len(inner) == 1:
        ahead = at[-1] + (end - length) * steps[:places]
        inner.append(poses_at(poses, path, [a if a < end else a - end for a in ahead]))
    shares = np.array(unexplained(inner, centering)[: len(lengths)])
    between = max(end - outside - lengths.sum(), 0)
    weights = np.maximum(lengths / end, 1 / (len(lengths) + before + after))
    total = weights @ shares + (shares.mean() * between + outside) / end
    counted = counted_before + counted_after
    return before, after, counted, total


WARPING = ((1, 1), (1, 2), (2, 1))


def _longest(gains, full):
    """The length of the best warping path, and what counts of it, as `matched_lengths` by rows."""
    best, found, paths = 0.0, (0, 0.0), {(-1, -1): (0.0, 0.0)}
    for i in range(len(gains)):
        for j in range(len(gains[i])):
            share = min(max(gains[i][j] / full, 0), 1)
            befores = [(paths.get((i - a, j - b), (-np.inf, 0)), a, b) for a, b in WARPING]
            paths[i, j] = max(
                (total + (a + b) * gains[i][j], counted + b * share)
                for (total, counted), a, b in befores
            )
            if paths[i, j][0] > best:
                best, found = paths[i, j][0], (j + 1, paths[i, j][1])
    return found


# --- ends: stretches beside a mean repetition --------------------------------------------------


def evenly_in_time(rows, start, length, places):
    at = start + length * ((np.arange(places) + 0.5) / places) - 0.5
    return np.array([np.interp(at, np.arange(len(rows)), column) for column in rows.T]).T


def best_length(rows, stop, shortest, longest, mean):
    """How long the stretch up to a frame is that is nearest to the mean."""
    return min(
        range(shortest, longest + 1),
        key=lambda n: ((evenly_in_time(rows, stop - n, n, len(mean)) - mean) ** 2).sum(),
    )


# --- occurrences ------------------------------------------------------------------------------

PATH_STEPS = ((1, 1, 1.0), (1, 2, 1.5), (2, 1, 1.5))


def pair_score(samples, costs, i, j, scale, worst):
    square = float(((samples[i] - samples[j]) ** 2).sum())
    return max(1 - square / scale**2 - (costs[i] + costs[j]) / 2, worst)


def local_path_scores(samples, costs, begins, gap, width, scale, worst):
    """The score of the best path from each first pair, where there is one above 0."""
    n = len(samples)
    at, best = {}, {}
    for i in range(n):
        for j in range(i + gap, min(i + width + 1, n)):
            score = pair_score(samples, costs, i, j, scale, worst)
            options = [(score, (i, j))]
            for a, b, weight in PATH_STEPS:
                crosses = begins[i - a + 1 : i + 1].any() or begins[j - b + 1 : j + 1].any()
                if (i - a, j - b) in at and i >= a and not crosses:
                    before, first = at[i - a, j - b]
                    options.append((before + weight * score, first))
            total, first = max(options, key=lambda option: option[0])
            if total > 0:
                at[i, j] = total, first
                best[first] = max(best.get(first, 0), total)
    return best


def followed_score(samples, costs, ends, scale, worst):
    """The score of the best path from the first of two pairs to the second."""
    i0, j0, i1, j1 = ends
    scores = {(i0, j0): pair_score(samples, costs, i0, j0, scale, worst)}
    for i in range(i0, i1 + 1):
        for j in range(j0, j1 + 1):
            options = [
                scores[i - a, j - b] + weight * pair_score(samples, costs, i, j, scale, worst)
                for a, b, weight in PATH_STEPS
                if (i - a, j - b) in scores
            ]
            if options:
                scores[i, j] = max(options)
    return scores[i1, j1]


def recurrences_of(start, stop, paths, free, cover):
    """Where a stretch recurs by paths (first sample, partners, sums): spans, gains, what of it."""
    found = []
    for first, partners, sums in paths:
        low, high = max(start, first), min(stop, first + len(sums))
        before = [0.0, *sums]
        while low < high and low > first and sums[low - first] <= before[low - first]:
            low += 1
        while high - 1 > low and sums[high - 1 - first] <= before[high - 1 - first]:
            high -= 1
        if high - low < cover * (stop - start):
            continue
        gain = sums[high - 1 - first] - before[low - first]
        begin, end = round(partners[low - first]), round(partners[high - 1 - first]) + 1
        elsewhere = end <= start or begin >= stop
        if gain > 0 and elsewhere and 2 * (end - begin) >= stop - start:
            found.append((begin, end, gain, (low, high)))
    kept = []
    for begin, end, gain, part in sorted(found, key=lambda each: -each[2]):
        if 5 * free[begin:end].sum() >= 4 * (end - begin) and all(
            end <= b or begin >= e for b, e, *_ in kept
        ):
            kept.append((begin, end, gain, part))
    return kept


def cheapest_grouping(sums, lengths, most, segment_cost, cluster_cost, spread_share):
    """Cost and clusters of the cheapest grouping: all clusters compared before each union."""
    clusters = [[g] for g in range(len(lengths))]

    def total(a, b):
        return sum(sums[g][h] for g in a for h in b)

    def size(a):
        return sum(lengths[g] for g in a)

    def mean(a, b):
        return total(a, b) / (size(a) * size(b))

    def distance(a, b):
        return mean(a, b) - spread_share * (mean(a, a) + mean(b, b)) / 2

    best = None
    while True:
        of = {g: i for i, cluster in enumerate(clusters) for g in cluster}
        runs = 1 + sum(of[g] != of[g + 1] for g in range(len(lengths) - 1))
        within = sum(total(a, a) / (2 * size(a)) for a in clusters)
        cost = within + segment_cost * runs + cluster_cost * len(clusters)
        if len(clusters) <= most and (best is None or cost < best[0] - 1e-9):
            best = cost, sorted(sorted(cluster) for cluster in clusters)
        if len(clusters) == 1:
            return best
        pairs = [(a, b) for i, a in enumerate(clusters) for b in clusters[i + 1 :]]
        a, b = min(pairs, key=lambda pair: distance(*pair))
        clusters = [c for c in clusters if c not in (a, b)] + [a + b]


# --- matching: every warping of an example onto a recording, one by one ------------------------


def warpings(distances):
    """For each sample the least mean distance of a warping of the example that ends there.

    ``distances`` (samples, m) of a recording from the example. A warping goes on by one and one,
    or by two of one and one of the other; two samples on one of the example count half each.
    """
    n, m = distances.shape

    def cheapest(j, i):
        """Sum and beginning of the cheapest warping of the first i + 1 samples that ends at j."""
        if i == 0:
            return distances[j, 0], j
        found = []
        if j >= 1:
            total, begin = cheapest(j - 1, i - 1)
            found.append((total + distances[j, i], begin))
        if j >= 2:
            total, begin = cheapest(j - 2, i - 1)
            found.append((total + (distances[j - 1, i] + distances[j, i]) / 2, begin))
        if j >= 1 and i >= 2:
            total, begin = cheapest(j - 1, i - 2)
            found.append((total + distances[j, i - 1] + distances[j, i], begin))
        return min(found, default=(np.inf, -1))

    ends = [cheapest(j, m - 1) for j in range(n)]
    return [total / m for total, _ in ends], [begin for _, begin in ends]


def least_squares(windows, wanted, finer):
    """The least of the squared distances of each window from what is wanted."""
    return [
        min(sum((finer * a - b) ** 2 for a, b in zip(window, one)) for one in wanted)
        for window in windows
    ]
