"""Makes the fixed mean and axes of the matching features, and shows how little the corpus matters.

    python -m benchmarks canonical_basis [--write] [--leave-out]

The corpora count alike, whatever their length. ``--write`` replaces
``src/kineme/features/canonical/basis.npz``. ``--leave-out`` makes them without each corpus in turn,
and prints the figures of ``benchmarks/truth/likeness.py`` for each.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from _corpora import corpora, poses_of
from _options import command_line
from kineme.features.canonical import matching

Floats = NDArray[np.float64]

SHRINKING = 0.3
"""Of the largest variance; added to that of each axis before its root divides."""


def make_basis(parts: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Mean and axes of stacked poses, each corpus with the same weight."""
    mean = np.mean([part.mean(axis=0) for part in parts], axis=0)
    spread = np.mean([(part - mean).T @ (part - mean) / len(part) for part in parts], axis=0)
    variances, axes = np.linalg.eigh(spread)
    variances, axes = variances[: -matching.DIMS - 1 : -1], axes[:, : -matching.DIMS - 1 : -1]
    axes = axes * np.sign(axes[np.abs(axes).argmax(axis=0), np.arange(matching.DIMS)])
    return mean, axes / np.sqrt(variances + SHRINKING * variances[0])


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--write", action="store_true", help="into the package")
    parser.add_argument("--leave-out", action="store_true", help="each corpus in turn")
    options = parser.parse_args()
    parts = {
        name: np.concatenate([poses_of(take) for take in takes])
        for name, takes in corpora().items()
    }
    print("seconds:", {name: round(len(part) / 15) for name, part in parts.items()})
    mean, axes = make_basis(list(parts.values()))
    if options.write and not options.quick:
        path = Path(matching.__file__).with_name("basis.npz")
        np.savez(path, mean=mean.astype(np.float32), axes=axes.astype(np.float32))
        print(path.name, path.stat().st_size, "bytes")
    if options.leave_out:
        from likeness import show

        works = ("exercises", "strides")
        show("all", works, (mean, axes))
        for left in parts:
            kept = [part for name, part in parts.items() if name != left]
            show(f"without {left}", works, make_basis(kept))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
