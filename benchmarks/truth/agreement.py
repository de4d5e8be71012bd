"""Compare with the authors' own program on five trials and list every difference.

    python -m benchmarks agreement [--record]

Frames are counted from 1 at 30 Hz, as in the reference files (``cmu86/reference``). A cut agrees
if the program has one at the same frame. Clusters are compared on segments that both have: a
segment differs if it must change its cluster to make the partitions equal.

With our bundling, cuts may lie a frame apart, because the program stops its minimisation early;
"as stored" uses the program's own bundled features.

In ``2014_paper`` only the activities come from the authors' code. Its primitives and clusters
reimplement lost functions, so a difference there is no error.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

import kineme
from _figures import add_option, record
from _options import DATA, choose_size, find_data, make_parser
from kineme.evaluation import Comparison
from kineme.features import mirror_features
from kineme.methods.prepare import compute_motion_features
from kineme.methods.region_growing.analysis import RegionsFound, analyze_regions
from kineme.methods.region_growing.preset import KRUEGER2017, VOEGELE2014, RegionGrowingPreset

TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")
LEVELS = ("activities", "primitives", "clusters")


def _make_preset(
    offsets: range, radius: float, growth_radius: float, neighbors: int, **parts: Any
) -> RegionGrowingPreset:
    """Return the preset of the 2017 program, from frames at 30 Hz and radii in metres per block."""
    parts = {"bundling": None, **parts}
    return KRUEGER2017.replace(
        offsets=tuple(offset / 30 for offset in offsets),
        radius=radius * math.sqrt(len(offsets)),
        growth_radius=growth_radius * math.sqrt(len(offsets)),
        max_neighbors=neighbors,
        **parts,
    )


FIVE, NINE = range(-10, 11, 5), range(-8, 9, 2)  # offsets of the stacked frames

# Reference configuration and our preset. The 2014 reference was run with one more warping step
# than the paper gives.
CONFIGURATIONS = {
    "voegele2014": ("2014_paper", VOEGELE2014),
    "voegele2014 as run": (
        "2014_paper",
        VOEGELE2014.replace(steps=(*VOEGELE2014.steps, (10, 10))),
    ),
    "2017_plain": ("2017_plain", _make_preset(FIVE, 0.302, 0.27, 600)),
    "2017_evaluation_1": ("2017_evaluation_1", _make_preset(NINE, 0.296, 0.25, 800)),
    "2017_evaluation_2": ("2017_evaluation_2", _make_preset(range(-6, 7, 2), 0.296, 0.32, 800)),
    "2017_mirrored": ("2017_mirrored", _make_preset(FIVE, 0.30, 0.25, 800, mirror=True)),
    "2017_bundled": ("2017_bundled", _make_preset(FIVE, 0.21, 0.11, 800, bundling=32)),
    "2017_bundled as stored": ("2017_bundled", _make_preset(FIVE, 0.21, 0.11, 800)),
    "2017_bundled_mirrored": (
        "2017_bundled_mirrored",
        _make_preset(NINE, 0.25, 0.11, 800, bundling=32, mirror=True),
    ),
    "krueger2017": ("2017_program_defaults", KRUEGER2017),
    "krueger2017 as stored": ("2017_program_defaults", KRUEGER2017.replace(bundling=None)),
}


@dataclass(frozen=True)
class Agreement:
    """Agreement of one level with the reference, and a text for each difference.

    ``far`` counts the cuts, ours and theirs, farther than a frame from all of the other side.
    """

    total: int
    differences: tuple[str, ...]
    far: int = 0


def compare(data: Path, configuration: str, trial: str) -> dict[str, Agreement]:
    """Compare one configuration on one trial, by level."""
    name, preset = CONFIGURATIONS[configuration]
    path = data / "cmu86" / "reference" / f"{name}_{trial}.json"
    reference = json.loads(path.read_text())
    if configuration.endswith("as stored"):
        with np.load(data / "cmu86" / "reference" / f"2017_bundled_{trial}.npz") as stored:
            features = stored["features"].T / 100.0
    else:
        features = compute_motion_features(kineme.read(data / "cmu86" / f"{trial}.amc"), preset)
    found = analyze_regions(features, preset, mirror=mirror_features)
    activities = set((found.activity_cuts.all + 1).tolist())
    inner = set((found.primitives[1:-1] + 1).tolist()) - activities
    return {
        "activities": _compare_cuts(activities, set(reference["activity_cuts"])),
        "primitives": _compare_cuts(
            inner, {*reference["all_cuts"]} - {*reference["activity_cuts"]}
        ),
        "clusters": _compare_clusters(found, reference),
    }


def _compare_cuts(ours: set[int], theirs: set[int]) -> Agreement:
    differences = [f"{cut} (ours only)" for cut in sorted(ours - theirs)]
    differences += [f"{cut} (theirs only)" for cut in sorted(theirs - ours)]
    far = [cut for cut in ours if theirs.isdisjoint(range(cut - 1, cut + 2))]
    far += [cut for cut in theirs if ours.isdisjoint(range(cut - 1, cut + 2))]
    return Agreement(len(theirs), tuple(differences), len(far))


def _compare_clusters(found: RegionsFound, reference: dict[str, Any]) -> Agreement:
    borders = (found.primitives + 1).tolist()
    borders[-1] = reference["frames"]
    ours = dict(zip(pairwise(borders), found.clustering.labels.tolist(), strict=True))
    spans = pairwise([1, *reference["all_cuts"], reference["frames"]])
    theirs = dict(zip(spans, reference["clusters"], strict=True))
    common = [span for span in theirs if span in ours]
    compared = Comparison([theirs[span] for span in common], [ours[span] for span in common], fps=1)
    differences = [
        f"{start}..{stop} (ours {ours[start, stop]}, theirs {theirs[start, stop]})"
        for (start, stop), same in zip(common, compared.mapped == compared.truth, strict=True)
        if not same
    ]
    return Agreement(len(common), tuple(differences))


def main() -> None:
    parser = make_parser(__doc__)
    add_option(parser)
    parser.parse_args()
    find_data("cmu86")
    for configuration in CONFIGURATIONS:
        print(f"{configuration:24}" + "".join(f"{level:>14}" for level in LEVELS))
        sums = dict.fromkeys(LEVELS, (0, 0))
        notes = []
        for trial in choose_size(TRIALS, TRIALS[:1]):
            found = compare(DATA, configuration, trial)
            line = f"  {trial:22}"
            for level, agreement in found.items():
                agreeing = agreement.total - len(agreement.differences)
                line += f"{f'{agreeing} of {agreement.total}':>14}"
                sums[level] = (sums[level][0] + agreeing, sums[level][1] + agreement.total)
                notes += [f"  {trial} {level}: {text}" for text in agreement.differences]
            print(line)
        print(f"  {'all':22}" + "".join(f"{f'{a} of {b}':>14}" for a, b in sums.values()))
        print("\n".join([*notes, ""]))
        name = f"agreement.{configuration.replace(' ', '_')}"
        for level, (agreeing, total) in sums.items():
            record(f"{name}.{level}", f"{agreeing} of {total}")
        agreeing, total = np.sum([sums["activities"], sums["primitives"]], axis=0)
        record(f"{name}.cuts", f"{agreeing} of {total}")


if __name__ == "__main__":
    main()
