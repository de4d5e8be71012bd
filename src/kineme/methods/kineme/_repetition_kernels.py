"""Compiled loops that divide an activity into repetitions, and compare repetitions and movements.

``path`` is the length of the path of poses up to each frame, and to the end. ``places`` is the
number of positions on its path at which each repetition is sampled. Naive versions of the kernels
are in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

FARTHEST = 0.9
"""Share of the largest squared distance up to which poses of an end can count in full."""
SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
FAR = np.float32(np.inf)
MIN_COUNT = 2
"""Smallest number of repetitions of a movement."""
ROUGH = 0.02
"""Smallest unexplained share of the variance of repetitions that is significant."""


@njit("float32[:, ::1](float32[:, ::1], int64[::1])", **SUMS)
def measure_distances(features, references):
    """Return the distance of each reference frame to each frame."""
    n, dims = features.shape
    # One contiguous row per dimension, so that the loop over frames is vectorised.
    columns = np.ascontiguousarray(features.T)
    distances = np.zeros((len(references), n), np.float32)
    for r in range(len(references)):
        row = distances[r]
        for d in range(dims):
            own, others = columns[d, references[r]], columns[d]
            for f in range(n):
                row[f] += (own - others[f]) * (own - others[f])
        for f in range(n):
            row[f] = np.sqrt(row[f])
    return distances


@njit("int64(float32[::1], float32, int64[::1])", **OPTIONS)
def find_turning_points(row, least, turns):
    """Write alternating local minima and maxima that differ by ``least``; return their number.

    Both ends are minima. ``turns`` has space for one more than the row.
    """
    count = low = high = 0  # columns of the lowest and highest value since the last turn
    lowest = highest = row[0]
    direction = 0  # 1 after a minimum, -1 after a maximum
    for c in range(len(row)):
        value = row[c]
        if value < lowest:
            low, lowest = c, value
        if value > highest:
            high, highest = c, value
        if direction != 1 and value - lowest >= least:
            turns[count] = low
            count += 1
            direction, high, highest = 1, c, value
        elif direction != -1 and highest - value >= least:
            if count > 0:  # the first turn is a minimum
                turns[count] = high
                count += 1
            direction, low, lowest = -1, c, value
    # The last turn is a minimum.
    if direction == -1 or count == 0:
        turns[count] = low
        count += 1
    return count


@njit("Tuple((float32[:, ::1], int64[:, ::1]))(float32[:, ::1], float32[::1])", **OPTIONS)
def find_dips(distances, least):
    """Return depths and columns of the dips of each row, deepest first, padded with zeros.

    The depth of a dip is the climb that is needed to reach a deeper one; that of the deepest is
    the range of the row (topological persistence). Dips shallower than ``least``, and those at
    either end of the row, are left out.
    """
    rows, columns = distances.shape
    # Two dips are separated by a higher column, so about half of the columns at most are dips.
    depths = np.zeros((rows, columns // 2 + 1), np.float32)
    lowest = np.zeros((rows, columns // 2 + 1), np.int64)
    turns = np.empty(columns + 1, np.int64)
    depths_found = np.empty(columns // 2 + 2, np.float32)
    columns_found = np.empty(columns // 2 + 2, np.int64)
    for r in range(rows):
        row = distances[r]
        # Minima are at even turns, maxima at odd ones.
        n_turns = find_turning_points(row, least[r], turns)
        count = n = 0
        # A climb smaller than both of its neighbours is the depth of a dip. One pass removes most
        # dips in this way, so the quadratic loop below has little left to do.
        for t in range(n_turns):
            turns[n] = turns[t]
            n += 1
            while n > 3:
                turn, climb = n - 3, abs(row[turns[n - 2]] - row[turns[n - 3]])
                before = abs(row[turns[n - 3]] - row[turns[n - 4]])
                if climb >= before or climb >= abs(row[turns[n - 1]] - row[turns[n - 2]]):
                    break
                depths_found[count], columns_found[count] = climb, turns[turn + turn % 2]
                count += 1
                turns[turn] = turns[n - 1]
                n -= 2
        while n > 1:
            # The smallest climb is the depth of the shallowest dip: remove its minimum and maximum.
            turn, climb = 0, FAR
            for t in range(n - 1):
                if abs(row[turns[t + 1]] - row[turns[t]]) < climb:
                    turn, climb = t, abs(row[turns[t + 1]] - row[turns[t]])
            # For an odd turn, a maximum, remove the minimum that follows it.
            depths_found[count], columns_found[count] = climb, turns[turn + turn % 2]
            count += 1
            n -= 2
            # Close the gap of two turns.
            for t in range(turn, n):
                turns[t] = turns[t + 2]
        # The last minimum is the deepest dip; its depth is the range of the row.
        top = row[0]
        for c in range(columns):
            top = max(top, row[c])
        depths_found[count], columns_found[count] = top - row[turns[0]], turns[0]
        # Sort by depth, and leave out dips at the ends of the row.
        rank = 0
        for i in np.argsort(-depths_found[: count + 1], kind="mergesort"):
            if depths_found[i] >= least[r] and 0 < columns_found[i] < columns - 1:
                depths[r, rank], lowest[r, rank] = depths_found[i], columns_found[i]
                rank += 1
    return depths, lowest


@njit("int64[::1](int64[::1], float64, float64)", **OPTIONS)
def drop_extra_visits(visits, longest, most):
    """Drop visits whose neighbours are at most ``longest`` median repetitions apart.

    So a shock, or a short return to the pose, does not divide a repetition. The visit between the
    nearest neighbours is dropped first. None is dropped if more than a share ``most`` would be.
    """
    kept = visits.copy()
    n = len(kept)
    while n > 2:
        extra = 1
        for v in range(2, n - 1):
            if kept[v + 1] - kept[v - 1] < kept[extra + 1] - kept[extra - 1]:
                extra = v
        if kept[extra + 1] - kept[extra - 1] > longest * np.median(np.diff(kept[:n])):
            break
        if len(visits) - n + 1 > most * len(visits):
            return visits
        kept[extra : n - 1] = kept[extra + 1 : n].copy()
        n -= 1
    return kept[:n]


@njit("Tuple((float64[:, ::1], float64[::1]))(float32[:, ::1], int64)", **OPTIONS)
def smooth_rows(rows, smoothing):
    """Average rows over ``smoothing`` frames on each side; return them and their mean speeds."""
    n, dims = rows.shape
    # Cumulative sums, so that a mean is one difference.
    sums = np.zeros((n + 1, dims))
    for f in range(n):
        for d in range(dims):
            sums[f + 1, d] = sums[f, d] + rows[f, d]
    poses, speeds = np.empty((n, dims)), np.empty(n)
    for f in range(n):
        # The window is cut at the ends.
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
    """Return the poses at the given lengths along the path."""
    found_poses = np.empty((len(lengths), poses.shape[1]))
    # Binary search for the last frame up to each length.
    for i in range(len(lengths)):
        low, high = 0, len(path)  # range of the first frame beyond this length
        while low < high:
            middle = (low + high) // 2
            if path[middle] <= lengths[i]:
                low = middle + 1
            else:
                high = middle
        frame = min(max(low - 1, 0), len(poses) - 1)
        for d in range(poses.shape[1]):
            found_poses[i, d] = poses[frame, d]
    return found_poses


@njit("float64[::1](float64[:, :, ::1], float64)", **SUMS)
def measure_unexplained(repetitions, centering):
    """Return the share of each repetition that the mean of the others does not explain, 0 to 1.

    It is 1 minus the square of their correlation, or 1 if that is negative. So it does not depend
    on size. First, ``centering`` times its mean is subtracted from each repetition.
    """
    count, places, dims = repetitions.shape
    rows = np.empty((count, places * dims))
    total = np.zeros(places * dims)
    mean = np.empty(dims)
    # Flatten the centred repetitions to rows, and sum them.
    for k in range(count):
        mean[:] = 0
        for p in range(places):
            for d in range(dims):
                mean[d] += repetitions[k, p, d]
        for p in range(places):
            for d in range(dims):
                # `mean` holds a sum, hence the division by places.
                value = repetitions[k, p, d] - mean[d] * (centering / places)
                rows[k, p * dims + d] = value
                total[p * dims + d] += value
    # Correlate each row with the sum of the others, which is proportional to their mean.
    unexplained = np.empty(count)
    for k in range(count):
        product = square = other = 0.0
        for column in range(places * dims):
            rest = total[column] - rows[k, column]
            product += rows[k, column] * rest
            square += rows[k, column] * rows[k, column]
            other += rest * rest
        # Negative correlations count as 0; the lower limit avoids 0 / 0.
        unexplained[k] = 1 - max(product, 0.0) ** 2 / max(square * other, 1e-24)
    return unexplained


@njit("float64[:, :, ::1](float64[:, ::1], float64[::1], int64[::1], int64)", **OPTIONS)
def sample_repetitions(poses, path, visits, places):
    """Sample poses evenly along the path between visits: (repetitions, places, dims)."""
    repetitions = np.empty((len(visits) - 1, places, poses.shape[1]))
    lengths = np.empty(places)
    for k in range(len(repetitions)):
        first, last = path[visits[k]], path[visits[k + 1]]
        for p in range(places):
            # Middles of equal parts of the path.
            lengths[p] = first + (last - first) * ((p + 0.5) / places)
        reached = look_up_poses(poses, path, lengths)
        for p in range(places):
            for d in range(poses.shape[1]):
                repetitions[k, p, d] = reached[p, d]
    return repetitions


@njit("float64(float64[::1])", **OPTIONS)
def find_upper_median(values):
    """Return the median, or the upper one of two middle values."""
    ordered = np.empty(len(values))
    # Insertion sort: a division has few repetitions.
    for k in range(len(values)):
        position = k
        while position > 0 and ordered[position - 1] > values[k]:
            ordered[position] = ordered[position - 1]
            position -= 1
        ordered[position] = values[k]
    return ordered[len(values) // 2]


@njit("float64[:, ::1](float64[:, :, ::1])", **OPTIONS)
def average_repetitions(repetitions):
    """Return the mean (places, dims) of repetitions (repetitions, places, dims)."""
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
    """Return the mean squared distance of repetitions from their mean; 0 for one repetition."""
    count, places, dims = repetitions.shape
    total = 0.0
    for k in range(count):
        for p in range(places):
            for d in range(dims):
                difference = repetitions[k, p, d] - mean[p, d]
                total += difference * difference
    # One degree of freedom less, as the mean is computed from the same repetitions.
    return total / (places * max(count - 1, 1))


@njit("Tuple((int64, float64))(float64[:, ::1], float64)", **OPTIONS)
def match_columns(gains, full):
    """Find the warping path with the largest gain; return its columns, and how many count.

    Return 0 for both if no path gains. Paths begin before the first row and column. Steps (1, 1)
    count a gain twice, (1, 2) and (2, 1) three times. A column counts by its gain as a share of
    ``full``, 0 to 1.
    """
    rows, columns = gains.shape
    sums = np.full((rows + 2, columns + 2), -np.inf)
    sums[1, 1] = 0
    best, row, column = 0.0, -1, -1
    # Largest sum of a path to each entry (i, j), stored at (i + 2, j + 2) to avoid border cases.
    for i in range(rows):
        for j in range(columns):
            straight = sums[i + 1, j + 1] + 2 * gains[i, j]
            bent = max(sums[i, j + 1], sums[i + 1, j]) + 3 * gains[i, j]
            sums[i + 2, j + 2] = max(straight, bent)
            if sums[i + 2, j + 2] > best:
                best, row, column = sums[i + 2, j + 2], i, j
    # Backtrack along the best path and add up how much its columns count.
    length, count = column + 1, 0.0
    while row >= 0:
        share = min(max(gains[row, column] / full, 0.0), 1.0)
        bent = max(sums[row, column + 1], sums[row + 1, column])
        # The same comparison as in the forward pass.
        if 2 * gains[row, column] + sums[row + 1, column + 1] >= 3 * gains[row, column] + bent:
            count, row, column = count + share, row - 1, column - 1
        elif sums[row, column + 1] >= sums[row + 1, column]:
            count, row, column = count + share, row - 2, column - 1
        else:
            # A step of two columns also counts the skipped one.
            count, row, column = count + 2 * share, row - 1, column - 2
    return length, count


@njit("float64[::1](float64, float64, int64, int64, float64)", **OPTIONS)
def place_steps(begin, step, places, number, path_length):
    """Return ``number`` lengths from ``begin`` on, ``places`` per step; drop those off the path."""
    lengths = np.empty(number)
    count = 0
    for i in range(number):
        # A negative step goes backwards.
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
    """Return how many places of the mean the poses at these lengths follow, and how many count.

    ``near`` and ``full`` are squared distances from the mean: a pose has a positive gain below
    ``near``, and counts in full up to ``full``.
    """
    reached = look_up_poses(poses, path, lengths)
    # The gain is `near` less the squared distance.
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
def measure_division(poses, path, visits, places, near, max_end, centering, max_scatter):
    """Return the lengths of both ends, how much of them counts, and the unexplained share.

    Lengths are in repetitions. The ends lie before the first visit and after the last. An end is
    as long as it follows the mean repetition, at most ``max_end`` repetitions. Its poses are
    nearer to the mean than ``near``, a squared distance. They count in full up to ``max_scatter``
    times the mean squared distance of repetitions. The unexplained share is that of the activity.
    """
    # Lengths of the repetitions between visits, and their mean repetition.
    total_length = path[-1]
    count = len(visits) - 1
    lengths = np.empty(count)
    for k in range(count):
        lengths[k] = path[visits[k + 1]] - path[visits[k]]
    # The lower limit avoids a division by 0 if nothing moves.
    length = max(find_upper_median(lengths), 1e-12)
    inner = sample_repetitions(poses, path, visits, places)
    mean = average_repetitions(inner)
    first, last = path[visits[0]], path[visits[-1]]
    # Ends: backwards from the first visit along the reversed mean, forwards from the last visit.
    number_of_steps = int(places * max_end)
    before = place_steps(first, -length, places, number_of_steps, total_length)
    after = place_steps(last, length, places, number_of_steps, total_length)
    full = FARTHEST * near
    if count > 1:
        full = min(max_scatter * measure_scatter(inner, mean), full)
    to_head, in_head = follow_end(poses, path, before, np.ascontiguousarray(mean[::-1]), near, full)
    to_tail, in_tail = follow_end(poses, path, after, mean, near, full)
    head, tail = to_head / places, to_tail / places
    # Path outside of all repetitions, which is unexplained.
    outside = max(first - head * length, 0.0) + max(total_length - last - tail * length, 0.0)
    number = count + head + tail
    if count == 1:
        # Compare a single repetition with the rest of the path, sampled from the last visit on and
        # continued at the start.
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
    # For a single repetition, drop the share of the rest.
    shares = measure_unexplained(inner, centering)[:count]
    # Length of the path in both ends.
    inside = max(total_length - outside - lengths.sum(), 0.0)
    total = (shares.sum() / count * inside + outside) / total_length
    for k in range(count):  # a short repetition counts at least as much as one of mean length
        total += max(lengths[k] / total_length, 1 / number) * shares[k]
    return head, tail, (in_head + in_tail) / places, total


@njit("void(float32[:, ::1], float64, float64[::1])", **OPTIONS)
def interpolate_pose(rows, at, pose):
    """Interpolate the row at a time in frames; beyond the ends take the first or last row."""
    before = min(max(int(np.floor(at)), 0), len(rows) - 1)
    after = min(before + 1, len(rows) - 1)
    share = min(max(at - before, 0.0), 1.0)
    for d in range(rows.shape[1]):
        pose[d] = rows[before, d] * (1 - share) + rows[after, d] * share


@njit("float64[:, :, ::1](float32[:, ::1], int64[::1], int64[::1], int64)", **OPTIONS)
def sample_evenly(rows, starts, lengths, places):
    """Sample rows evenly in time over spans from ``starts`` on: (spans, places, dims)."""
    samples = np.empty((len(starts), places, rows.shape[1]))
    for k in range(len(starts)):
        for p in range(places):
            # Frame i covers [i, i + 1), so its middle is at i + 0.5.
            at = starts[k] + lengths[k] * ((p + 0.5) / places) - 0.5
            interpolate_pose(rows, at, samples[k, p])
    return samples


@njit("int64(float32[:, ::1], int64, int64, int64, float64[:, ::1])", **SUMS)
def find_best_length(rows, stop, shortest, longest, mean):
    """Return the length of the span before ``stop`` that is nearest to the mean repetition."""
    places, dims = mean.shape
    pose = np.empty(dims)
    best, least = shortest, np.inf
    for length in range(shortest, longest + 1):
        misfit = 0.0
        for p in range(places):
            # Positions evenly spaced in time; see `sample_evenly`.
            interpolate_pose(rows, stop - length + length * ((p + 0.5) / places) - 0.5, pose)
            for d in range(dims):
                difference = pose[d] - mean[p, d]
                misfit += difference * difference
        if misfit < least:
            best, least = length, misfit
    return best


@njit("void(float64[:, :, ::1])", **OPTIONS)
def center_repetitions(repetitions):
    """Subtract its mean pose from each repetition, (repetitions, places, dims), in place."""
    count, places, dims = repetitions.shape
    for k in range(count):
        for d in range(dims):
            mean = 0.0
            for p in range(places):
                mean += repetitions[k, p, d]
            for p in range(places):
                repetitions[k, p, d] -= mean / places


@njit("float64(float64[::1])", **OPTIONS)
def measure_evenness(durations):
    """Return 1 for equal durations, 0 if the deviation of their logarithms reaches a half."""
    # Logarithms, so that twice as long and half as long are equally uneven.
    return 1 - min(2 * np.log(durations).std(), 1.0) ** 2


@njit("float64(int64[::1], float64, float64, float64, float64, float64)", **OPTIONS)
def score_durations(visits, fps, max_repetition, chance_period, chance_count, chance_duration):
    """Return an upper bound of the share that a division saves, from its durations; 0 to 1."""
    count = len(visits)
    # Two visits enclose one repetition, which no other can explain.
    if count < 3:
        return 0.0
    durations = np.diff(visits) / fps
    if durations.max() > max_repetition:
        return 0.0
    fast = min(chance_period / durations.mean(), 1.0) ** 2
    chance = min(chance_count, chance_duration / durations.mean())
    return measure_evenness(durations) * (1 - max(fast, min(chance / count, 1.0)))


@njit("float64(float64[:, ::1], float64[::1], int64[::1], float64[:, :, ::1])", **SUMS)
def explain_variance(poses, path, visits, centered):
    """Return the share of the variance of repetitions that the mean of the others explains.

    The mean of the others is scaled by the factor that fits best, and compared frame by frame.
    ``centered`` are the centred repetitions.
    """
    count, places, dims = centered.shape
    total = centered.sum(axis=0)
    mean = np.empty((places, dims))
    expected, rest = np.empty(dims), np.empty(dims)
    left = 0.0
    for k in range(count):
        # Mean of the others, and the factor that fits it to this repetition.
        product = mean_square = 0.0
        for p in range(places):
            for d in range(dims):
                # Sum of all less this one is the sum of the others.
                mean[p, d] = (total[p, d] - centered[k, p, d]) / (count - 1)
                product += centered[k, p, d] * mean[p, d]
                mean_square += mean[p, d] * mean[p, d]
        # A negative factor would reverse the movement, so it is at least 0.
        size = max(product, 0.0) / max(mean_square, 1e-12)
        # Residual of each frame: the mean is interpolated at the frame's position on the path.
        first, last = visits[k], visits[k + 1]
        length = max(path[last] - path[first], 1e-12)
        residuals = np.empty((last - first, dims))
        for f in range(first, last):
            # Places are at the middles of equal parts of the path, hence - 0.5.
            phase = (path[f] - path[first]) / length * places - 0.5
            low = min(max(int(np.floor(phase)), 0), places - 1)
            high = min(low + 1, places - 1)
            share = min(max(phase - low, 0.0), 1.0)
            for d in range(dims):
                fitted = mean[low, d] * (1 - share) + mean[high, d] * share
                residuals[f - first, d] = poses[f, d] - size * fitted
        # Variances of residuals and of poses. The latter starts above 0, to avoid division by 0.
        residual, variance = 0.0, 1e-12
        for d in range(dims):
            expected[d] = rest[d] = 0.0
            for f in range(first, last):
                expected[d] += poses[f, d] / (last - first)
                rest[d] += residuals[f - first, d] / (last - first)
            for f in range(first, last):
                residual += (residuals[f - first, d] - rest[d]) ** 2
                variance += (poses[f, d] - expected[d]) ** 2
        noise = (count - 1) / count  # correction for the noise of a mean of few repetitions
        # Limited to 1: a repetition that does not fit at all is unexplained. Weighted by frames.
        left += min(residual * noise / variance, 1.0) * (last - first)
    return 1 - left / (visits[-1] - visits[0])


@njit("float64(float64[:, ::1], float64[::1], int64, int64)", **SUMS)
def _measure_residual(rows, total, start, stop):
    """Return the sum of squares of rows that the scaled mean of the other rows does not explain.

    ``total`` is the sum of the rows from start to stop.
    """
    count = stop - start
    left = 0.0
    for k in range(start, stop):
        product = mean_square = square = 0.0
        for e in range(rows.shape[1]):
            mean = (total[e] - rows[k, e]) / (count - 1)
            product += mean * rows[k, e]
            mean_square += mean * mean
            square += rows[k, e] * rows[k, e]
        # Residual of the best factor, corrected for the noise of a mean of few rows.
        left += (square - max(product, 0.0) ** 2 / max(mean_square, 1e-12)) * (count - 1) / count
    return left


@njit("float64(float64[:, :, ::1])", **OPTIONS)
def find_best_parting(centered):
    """Find the best split into first and last repetitions, each described by its own mean.

    Return the residual of two means as a share of that of one mean; 1 without a split.
    """
    count = len(centered)
    # Cumulative sums, so that the sum of a range is one difference.
    rows = centered.copy().reshape(count, -1)
    sums = np.zeros((count + 1, rows.shape[1]))
    for k in range(count):
        for e in range(rows.shape[1]):
            sums[k + 1, e] = sums[k, e] + rows[k, e]
    # Added to both residuals, so that nearly equal repetitions are one movement.
    rough = 1e-12
    for k in range(count):
        for e in range(rows.shape[1]):
            rough += ROUGH * rows[k, e] * rows[k, e]
    one_mean = _measure_residual(rows, sums[count], 0, count)
    best = 1.0
    for cut in range(MIN_COUNT, count - MIN_COUNT + 1):
        # Residuals of both parts, each with at least MIN_COUNT repetitions.
        two_means = _measure_residual(rows, sums[cut], 0, cut)
        two_means += _measure_residual(rows, sums[count] - sums[cut], cut, count)
        best = min(best, (two_means + rough) / (one_mean + rough))
    return best


@njit("float64(float32[:, ::1], int64, int64, int64)", **SUMS)
def measure_spread(view, start, stop, most):
    """Return the cost of a span: half the mean distance of its samples, times their number.

    It is estimated from at most ``most`` samples.
    """
    stop = min(stop, len(view))
    count = min(most, stop - start)
    total = 0.0
    for i in range(count):
        for j in range(i):
            # Evenly spaced samples of the span.
            a, b = start + i * (stop - start) // count, start + j * (stop - start) // count
            square = 0.0
            for d in range(view.shape[1]):
                difference = view[a, d] - view[b, d]
                square += difference * difference
            total += np.sqrt(square)
    # The mean over ordered pairs is 2 * total / count²; the cost is half of that per sample.
    return (stop - start) * total / max(count * count, 1)


@njit("float64[:, ::1](float64[:, :, ::1])", **SUMS)
def measure_similarities(movements):
    """Return the similarity of pairs of movements (movements, places, dims) at the best phase.

    It is 1 - squared distance / sum of variances.
    """
    count, places, dims = movements.shape
    variances = np.zeros(count)
    for k in range(count):
        for d in range(dims):
            mean = 0.0
            for p in range(places):
                mean += movements[k, p, d] / places
            for p in range(places):
                variances[k] += (movements[k, p, d] - mean) ** 2
    # Try each phase: a circular shift of one movement against the other.
    similarities = np.ones((count, count))
    for k in range(count):
        for other in range(k):
            min_distance = np.inf
            for shift in range(places):
                distance = 0.0
                for p in range(places):
                    for d in range(dims):
                        difference = movements[k, (p + shift) % places, d] - movements[other, p, d]
                        distance += difference * difference
                min_distance = min(min_distance, distance)
            similarity = 1 - min_distance / max(variances[k] + variances[other], 1e-12)
            similarities[k, other] = similarities[other, k] = similarity
    return similarities
