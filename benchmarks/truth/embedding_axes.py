"""Makes the fixed mean and axes of the embedding of segments.

    python -m benchmarks embedding_axes [--write] [--leave-out]

Spans of 0.7 to 4 s are drawn from all corpora alike, without regard to their labels, and copied
with other speeds, sizes, ends, mirrored and with noise. Axes are those along which spans differ
most where the copies of one differ by one unit. ``--write`` replaces
``src/kineme/matching/axes.npz``. ``--leave-out`` makes them without each corpus in turn, and prints
the figures of ``benchmarks/truth/likeness.py segments`` for each.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import kineme.matching
from _corpora import corpora
from _options import command_line, few
from kineme._interpolation import at_frames
from kineme.features.canonical import MATCHING_FPS, matching_poses, mirror_poses
from kineme.matching.embeddings import DIMS, course

Floats = NDArray[np.float64]

SPANS, COPIES = 1600, 6
SECONDS = (0.7, 4.0)
SPEED, SIZE = 0.5, 0.4
"""Powers of two: the largest change of either."""
CUT, WARP = 0.1, 0.2
"""Shares of a span: lost at either end, and by which time runs unevenly."""
MIRRORED = 0.2
"""Share of the copies."""
SHIFT, SHAKE = 0.05, 0.025
"""Leg lengths, standard deviations: of a whole copy, and of each of its poses."""
LEAST = 0.5
"""Of the mean variance of copies; added to that of each axis."""


def courses(corpus: Mapping[str, Sequence[Floats]], seed: int = 0) -> Floats:
    """(spans, copies, 68): the courses of copies of spans of poses."""
    rng = np.random.default_rng(seed)
    middle = np.mean([np.concatenate(takes).mean(axis=0) for takes in corpus.values()], axis=0)
    found = []
    for takes in corpus.values():
        long = [poses for poses in takes if len(poses) >= MATCHING_FPS]
        share = np.array([len(poses) for poses in long], float)
        for _ in range(few(SPANS, 80) // len(corpus)):
            poses = long[rng.choice(len(long), p=share / share.sum())]
            n = round(MATCHING_FPS * np.exp(rng.uniform(*np.log(SECONDS))))
            n = min(len(poses), n)
            start = rng.integers(0, len(poses) - n + 1)
            span = poses[start : start + n]
            copies = [copied(span, middle, rng) for _ in range(COPIES)]
            found.append([course(copy) for copy in copies])
    return np.array(found)


def copied(poses: Floats, middle: Floats, rng: np.random.Generator) -> Floats:
    """One copy, all of its changes at random."""
    first, last = rng.uniform(0, CUT, 2) * len(poses)
    speed = 2.0 ** rng.uniform(-SPEED, SPEED)
    share = np.linspace(0, 1, max(2, round((len(poses) - first - last) / speed)))
    for waves in (1, 2):
        uneven = WARP * rng.normal() / waves
        share = share + uneven * np.sin(waves * np.pi * share) / np.pi
    share = np.maximum.accumulate(np.clip(share, 0, 1))
    copy = at_frames(poses, first + share * (len(poses) - 1 - first - last))
    copy = middle + 2.0 ** rng.uniform(-SIZE, SIZE) * (copy - middle)
    if rng.random() < MIRRORED:
        copy = mirror_poses(copy)
    return copy + rng.normal(0, SHIFT, copy.shape[1]) + rng.normal(0, SHAKE, copy.shape)


def make_axes(found: Floats) -> tuple[Floats, Floats]:
    """Mean (68,) and axes (68, 32) from courses of copies."""
    spans = found.mean(axis=1)
    mean = spans.mean(axis=0)
    apart = (found - spans[:, None]).reshape(-1, found.shape[2])
    within = apart.T @ apart / (len(spans) * (COPIES - 1))
    between = (spans - mean).T @ (spans - mean) / len(spans)
    variances, turn = np.linalg.eigh(within)
    whitened = turn / np.sqrt(variances + LEAST * variances.mean())
    _, turn = np.linalg.eigh(whitened.T @ (between + within) @ whitened)
    axes = whitened @ turn[:, : -DIMS - 1 : -1]
    return mean, axes * np.sign(axes[np.abs(axes).argmax(axis=0), np.arange(DIMS)])


def poses_of(names: Iterable[str]) -> dict[str, list[Floats]]:
    takes = corpora()
    return {name: [matching_poses(take.motion) for take in takes[name]] for name in names}


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--write", action="store_true", help="into the package")
    parser.add_argument("--leave-out", action="store_true", help="each corpus in turn")
    options = parser.parse_args()
    corpus = poses_of(corpora())
    mean, axes = make_axes(courses(corpus))
    if options.write and not options.quick:
        path = Path(kineme.matching.__file__).with_name("axes.npz")
        np.savez(path, mean=mean.astype(np.float32), axes=axes.astype(np.float32))
        print(path.name, path.stat().st_size, "bytes")
    if options.leave_out:
        from likeness import show

        show("all", ["segments"], (mean, axes))
        for left in corpus:
            kept = {name: poses for name, poses in corpus.items() if name != left}
            show(f"without {left}", ["segments"], make_axes(courses(kept)))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
