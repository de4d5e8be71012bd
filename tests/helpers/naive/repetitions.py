"""Naive versions of the kernels of the ``kineme`` method: literal sums and exhaustive search."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np

# --- segments and repetitions; bands are full matrices ----------------------------------------


def compute_division_cost(similarity, borders, penalty):
    """Return the cost of a division: length less mean similarity plus penalty, per segment."""
    return sum(
        stop - start - similarity[start:stop, start:stop].sum() / (stop - start) + penalty
        for start, stop in pairwise(borders)
    )


def list_divisions(n, longest):
    """Return the borders of all divisions of n samples into segments of at most ``longest``."""
    return [
        [0, *inner, n]
        for count in range(n)
        for inner in combinations(range(1, n), count)
        if all(b - a <= longest for a, b in pairwise([0, *inner, n]))
    ]


def find_dips(row, least):
    """Return (depth, column) of each dip of a row without equal values, deepest first.

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


def drop_extra_visits(visits, longest, most):
    """Drop visits, one by one, whose neighbours are at most ``longest`` median lengths apart."""
    kept = list(visits)
    while len(kept) > 2:
        around = [later - earlier for earlier, later in zip(kept, kept[2:], strict=False)]
        if min(around) > longest * np.median(np.diff(kept)):
            break
        del kept[1 + around.index(min(around))]
    return kept if len(visits) - len(kept) <= most * len(visits) else list(visits)


def score_durations(visits, fps, longest, chance_period, chance_count, chance_duration):
    """Return evenness times the share that is not explained by chance, by period or number."""
    durations = np.diff(visits) / fps
    if len(visits) < 3 or durations.max() > longest:
        return 0.0
    fast = min(chance_period / durations.mean(), 1) ** 2
    even = 1 - min(2 * np.log(durations).std(), 1) ** 2
    few = min(chance_count, chance_duration / durations.mean()) / len(visits)
    return even * (1 - max(fast, min(few, 1)))


def look_up_poses(poses, path, lengths):
    """Return the pose of the last frame at which the path is at most each of these lengths."""
    last = [max((f for f in range(len(poses)) if path[f] <= x), default=0) for x in lengths]
    return np.array([poses[f] for f in last])


def measure_unexplained(parts, centering):
    """Return 1 - squared positive correlation of each part with the mean of all others."""
    rows = [(part - centering * part.mean(axis=0)).ravel() for part in parts]
    found = []
    for k, row in enumerate(rows):
        others = np.mean(rows[:k] + rows[k + 1 :], axis=0)
        found.append(1 - max(row @ others, 0) ** 2 / ((row @ row) * (others @ others)))
    return found


def explain_variance(poses, path, visits, repetitions):
    """Return the share of frames that the scaled mean of the other repetitions explains."""
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


def _measure_residual(repetitions):
    """Return the residual of repetitions from the scaled mean of the others, summed."""
    rows = [part.ravel() for part in repetitions]
    left = 0.0
    for k, row in enumerate(rows):
        mean = np.mean(rows[:k] + rows[k + 1 :], axis=0)
        size = max(row @ mean, 0) / (mean @ mean)
        left += ((row - size * mean) ** 2).sum() * (len(rows) - 1) / len(rows)
    return left


def find_best_parting(repetitions):
    """Return the least residual of two means (first, last) relative to that of one mean."""
    cuts = range(2, len(repetitions) - 1)
    rough = 0.02 * np.square(repetitions).sum()
    one = _measure_residual(repetitions) + rough
    two = [
        _measure_residual(repetitions[:cut]) + _measure_residual(repetitions[cut:]) + rough
        for cut in cuts
    ]
    return min([1.0, *(each / one for each in two)])


def measure_similarities(movements):
    """Return 1 - least squared distance over all circular shifts / sum of variances."""
    spreads = [((each - each.mean(axis=0)) ** 2).sum() for each in movements]
    return [
        [
            1 - min(((np.roll(a, by, axis=0) - b) ** 2).sum() for by in range(len(a))) / (s + t)
            for b, t in zip(movements, spreads)
        ]
        for a, s in zip(movements, spreads)
    ]


def measure_spread(view, start, stop):
    """Return half of the summed distances of samples of a span, divided by its length."""
    inside = view[start:stop]
    return sum(np.linalg.norm(a - b) for a in inside for b in inside) / (2 * len(inside))


def compute_similarity_band(features, unit, width):
    """Return 1 - distance of each sample to itself and to those after it, in units."""
    n = len(features)
    found = np.zeros((n, width))
    for i in range(n):
        for lag in range(min(width, n - i)):
            found[i, lag] = 1 - np.linalg.norm(features[i] - features[i + lag]) / unit
    return found


