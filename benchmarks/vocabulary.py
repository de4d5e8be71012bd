"""How well the clusters of a library agree with what people say, one mapping for all recordings.

    python benchmarks/vocabulary.py [--most 400] [--keep FOLDER] [--record]

Three libraries: the five trials of subject 86; six sequences of HDM05 exercises, two of each of
three people; all of them. Each cluster of a library stands for one action at most, the same in all
its recordings; told is the share of frames that are right then, and how many clusters there are
for how many actions. ``--most`` lets so many words at most be compared each with each, as in
larger libraries. ``--keep`` keeps what was found in each recording alone for the next time.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import kineme.library.compiling
from _figures import add_option, record
from _libraries import library_of
from _recordings import Case, hdm05, subject_86
from kineme import Library
from kineme.evaluation import Annotation, Labelling
from kineme.evaluation.frames import one_to_one_accuracy
from kineme.evaluation.labelling import TRANSITION
from kineme.library.constants import VOCABULARY

SEQUENCES = 6


def found_in(library: Library, name: str) -> np.ndarray:
    """The cluster of the library at each frame of a recording, as text."""
    columns = library.table("segments").to_pydict()
    labels = [
        np.repeat(TRANSITION if kind == "transition" else f"{cluster}", stop - start)
        for recording, level, kind, start, stop, cluster in zip(
            *(
                columns[key]
                for key in ("recording", "level", "kind", "start_frame", "stop_frame", "cluster")
            ),
            strict=True,
        )
        if recording == name and level == "activity"
    ]
    return np.concatenate(labels).astype(object)


def show(name: str, folder: Path, cases: list[Case]) -> None:
    """One line on a library of these."""
    library = library_of(folder / name, [(case.name, case.motion) for case in cases])
    wanted = np.concatenate([case.truth.labelling().per_frame() for case in cases])
    given = np.concatenate([found_in(library, case.name) for case in cases])
    fps = cases[0].motion.fps
    truth = Annotation.from_labelling(Labelling.from_frames(wanted, fps=fps))
    right, _ = one_to_one_accuracy(truth, Labelling.from_frames(given, fps=fps))
    clusters, actions = len({*given} - {TRANSITION}), len({*wanted} - {TRANSITION})
    print(f"{name}: one-to-one {right:.3f}, {clusters} clusters, {actions} actions", flush=True)
    record(f"vocabulary.{name}.one_to_one", round(right, 2))
    record(f"vocabulary.{name}.clusters", clusters)
    record(f"vocabulary.{name}.actions", actions)


def main() -> None:
    options = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    options.add_argument("--most", type=int, default=VOCABULARY.most)
    options.add_argument("--keep", type=Path)
    add_option(options)
    given = options.parse_args()
    kineme.library.compiling.VOCABULARY = replace(VOCABULARY, most=given.most)
    trials, sequences = subject_86(), list(hdm05(SEQUENCES))
    with TemporaryDirectory() as folder:
        home = given.keep or Path(folder)
        show("subject_86", home, trials)
        show("hdm05", home, sequences)
        show("both", home, [*trials, *sequences])


if __name__ == "__main__":
    main()
