"""Subject 86 scored as in action segmentation, where every frame belongs to an action.

    python benchmarks/short_transitions.py [--record]

Actions meet at the mean of what the annotators say. Of what is found, half of each transition
under 1.2 s goes to each neighbour; longer ones stay a cluster of their own. Frames and
segments of the five trials are summed.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np

import kineme
from _figures import add_option, record
from _options import command_line
from _recordings import subject_86
from kineme.evaluation import TRANSITION, Comparison, Labelling, labelling_of, scores
from kineme.evaluation.score import over_all

PROMISED = {"mof": 0.96, "f1@50": 0.97}
LONGEST_S = 1.2


def split_short(labelling: Labelling) -> Labelling:
    """The same with half of each short transition given to each neighbour."""
    names = labelling.per_frame()
    rows = list(zip(labelling.labels, labelling.starts, labelling.stops, strict=True))
    for (before, *_), (name, start, stop), (after, *_) in zip(
        rows, rows[1:], rows[2:], strict=False
    ):
        if name == TRANSITION and stop - start < LONGEST_S * labelling.fps:
            middle = (start + stop) // 2
            names[start:middle], names[middle:stop] = before, after
    return Labelling.from_frames(names, fps=labelling.fps)


def comparisons() -> Iterator[Comparison]:
    """Each trial's actions and clusters, frame by frame."""
    for case in subject_86():
        truth = case.truth
        length = {"frames": truth.frames, "fps": truth.fps}
        wanted = Labelling.from_cuts(truth.mean, truth.labels, **length)
        found = kineme.segment(case.motion)
        given = split_short(labelling_of(found.activities, fps=found.fps).at(**length))
        numbers = [
            np.unique(each.per_frame().astype(str), return_inverse=True)[1]
            for each in (wanted, given)
        ]
        yield Comparison(*numbers, fps=truth.fps)


def main() -> None:
    parser = command_line(__doc__)
    add_option(parser)
    parser.parse_args()
    compared = list(comparisons())
    for name, promised in PROMISED.items():
        score = scores()[name]
        value = over_all(score.function(one) for one in compared)
        record(f"short_transitions.{name}", round(value, 4))
        print(f"{score.title:8} {value:.3f}, {promised:.2f} promised")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