def compute_mean_distances(features, segments, unit):
    """Return the mean distances between samples of two segments, in units."""
    return [
        [
            np.mean([[np.linalg.norm(features[a] - features[b]) for b in h] for a in g]) / unit
            for h in segments
        ]
        for g in segments
    ]


def smooth_rows(rows, smoothing):
    """Return moving averages of the rows, and their mean change per frame."""
    n = len(rows)
    around = [(max(f - smoothing, 0), min(f + smoothing, n - 1)) for f in range(n)]
    poses = np.array([rows[a : b + 1].mean(axis=0) for a, b in around])
    return poses, [np.linalg.norm(poses[b] - poses[a]) / max(b - a, 1) for a, b in around]


def measure_division(poses, path, visits, places, near, followed_for, centering, scattered):
    """Return lengths of both ends, how much of them counts, and the unexplained share."""
    end, at = path[-1], np.array([path[visit] for visit in visits])
    lengths = np.diff(at)
    length = sorted(lengths)[len(lengths) // 2]
    inner = [
        look_up_poses(poses, path, a + (b - a) * ((np.arange(places) + 0.5) / places))
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
        found = look_up_poses(poses, path, inside)
        gains = near - ((found[:, None] - expected) ** 2).sum(axis=2) if len(found) else []
        ends.append(np.divide(_match_columns_by_rows(gains, near - full), places))
    (before, counted_before), (after, counted_after) = ends
    outside = max(at[0] - before * length, 0) + max(end - at[-1] - after * length, 0)
    if len(inner) == 1:
        ahead = at[-1] + (end - length) * steps[:places]
        inner.append(look_up_poses(poses, path, [a if a < end else a - end for a in ahead]))
    shares = np.array(measure_unexplained(inner, centering)[: len(lengths)])
    between = max(end - outside - lengths.sum(), 0)
    weights = np.maximum(lengths / end, 1 / (len(lengths) + before + after))
    total = weights @ shares + (shares.mean() * between + outside) / end
    counted = counted_before + counted_after
    return before, after, counted, total


WARPING = ((1, 1), (1, 2), (2, 1))


def _match_columns_by_rows(gains, full):
    """Return the length of the best warping path and how much counts, row by row."""
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


def sample_evenly(rows, start, length, places):
    at = start + length * ((np.arange(places) + 0.5) / places) - 0.5
    return np.array([np.interp(at, np.arange(len(rows)), column) for column in rows.T]).T


def find_best_length(rows, stop, shortest, longest, mean):
    """Return the length of the span before a frame that is nearest to the mean."""
    return min(
        range(shortest, longest + 1),
        key=lambda n: ((sample_evenly(rows, stop - n, n, len(mean)) - mean) ** 2).sum(),
    )


# --- occurrences ------------------------------------------------------------------------------

PATH_STEPS = ((1, 1, 1.0), (1, 2, 1.5), (2, 1, 1.5))


def score_pair(samples, costs, i, j, scale):
    square = float(((samples[i] - samples[j]) ** 2).sum())
    return 1 - square / scale**2 - (costs[i] + costs[j]) / 2


def find_local_path_scores(samples, costs, begins, gap, width, scale):
    """Return the score of the best path from each first pair, if above 0."""
    n = len(samples)
    at, best = {}, {}
    for i in range(n):
        for j in range(i + gap, min(i + width + 1, n)):
            score = score_pair(samples, costs, i, j, scale)
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


def trace_path_score(samples, costs, ends, scale):
    """Return the score of the best path from the first of two pairs to the second."""
    i0, j0, i1, j1 = ends
    scores = {(i0, j0): score_pair(samples, costs, i0, j0, scale)}
    for i in range(i0, i1 + 1):
        for j in range(j0, j1 + 1):
            options = [
                scores[i - a, j - b] + weight * score_pair(samples, costs, i, j, scale)
                for a, b, weight in PATH_STEPS
                if (i - a, j - b) in scores
            ]
            if options:
                scores[i, j] = max(options)
    return scores[i1, j1]


def find_recurrences(start, stop, paths, free, cover):
    """Return recurrences of a span by paths (first sample, partners, sums): spans, gains, parts."""
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


def find_cheapest_grouping(sums, lengths, most, segment_cost, cluster_cost):
    """Return cost and clusters of the cheapest grouping; compare all pairs before each merge."""
    clusters = [[g] for g in range(len(lengths))]

    def total(a, b):
        return sum(sums[g][h] for g in a for h in b)

    def size(a):
        return sum(lengths[g] for g in a)

    def mean(a, b):
        return total(a, b) / (size(a) * size(b))

    def distance(a, b):
        return mean(a, b) - (mean(a, a) + mean(b, b)) / 4

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
