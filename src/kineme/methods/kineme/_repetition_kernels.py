"""Compiled loops for divisions of an activity into repetitions, their cost, and their ends.

Poses are those of an activity; ``path`` is the length of its path up to each frame and to the
end. A place is one of equally many positions on the path of each repetition. Naive twins are in
``tests/helpers/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

# Poses of an end that are farther than this share of the largest distance never count in full.
FARTHEST = 0.9
SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
FAR = np.float32(np.inf)


@njit("float32[:, ::1](float32[:, ::1], int64[::1])", **SUMS)
def measure_distances(features, references):
    """Distance of each reference frame to each frame."""
    distances = np.empty((len(references), len(features)), np.float32)
    for r in range(len(references)):
        row = features[references[r]]
        for f in range(len(features)):
            square = np.float32(0)
            for d in range(features.shape[1]):
                difference = row[d] - features[f, d]
                square += difference * difference
            distances[r, f] = np.sqrt(square)
    return distances


@njit("int64[::1](float32[::1], float32)", **OPTIONS)
def find_turning_points(row, least):
    """Lowest, highest, ..., lowest columns of a row that rises and falls by ``least`` between."""
    turns = np.empty(len(row) + 1, np.int64)
    count = low = high = 0  # columns of the lowest and highest value since the last turn
    rising = falling = False
    for c in range(len(row)):
        # Lowest and highest columns since the last turn follow the row.
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
    # A row that still falls ends with a lowest.
    if falling or count == 0:
        turns[count] = low
        count += 1
    return turns[:count]


@njit("Tuple((float32[:, ::1], int64[:, ::1]))(float32[:, ::1], float32[::1])", **OPTIONS)
def find_dips(distances, least):
    """Depths of the dips of each row, deepest first, and their columns; zero where no more.

    A dip is as deep as one must climb to reach a deeper one, the deepest as
    deep as the row is high (topological persistence). Those shallower than
    ``least``, and those lowest at either end of the row, do not count.
    """
    rows, columns = distances.shape
    # Between two dips lies a higher column, so at most about half of the columns are dips.
    depths = np.zeros((rows, columns // 2 + 1), np.float32)
    lowest = np.zeros((rows, columns // 2 + 1), np.int64)
    for r in range(rows):
        row = distances[r]
        # Lows are at even turns, highs at odd ones.
        turns = find_turning_points(row, least[r])
        found = np.zeros(len(turns) // 2 + 1, np.float32)
        where = np.zeros(len(turns) // 2 + 1, np.int64)
        count = n = 0
        # A climb smaller than those beside it is a dip whatever else there is. One pass over the
        # turns takes these away, and leaves few.
        for t in range(len(turns)):
            turns[n] = turns[t]
            n += 1
            while n > 3:
                at, climb = n - 3, abs(row[turns[n - 2]] - row[turns[n - 3]])
                before = abs(row[turns[n - 3]] - row[turns[n - 4]])
                if climb >= before or climb >= abs(row[turns[n - 1]] - row[turns[n - 2]]):
                    break
                found[count], where[count] = climb, turns[at + at % 2]
                count += 1
                turns[at] = turns[n - 1]
                n -= 2
        while n > 1:
            # The smallest climb is the depth of the shallowest dip: take its low and high away.
            at, climb = 0, FAR
            for t in range(n - 1):
                if abs(row[turns[t + 1]] - row[turns[t]]) < climb:
                    at, climb = t, abs(row[turns[t + 1]] - row[turns[t]])
            # An even turn is a low; of a high (odd) its following low goes.
            found[count], where[count] = climb, turns[at + at % 2]
            count += 1
            n -= 2
            # Later turns move up by two.
            for t in range(at, n):
                turns[t] = turns[t + 2]
        # The last low is the deepest dip: it is as deep as the row is high.
        top = row[0]
        for c in range(columns):
            top = max(top, row[c])
        found[count], where[count] = top - row[turns[0]], turns[0]
        # Deepest first, without those at an end of the row.
        place = 0
        for i in np.argsort(-found, kind="mergesort"):
            if found[i] >= least[r] and 0 < where[i] < columns - 1:
                depths[r, place], lowest[r, place] = found[i], where[i]
                place += 1
    return depths, lowest


@njit("Tuple((float64[:, ::1], float64[::1]))(float32[:, ::1], int64)", **OPTIONS)
def smooth_rows(rows, smoothing):
    """Rows averaged over so many before and after, and the mean speed per frame over the same."""
    n, dims = rows.shape
    # Sums up to each row, so that a mean is one difference.
    sums = np.zeros((n + 1, dims))
    for f in range(n):
        for d in range(dims):
            sums[f + 1, d] = sums[f, d] + rows[f, d]
    poses, speeds = np.empty((n, dims)), np.empty(n)
    for f in range(n):
        # Fewer rows at the ends, where neighbours are missing.
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


@njit("float64[:, ::1](float64[:, ::1], float64[::1], float64[::1])", **OPTIONS)
def look_up_poses(poses, path, lengths):
    """Return the poses at these lengths along the path."""
    found = np.empty((len(lengths), poses.shape[1]))
    # Binary search for the frame before this length.
    for i in range(len(lengths)):
        low, high = 0, len(path)  # the first frame that is farther
        while low < high:
            middle = (low + high) // 2
            if path[middle] <= lengths[i]:
                low = middle + 1
            else:
                high = middle
        frame = min(max(low - 1, 0), len(poses) - 1)
        for d in range(poses.shape[1]):
            found[i, d] = poses[frame, d]
    return found


@njit("float64[::1](float64[:, :, ::1], float64)", **SUMS)
def measure_unexplained(repetitions, centering):
    """Return the share of each repetition that the mean of all others does not explain, 0 to 1.

    It is 1 minus the square of their correlation if that is positive, and so does not depend on
    size. Before, ``centering`` times its mean is subtracted from each repetition (places, dims).
    """
    count, places, dims = repetitions.shape
    rows = np.empty((count, places * dims))
    total = np.zeros(places * dims)
    mean = np.empty(dims)
    # Repetitions as centered rows, and the sum of these.
    for k in range(count):
        mean[:] = 0
        for p in range(places):
            for d in range(dims):
                mean[d] += repetitions[k, p, d]
        for p in range(places):
            for d in range(dims):
                # `mean` holds sums, hence the division by places.
                value = repetitions[k, p, d] - mean[d] * (centering / places)
                rows[k, p * dims + d] = value
                total[p * dims + d] += value
    # Each row with the sum of the others, which correlates as their mean does.
    found = np.empty(count)
    for k in range(count):
        product = square = other = 0.0
        for each in range(places * dims):
            rest = total[each] - rows[k, each]
            product += rows[k, each] * rest
            square += rows[k, each] * rows[k, each]
            other += rest * rest
        # The square of a correlation that is not positive counts as 0; the floor avoids 0 / 0.
        found[k] = 1 - max(product, 0.0) ** 2 / max(square * other, 1e-24)
    return found


@njit("float64[:, :, ::1](float64[:, ::1], float64[::1], int64[::1], int64)", **OPTIONS)
def sample_repetitions(poses, path, visits, places):
    """(repetitions, places, dims): poses evenly along the path from each visit to the next."""
    found = np.empty((len(visits) - 1, places, poses.shape[1]))
    lengths = np.empty(places)
    for k in range(len(found)):
        first, last = path[visits[k]], path[visits[k + 1]]
        for p in range(places):
            # Middles of equal parts of the path.
            lengths[p] = first + (last - first) * ((p + 0.5) / places)
        reached = look_up_poses(poses, path, lengths)
        for p in range(places):
            for d in range(poses.shape[1]):
                found[k, p, d] = reached[p, d]
    return found


@njit("float64(float64[::1])", **OPTIONS)
def find_upper_median(values):
    """Return the middle value, the upper one of two."""
    ordered = np.empty(len(values))
    # Insertion sort: a division has few repetitions.
    for k in range(len(values)):
        place = k
        while place > 0 and ordered[place - 1] > values[k]:
            ordered[place] = ordered[place - 1]
            place -= 1
        ordered[place] = values[k]
    return ordered[len(values) // 2]


@njit("float64[:, ::1](float64[:, :, ::1])", **OPTIONS)
def average_repetitions(repetitions):
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
def measure_scatter(repetitions, mean):
    """Mean square distance of the poses of repetitions from those of their mean; 0 of one."""
    count, places, dims = repetitions.shape
    total = 0.0
    for k in range(count):
        for p in range(places):
            for d in range(dims):
                difference = repetitions[k, p, d] - mean[p, d]
                total += difference * difference
    # One degree of freedom less, since the mean is of the same repetitions.
    return total / (places * max(count - 1, 1))


@njit("Tuple((int64, float64))(float64[:, ::1], float64)", **OPTIONS)
def match_columns(gains, full):
    """Columns up to which the rows follow them, and how many of these count; 0 if no path gains.

    They are those of the warping path with the largest gain. Paths begin before the first row and
    column. Steps (1, 1) count a gain twice, (1, 2) and (2, 1) three times. A column counts by its
    gain as a share of ``full``, 0 to 1.
    """
    rows, columns = gains.shape
    sums = np.full((rows + 2, columns + 2), -np.inf)
    sums[1, 1] = 0
    best, row, column = 0.0, -1, -1
    # The largest sum of a path to each entry; those of entry (i, j) are at (i + 2, j + 2).
    for i in range(rows):
        for j in range(columns):
            straight = sums[i + 1, j + 1] + 2 * gains[i, j]
            bent = max(sums[i, j + 1], sums[i + 1, j]) + 3 * gains[i, j]
            sums[i + 2, j + 2] = max(straight, bent)
            if sums[i + 2, j + 2] > best:
                best, row, column = sums[i + 2, j + 2], i, j
    # Back on the best path, step by step, adding up how much of its columns counts.
    length, count = column + 1, 0.0
    while row >= 0:
        share = min(max(gains[row, column] / full, 0.0), 1.0)
        bent = max(sums[row, column + 1], sums[row + 1, column])
        # The same comparison as forward: which step gave the largest sum here.
        if 2 * gains[row, column] + sums[row + 1, column + 1] >= 3 * gains[row, column] + bent:
            count, row, column = count + share, row - 1, column - 1
        elif sums[row, column + 1] >= sums[row + 1, column]:
            count, row, column = count + share, row - 2, column - 1
        else:
            # A step of two columns counts the column that it passes over, too.
            count, row, column = count + 2 * share, row - 1, column - 2
    return length, count


@njit("float64[::1](float64, float64, int64, int64, float64)", **OPTIONS)
def place_steps(begin, step, places, number, path_length):
    """Lengths on the path, ``places`` a step from ``begin`` on: ``number``, less those off it."""
    lengths = np.empty(number)
    count = 0
    for i in range(number):
        # A negative step goes backwards from `begin`.
        length = begin + (i + 0.5) / places * step
        if 0 <= length <= path_length:
            lengths[count] = length
            count += 1
    return lengths[:count]


@njit(
    "Tuple((int64, float64))(float64[:, ::1], float64[::1], float64[::1], float64[:, ::1], float64,"
    " float64)",
    **SUMS,
)
def follow_end(poses, path, lengths, mean, near, full):
    """Places of the mean that the poses at these lengths follow, and how many of these count.

    ``near`` and ``full`` are squared distances from the mean: a pose gains by being nearer than
    ``near``, and counts in full up to ``full``.
    """
    reached = look_up_poses(poses, path, lengths)
    # Gains begin at `near`, from which the squared distance is subtracted.
    gains = np.full((len(reached), len(mean)), near)
    for i in range(len(reached)):
        for j in range(len(mean)):
            square = 0.0
            for d in range(mean.shape[1]):
                difference = reached[i, d] - mean[j, d]
                square += difference * difference
            gains[i, j] -= square
    return match_columns(gains, near - full)


@njit(
    "Tuple((float64, float64, float64, float64))(float64[:, ::1], float64[::1],"
    " int64[::1], int64, float64, float64, float64, float64)",
    **OPTIONS,
)
def measure_division(poses, path, visits, places, near, followed_for, centering, scattered):
    """Lengths of both ends in repetitions, how much of them counts, and the unexplained share.

    The ends lie before the first visit and after the last. An end is as long as it follows the
    mean repetition between the visits, at most ``followed_for`` repetitions. Its poses are nearer
    to the mean than ``near``, a squared distance. They count in full up to ``scattered`` times the
    mean square distance of repetitions. The unexplained share is of the whole activity.
    """
    # Repetitions between the visits, their upper median length, and their mean.
    total_length = path[-1]
    count = len(visits) - 1
    lengths = np.empty(count)
    for k in range(count):
        lengths[k] = path[visits[k + 1]] - path[visits[k]]
    # The floor avoids a division by 0 where the path stands still.
    length = max(find_upper_median(lengths), 1e-12)
    inner = sample_repetitions(poses, path, visits, places)
    mean = average_repetitions(inner)
    first, last = path[visits[0]], path[visits[-1]]
    # The ends: back from the first visit on the reversed mean, and on from the last visit.
    number_of_steps = int(places * followed_for)
    before = place_steps(first, -length, places, number_of_steps, total_length)
    after = place_steps(last, length, places, number_of_steps, total_length)
    full = FARTHEST * near
    if count > 1:
        full = min(scattered * measure_scatter(inner, mean), full)
    # Backwards, so the mean is reversed as well.
    to_head, in_head = follow_end(poses, path, before, np.ascontiguousarray(mean[::-1]), near, full)
    to_tail, in_tail = follow_end(poses, path, after, mean, near, full)
    head, tail = to_head / places, to_tail / places
    # The unexplained share: that of repetitions, and all that no repetition reaches.
    outside = max(first - head * length, 0.0) + max(total_length - last - tail * length, 0.0)
    number = count + head + tail
    if count == 1:  # one repetition is compared with the rest, which goes on at the beginning
        # Evenly from the last visit on; beyond the end of the path it goes on at its beginning.
        ahead = np.empty(places)
        for p in range(places):
            ahead[p] = last + (total_length - length) * ((p + 0.5) / places)
            if ahead[p] >= total_length:
                ahead[p] -= total_length
        reached = look_up_poses(poses, path, ahead)
        both = np.empty((2, places, poses.shape[1]))
        for p in range(places):
            for d in range(poses.shape[1]):
                both[0, p, d], both[1, p, d] = inner[0, p, d], reached[p, d]
        inner = both
    # Of both only the repetition itself counts.
    shares = measure_unexplained(inner, centering)[:count]
    # Path in the two ends: neither between visits nor outside of all repetitions.
    inside = max(total_length - outside - lengths.sum(), 0.0)
    total = (shares.sum() / count * inside + outside) / total_length
    for k in range(count):  # a short repetition counts as much as one of mean length
        total += max(lengths[k] / total_length, 1 / number) * shares[k]
    return head, tail, (in_head + in_tail) / places, total


@njit("void(float32[:, ::1], float64, float64[::1])", **OPTIONS)
def interpolate_pose(rows, at, found):
    """Return the row at a time between two rows, in frames; the first or last one beyond them."""
    # Beyond the ends the first or last row.
    before = min(max(int(np.floor(at)), 0), len(rows) - 1)
    after = min(before + 1, len(rows) - 1)
    share = min(max(at - before, 0.0), 1.0)
    for d in range(rows.shape[1]):
        found[d] = rows[before, d] * (1 - share) + rows[after, d] * share


@njit("float64[:, :, ::1](float32[:, ::1], int64[::1], int64[::1], int64)", **OPTIONS)
def sample_evenly(rows, starts, lengths, places):
    """(spans, places, dims): rows evenly in time from each start on, over each length."""
    found = np.empty((len(starts), places, rows.shape[1]))
    for k in range(len(starts)):
        for p in range(places):
            # Frames are centred on their middles, hence half a frame less.
            at = starts[k] + lengths[k] * ((p + 0.5) / places) - 0.5
            interpolate_pose(rows, at, found[k, p])
    return found


@njit("int64(float32[:, ::1], int64, int64, int64, float64[:, ::1])", **SUMS)
def find_best_length(rows, stop, shortest, longest, mean):
    """Return the length of the span up to a frame that is nearest to the mean, evenly in time."""
    places, dims = mean.shape
    pose = np.empty(dims)
    best, least = shortest, np.inf
    for length in range(shortest, longest + 1):
        misfit = 0.0
        for p in range(places):
            # From the start of the span, which is its stop less its length.
            interpolate_pose(rows, stop - length + length * ((p + 0.5) / places) - 0.5, pose)
            for d in range(dims):
                difference = pose[d] - mean[p, d]
                misfit += difference * difference
        if misfit < least:
            best, least = length, misfit
    return best
