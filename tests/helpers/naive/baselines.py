"""Naive versions of other methods, as in their programs and papers."""

from __future__ import annotations

import numpy as np

# --- ACA and HACA (Zhou, De la Torre, Hodgins 2013): the programs' loops, entry by entry ---


def compute_dtak(kernel, a_weights, b_weights):
    """Return the dynamic time alignment kernel of two segments, from that of their frames."""
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


def propagate_kernel(kernel, longest):
    """Set entry (a, b), a < b, to the best square of width 1 to longest with it as a corner."""
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


def list_covers(n, shortest, longest):
    """Return all ways to cut n frames into lengths of shortest to longest."""
    if n == 0:
        return [[]]
    ways = []
    for last in range(shortest, min(longest, n) + 1):
        ways += [[*way, last] for way in list_covers(n - last, shortest, longest)]
    return ways


def compute_cover_cost(costs, lengths):
    """Return the total cost of consecutive windows of these lengths."""
    stops = np.cumsum(lengths)
    return sum(costs[stop - 1, length - 1] for stop, length in zip(stops, lengths, strict=True))


def find_first_segmentation(labels, shortest, longest):
    """Return segment lengths as the program's ``mergeDP`` finds them, including its bug."""
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


def find_pca_cut(features, first, lag):
    """Return the first frame whose projection error rises by mean + 3 deviations, or None."""

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


def compute_ppca_distances(features, ahead, growth):
    """Return H by number of modelled frames."""
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


def find_ppca_cut(features, ahead, growth):
    """Return the first peak of H a tenth of its range above the lowest H before it, or None."""
    found = compute_ppca_distances(features, ahead, growth)
    counts, values = list(found), list(found.values())
    for i in range(1, len(values) - 1):
        peak = values[i] > values[i - 1] and values[i] >= values[i + 1]
        if peak and values[i] - min(values[:i]) >= (max(values) - min(values)) / 10:
            return counts[i]
    return None
