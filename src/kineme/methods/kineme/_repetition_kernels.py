"""Compiled loops that divide an activity into repetitions, judge that, and fit its ends.

Poses are those of an activity, ``path`` their length of path up to each frame
and to the end. Naive twins are in ``tests/helpers/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS
from kineme.methods.kineme._following_kernels import followed, poses_at, steps_inside

# Poses of an end that are farther than this share of the largest distance never count whole.
FARTHEST = 0.9
SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
FAR = np.float32(np.inf)


@njit("float32[:, ::1](float32[:, ::1], int64[::1], int64, int64)", **SUMS)
def distances_to(features, references, start, stop):
    """Distance of each reference frame to each frame of ``[start, stop)``."""
    distances = np.empty((len(references), stop - start), np.float32)
    for r in range(len(references)):
        row = features[references[r]]
        for f in range(start, stop):
            square = np.float32(0)
            for d in range(features.shape[1]):
                difference = row[d] - features[f, d]
                square += difference * difference
            distances[r, f - start] = np.sqrt(square)
    return distances


@njit("int64[::1](float32[::1], float32)", **OPTIONS)
def turning_points(row, least):
    """Lowest, highest, ..., lowest columns of a row that rises and falls by ``least`` between."""
    turns = np.empty(len(row) + 1, np.int64)
    count = low = high = 0
    rising = falling = False
    for c in range(len(row)):
        low = c if row[c] < row[low] else low
        high = c if row[c] > row[high] else high
        if not rising and row[c] - row[low] >= least:
            turns[count] = low
            count += 1
            rising, falling, high = True, False, c
        elif not falling and row[high] - row[c] >= least:
            if count > 0:  # begin with a lowest
                turns[count] = high
                count += 1
            rising, falling, low = False, True, c
    if falling or count == 0:
        turns[count] = low
        count += 1
    return turns[:count]


@njit("Tuple((float32[:, ::1], int64[:, ::1]))(float32[:, ::1], float32[::1])", **OPTIONS)
def dips(distances, least):
    """Depths of the dips of each row, deepest first, and their columns; zero where no more.

    A dip is as deep as one must climb to reach a deeper one, the deepest as
    deep as the row is high (topological persistence). Those shallower than
    ``least``, and those lowest at either end of the row, do not count.
    """
    rows, columns = distances.shape
    depths = np.zeros((rows, columns // 2 + 1), np.float32)
    lowest = np.zeros((rows, columns // 2 + 1), np.int64)
    for r in range(rows):
        row = distances[r]
        turns = turning_points(row, least[r])
        n = len(turns)
        found = np.zeros(n // 2 + 1, np.float32)
        where = np.zeros(n // 2 + 1, np.int64)
        count = 0
        while n > 1:
            # The smallest climb is that out of the shallowest dip: take both away.
            at, climb = 0, FAR
            for t in range(n - 1):
                if abs(row[turns[t + 1]] - row[turns[t]]) < climb:
                    at, climb = t, abs(row[turns[t + 1]] - row[turns[t]])
            found[count], where[count] = climb, turns[at + at % 2]
            count += 1
            n -= 2
            for t in range(at, n):
                turns[t] = turns[t + 2]
        top = row[0]
        for c in range(columns):
            top = max(top, row[c])
        found[count], where[count] = top - row[turns[0]], turns[0]
        place = 0
        for _ in range(len(found)):
            i = 0
            for other in range(1, len(found)):
                i = other if found[other] > found[i] else i
            if found[i] >= least[r] and 0 < where[i] < columns - 1:
                depths[r, place], lowest[r, place] = found[i], where[i]
                place += 1
            found[i] = -FAR
    return depths, lowest


@njit("Tuple((float64[:, ::1], float64[::1]))(float32[:, ::1], int64)", **OPTIONS)
def smoothed(rows, smoothing):
    """Rows averaged over so many before and after, and by how much these then change per frame."""
    n, dims = rows.shape
    sums = np.zeros((n + 1, dims))
    for f in range(n):
        for d in range(dims):
            sums[f + 1, d] = sums[f, d] + rows[f, d]
    poses, speeds = np.empty((n, dims)), np.empty(n)
    for f in range(n):
        before, after = max(f - smoothing, 0), min(f + smoothing, n - 1)
        for d in range(dims):
            poses[f, d] = (sums[after + 1, d] - sums[before, d]) / (after + 1 - before)
    for f in range(n):
        before, after = max(f - smoothing, 0), min(f + smoothing, n - 1)
        square = 0.0
        for d in range(dims):
            difference = poses[after, d] - poses[before, d]
            square += difference * difference
        speeds[f] = np.sqrt(square) / max(after - before, 1)
    return poses, speeds


@njit("float64[::1](float64[:, :, ::1], float64)", **SUMS)
def unexplained(repetitions, centering):
    """What the mean of all others does not explain of each repetition, 0 to 1, size apart.

    Repetitions are (places, dims) each, less so large a share of their mean; 1 minus the square
    of a positive correlation.
    """
    count, places, dims = repetitions.shape
    rows = np.empty((count, places * dims))
    total = np.zeros(places * dims)
    mean = np.empty(dims)
    for k in range(count):
        mean[:] = 0
        for p in range(places):
            for d in range(dims):
                mean[d] += repetitions[k, p, d]
        for p in range(places):
            for d in range(dims):
                value = repetitions[k, p, d] - mean[d] * (centering / places)
                rows[k, p * dims + d] = value
                total[p * dims + d] += value
    found = np.empty(count)
    for k in range(count):
        product = own = other = 0.0
        for each in range(places * dims):
            rest = total[each] - rows[k, each]
            product += rows[k, each] * rest
            own += rows[k, each] * rows[k, each]
            other += rest * rest
        found[k] = 1 - max(product, 0.0) ** 2 / max(own * other, 1e-24)
    return found


@njit("float64[:, :, ::1](float64[:, ::1], float64[::1], int64[::1], int64)", **OPTIONS)
def repetitions_between(poses, path, visits, places):
    """(repetitions, places, dims): poses evenly along the path from each visit to the next."""
    found = np.empty((len(visits) - 1, places, poses.shape[1]))
    lengths = np.empty(places)
    for k in range(len(found)):
        first, last = path[visits[k]], path[visits[k + 1]]
        for p in range(places):
            lengths[p] = first + (last - first) * ((p + 0.5) / places)
        there = poses_at(poses, path, lengths)
        for p in range(places):
            for d in range(poses.shape[1]):
                found[k, p, d] = there[p, d]
    return found


@njit("float64(float64[::1])", **OPTIONS)
def upper_median(values):
    """The middle value, the upper one of two."""
    ordered = np.empty(len(values))
    for k in range(len(values)):
        place = k
        while place > 0 and ordered[place - 1] > values[k]:
            ordered[place] = ordered[place - 1]
            place -= 1
        ordered[place] = values[k]
    return ordered[len(values) // 2]


@njit("float64[:, ::1](float64[:, :, ::1])", **OPTIONS)
def mean_repetition(repetitions):
    """(places, dims): the mean of repetitions of (places, dims) each."""
    count, places, dims = repetitions.shape
    mean = np.zeros((places, dims))
    for k in range(count):
        for p in range(places):
            for d in range(dims):
                mean[p, d] += repetitions[k, p, d]
    for p in range(places):
        for d in range(dims):
            mean[p, d] /= count
    return mean


@njit("float64(float64[:, :, ::1], float64[:, ::1])", **SUMS)
def scatter(repetitions, mean):
    """Mean square distance of the poses of repetitions from those of their mean; 0 of one."""
    count, places, dims = repetitions.shape
    total = 0.0
    for k in range(count):
        for p in range(places):
            for d in range(dims):
                difference = repetitions[k, p, d] - mean[p, d]
                total += difference * difference
    return total / (places * max(count - 1, 1))


@njit(
    "Tuple((float64, float64, float64, float64))(float64[:, ::1], float64[::1],"
    " int64[::1], int64, float64, float64, float64, float64)",
    **OPTIONS,
)
def judged(poses, path, visits, places, near, followed_for, centering, scattered):
    """Shares of a repetition at both ends, what of them counts, what is unexplained.

    The ends are what lies before the first visit and after the last. They are followed for so
    many repetitions, by poses nearer than ``near``, a squared distance, to the mean of those
    between the visits, and count whole where they are as near to it as these are, ``scattered``
    times their mean square distance. Unexplained is a share of the activity.
    """
    whole = path[-1]
    count = len(visits) - 1
    lengths = np.empty(count)
    for k in range(count):
        lengths[k] = path[visits[k + 1]] - path[visits[k]]
    length = max(upper_median(lengths), 1e-12)
    inner = repetitions_between(poses, path, visits, places)
    mean = mean_repetition(inner)
    first, last = path[visits[0]], path[visits[-1]]
    number_of_steps = int(places * followed_for)
    before = steps_inside(first, -length, places, number_of_steps, whole)
    after = steps_inside(last, length, places, number_of_steps, whole)
    alike = FARTHEST * near
    if count > 1:
        alike = min(scattered * scatter(inner, mean), alike)
    to_head, in_head = followed(poses, path, before, np.ascontiguousarray(mean[::-1]), near, alike)
    to_tail, in_tail = followed(poses, path, after, mean, near, alike)
    head, tail = to_head / places, to_tail / places
    outside = max(first - head * length, 0.0) + max(whole - last - tail * length, 0.0)
    number = count + head + tail
    if count == 1:  # compared with what comes after it, and goes on at the beginning
        ahead = np.empty(places)
        for p in range(places):
            ahead[p] = last + (whole - length) * ((p + 0.5) / places)
            if ahead[p] >= whole:
                ahead[p] -= whole
        there = poses_at(poses, path, ahead)
        both = np.empty((2, places, poses.shape[1]))
        for p in range(places):
            for d in range(poses.shape[1]):
                both[0, p, d], both[1, p, d] = inner[0, p, d], there[p, d]
        inner = both
    shares = unexplained(inner, centering)[:count]
    known = max(whole - outside - lengths.sum(), 0.0)
    total = (shares.sum() / count * known + outside) / whole
    for k in range(count):  # what lies between two visits counts as a repetition, however short
        total += max(lengths[k] / whole, 1 / number) * shares[k]
    return head, tail, (in_head + in_tail) / places, total


@njit("void(float32[:, ::1], float64, float64[::1])", **OPTIONS)
def pose_at(rows, at, found):
    """The row at a time between two rows, in frames; the first or last one beyond them."""
    before = min(max(int(np.floor(at)), 0), len(rows) - 1)
    after = min(before + 1, len(rows) - 1)
    share = min(max(at - before, 0.0), 1.0)
    for d in range(rows.shape[1]):
        found[d] = rows[before, d] * (1 - share) + rows[after, d] * share


@njit("float64[:, :, ::1](float32[:, ::1], int64[::1], int64[::1], int64)", **OPTIONS)
def evenly_in_time(rows, starts, lengths, places):
    """(stretches, places, dims): rows evenly in time from each start on, over each length."""
    found = np.empty((len(starts), places, rows.shape[1]))
    for k in range(len(starts)):
        for p in range(places):
            at = starts[k] + lengths[k] * ((p + 0.5) / places) - 0.5
            pose_at(rows, at, found[k, p])
    return found


@njit("int64(float32[:, ::1], int64, int64, int64, float64[:, ::1])", **SUMS)
def best_length(rows, stop, shortest, longest, mean):
    """How long the stretch up to a frame is that is nearest to the mean, evenly in time."""
    places, dims = mean.shape
    pose = np.empty(dims)
    best, least = shortest, np.inf
    for length in range(shortest, longest + 1):
        misfit = 0.0
        for p in range(places):
            pose_at(rows, stop - length + length * ((p + 0.5) / places) - 0.5, pose)
            for d in range(dims):
                difference = pose[d] - mean[p, d]
                misfit += difference * difference
        if misfit < least:
            best, least = length, misfit
    return best
