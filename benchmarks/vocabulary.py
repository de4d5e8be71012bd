"""How well the clusters of a library agree with what people say, one mapping for all recordings.

    python benchmarks/vocabulary.py [--most 400] [--keep FOLDER] [--record]

Three libraries: the five trials of subject 86; six sequences of HDM05 exercises, two of each of
three people; all of them. Each cluster of a library stands for one action at most, the same in all
its recordings; told is the share of frames that are right then, and how many clusters there are
for how many actions. Then the mean of five more libraries, of six other sequences each, which
were looked at when the constants were chosen. ``--most`` lets so many words at most be compared
each with each, as in larger libraries. ``--keep`` keeps what was found in each recording alone
for the next time.

``--growth 100 1000 10000`` measures instead what joining so many words takes: shaken copies of
those of subject 86, in seconds of processors.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np

import kineme.library.compiling
from _figures import add_option, record
from _libraries import SHAKEN, library_of
from _recordings import Case, hdm05, subject_86
from kineme import Library
from kineme.evaluation import Annotation, Labelling
from kineme.evaluation.frames import one_to_one_accuracy
from kineme.evaluation.labelling import TRANSITION
from kineme.library.constants import VOCABULARY
from kineme.library.storage.layout import PIECES
from kineme.library.storage.pieces import read_piece
from kineme.library.vocabulary.crowds import Crowd, clusters_in
from kineme.library.vocabulary.joining import Word
from kineme.library.vocabulary.words import crowd_of, places_in

SEQUENCES, MORE = 6, 5


def said_in(case: Case) -> np.ndarray:
    """The action at each frame of a recording's truth, called the same in all recordings."""
    if case.made is None:
        return case.truth.labelling().per_frame()
    rows = case.made.activities
    names = [TRANSITION if row.kind == "transition" else row.label for row in rows]
    return np.repeat(np.array(names, dtype=object), rows.stop_frame - rows.start_frame)


def found_in(library: Library, case: Case) -> np.ndarray:
    """The cluster of the library at each frame of a recording's truth, as text."""
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
        if recording == case.name and level == "activity"
    ]
    found = Labelling.from_frames(np.concatenate(labels), fps=case.motion.fps)
    return found.at(frames=case.truth.frames, fps=case.truth.fps).per_frame()


def score(name: str, folder: Path, cases: list[Case]) -> tuple[float, float, int, int]:
    """Shares that are right, of all frames and without borders; clusters and actions."""
    library = library_of(folder / name, [(case.name, case.motion) for case in cases])
    wanted = np.concatenate([said_in(case) for case in cases])
    given = np.concatenate([found_in(library, case) for case in cases])
    fps = cases[0].truth.fps
    truth = Annotation.from_labelling(Labelling.from_frames(wanted, fps=fps))
    right, agreed = one_to_one_accuracy(truth, Labelling.from_frames(given, fps=fps))
    return right, agreed, len({*given} - {TRANSITION}), len({*wanted} - {TRANSITION})


def show(name: str, folder: Path, cases: list[Case]) -> None:
    """One line on a library of these."""
    right, agreed, clusters, actions = score(name, folder, cases)
    print(
        f"{name}: one-to-one {right:.3f}, without borders {agreed:.3f}; {clusters} clusters, "
        f"{actions} actions",
        flush=True,
    )
    record(f"vocabulary.{name}.one_to_one", round(right, 2))
    record(f"vocabulary.{name}.agreed", round(agreed, 2))
    record(f"vocabulary.{name}.clusters", clusters)
    record(f"vocabulary.{name}.actions", actions)


def show_others(folder: Path) -> None:
    """One line on libraries of other sequences."""
    scores = [
        score(f"others_{i}", folder, list(hdm05(SEQUENCES, first=i * SEQUENCES)))
        for i in range(1, MORE + 1)
    ]
    right, agreed, clusters, actions = np.mean(scores, axis=0)
    shown = " ".join(f"{each[0]:.3f}" for each in scores)
    print(
        f"others: one-to-one {right:.3f}, without borders {agreed:.3f} ({shown}); "
        f"{clusters:.1f} clusters, {actions:.1f} actions"
    )
    record("vocabulary.others.one_to_one", round(float(right), 2))
    record("vocabulary.others.agreed", round(float(agreed), 2))
    record("vocabulary.others.clusters", round(float(clusters), 1))
    record("vocabulary.others.actions", round(float(actions), 1))


def show_growth(folder: Path, sizes: list[int], most: int) -> None:
    """What joining so many words takes."""
    cases = subject_86()
    library = library_of(folder / "subject_86", [(case.name, case.motion) for case in cases])
    keys = library.recordings["piece"]
    pieces = [read_piece(library.folder / PIECES, key) for key in keys]
    places = [place for i, piece in enumerate(pieces) for place in places_in(piece, i)]
    few = crowd_of(places, pieces, library.folder / PIECES, keys)
    for size in sizes:
        start = process_time()
        found = clusters_in(many(few, size), replace(VOCABULARY, most=most))
        seconds = process_time() - start
        print(f"{size} words: {seconds:.1f} s, {found.labels.max() + 1} clusters", flush=True)
        record(f"vocabulary.growth.{size}.seconds", round(seconds, 1), unit="s")


def many(few: Crowd, size: int) -> Crowd:
    """Shaken copies of words, each of which is shaken in its own way."""
    m = len(few.seconds)

    def word(number: int) -> Word:
        rng, own = np.random.default_rng(number), few.word(number % m)
        shaken = []
        for part in (own.example, own.context):
            values = part + SHAKEN * rng.normal(size=part.shape).astype(np.float32)
            shaken.append(values / np.linalg.norm(values, axis=1, keepdims=True))
        return Word(shaken[0], shaken[1], number // m, own.seconds)

    at = np.arange(size) % m
    order = np.random.default_rng(0).permutation(size)
    recording = np.arange(size) // m
    return Crowd(word, recording, few.seconds[at], few.embeddings[at], order)


def main() -> None:
    options = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    options.add_argument("--most", type=int, default=VOCABULARY.most)
    options.add_argument("--keep", type=Path)
    options.add_argument("--growth", type=int, nargs="+", default=[])
    add_option(options)
    given = options.parse_args()
    kineme.library.compiling.VOCABULARY = replace(VOCABULARY, most=given.most)
    with TemporaryDirectory() as folder:
        home = given.keep or Path(folder)
        if given.growth:
            show_growth(home, given.growth, given.most)
            return
        trials, sequences = subject_86(), list(hdm05(SEQUENCES))
        show("subject_86", home, trials)
        show("hdm05", home, sequences)
        show("both", home, [*trials, *sequences])
        show_others(home)


if __name__ == "__main__":
    main()
