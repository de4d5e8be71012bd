"""Growing noise, with and without feature bundling: what is still found.

    python -m benchmarks noise [--seeds 30]

The test of Krueger et al. 2017 on recordings whose truth is known: each seed is
one `kineme.datasets.random_recording`, every joint of which shakes anew in every
frame. Bundled is `krueger2017`; plain is the same without bundling, with the
radius that its authors use then. Columns as in ``benchmarks/truth/synthetic.py``.
"""

from __future__ import annotations

import numpy as np

from _options import command_line, few
from agreement import CONFIGURATIONS
from kineme.datasets import random_recording
from kineme.segmentation.segmenter import segment
from synthetic import border_hits, found_counts

NOISE_MM = (0, 5, 10, 20, 30, 40, 60)
PRESETS = {
    "plain": CONFIGURATIONS["2017_plain"][1],
    "bundled": CONFIGURATIONS["krueger2017"][1],
}


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--seeds", type=int, default=few(30, 1))
    seeds = range(parser.parse_args().seeds)
    print(f"{'noise mm':>8}  {'':8}{'counts':>8}{'borders':>9}{'extra':>7}")
    for noise in NOISE_MM:
        recordings = [random_recording(seed, noise=noise / 1000) for seed in seeds]
        for name, preset in PRESETS.items():
            right: list[bool] = []
            borders = np.zeros(3, int)
            for recording in recordings:
                found = segment(recording.motion, preset=preset)
                right += [a == b for _, a, b in found_counts(found, recording.truth)]
                borders += border_hits(found, recording.truth)
            true, hit, extra = borders
            print(
                f"{noise:8}  {name:8}{np.mean(right):8.3f}{hit / true:9.3f}"
                f"{extra / len(recordings):7.2f}"
            )


if __name__ == "__main__":
    main()
