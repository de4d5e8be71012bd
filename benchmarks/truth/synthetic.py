"""Score counts and borders of each preset on synthetic recordings.

    python -m benchmarks synthetic [--seeds 50] [--noise 0.0] [--record]

Each seed is one `kineme.datasets.random_recording`: six activities, every second one walking, three
to eight repetitions each.

- **counts**: activities with the right number of repetitions. A found primitive counts for the true
  activity that contains its middle.
- **borders**: true transitions with a found border within 0.25 s.
- **extra**: found borders farther than that from every transition, per recording.
"""

from __future__ import annotations

from collections import Counter, defaultdict

import numpy as np

from _figures import add_option, record
from _options import choose_size, make_parser
from kineme.datasets import random_recording
from kineme.methods.presets import DEFAULT, PUBLISHED
from kineme.methods.segmenter import segment
from kineme.segments.segmentation import Segmentation

TOLERANCE_S = 0.25


def count_found(found: Segmentation, truth: Segmentation) -> list[tuple[str, int, int]]:
    """Return label, true count and found count of each true activity."""
    spans = truth.activities
    primitives = found.primitives
    middle = (primitives.start_frame + primitives.stop_frame) // 2
    home = np.searchsorted(spans.start_frame, middle, side="right") - 1
    counted = Counter(home[primitives.kind == "primitive"].tolist())
    true = Counter(truth.primitives.activity.tolist())
    return [
        (row.label, true[row.activity], counted[row.activity])
        for row in spans
        if row.kind == "activity"
    ]


def match_borders(found: Segmentation, truth: Segmentation) -> tuple[int, int, int]:
    """Count true transitions, those with a near border, and borders near none."""
    spans = truth.activities.select(truth.activities.kind == "transition")
    cuts = found.cuts() / found.fps
    near = (cuts[:, None] >= spans.start_s - TOLERANCE_S) & (
        cuts[:, None] <= spans.stop_s + TOLERANCE_S
    )
    return len(spans), int(near.any(axis=0).sum()), int((~near.any(axis=1)).sum())


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--seeds", type=int, default=choose_size(50, 1))
    parser.add_argument("--noise", type=float, default=0.0, help="metres")
    add_option(parser)
    options = parser.parse_args()
    recordings = [random_recording(seed, noise=options.noise) for seed in range(options.seeds)]
    for preset in (DEFAULT, *PUBLISHED):
        right: dict[str, list[bool]] = defaultdict(list)
        borders = np.zeros(3, int)
        for recording in recordings:
            found = segment(recording.motion, preset=preset)
            for label, true, counted in count_found(found, recording.truth):
                right[label].append(true == counted)
            borders += match_borders(found, recording.truth)
        all_counts = [exact for label in right for exact in right[label]]
        true, hit, extra = borders
        print(
            f"{preset}: counts {np.mean(all_counts):.3f} of {len(all_counts)}, "
            f"borders {hit / true:.3f} of {true}, extra {extra / options.seeds:.2f} per recording"
        )
        record(f"synthetic.{preset}.counts", 100 * float(np.mean(all_counts)), unit="%")
        record(f"synthetic.{preset}.activities", len(all_counts))
        for label in sorted(right):
            print(f"  {label:12} {np.mean(right[label]):.3f} of {len(right[label])}")


if __name__ == "__main__":
    main()
