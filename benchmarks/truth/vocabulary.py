"""Score the clusters of libraries against labels, with one mapping for all recordings.

    python -m benchmarks vocabulary [--record]

Each cluster is mapped to at most one action, the same in all recordings of the library. Printed are
the share of right frames and the numbers of clusters and actions. The libraries: the trials of
subject 86; six sequences of HDM05 exercises of three people; both together; the mean of five more
sets of sequences; rehabilitation exercises, done correctly and incorrectly (UI-PRMD); walks and
runs of a game studio.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import kineme
import kineme.library.gathering
from _figures import add_option, record
from _libraries import build_library
from _options import DATA, choose_size, make_parser
from _recordings import Case, join_hdm05, read_subject_86
from _sources import list_body_recordings
from kineme import Library
from kineme.evaluation import TRANSITION, Comparison, Labelling, Truth, one_to_one_accuracy

SEQUENCES, MORE = 6, choose_size(5, 1)


def list_true_actions(case: Case) -> np.ndarray:
    """Return the true action of each frame, with the same names in all recordings."""
    if case.made is None:
        return case.truth.labelling().per_frame()
    rows = case.made.activities
    names = [TRANSITION if row.kind == "transition" else row.label for row in rows]
    return np.repeat(np.array(names, dtype=object), rows.stop_frame - rows.start_frame)


def read_takes(name: str) -> list[Case]:
    """Read takes of one exercise each."""
    cases = []
    for key, path, rows in list_body_recordings(name, "labels.csv")[:: choose_size(1, 10)]:
        motion = kineme.read(path)
        said = Labelling.from_frames([rows[0]["label"]] * motion.n_frames, fps=motion.fps)
        cases.append(Case(key, motion, Truth.from_labelling(said)))
    return cases


def read_gaits() -> list[Case]:
    """Read walks and runs in many styles, labelled by file name."""
    cases = []
    for path in sorted((DATA / "rigs" / "bandai_namco").glob("*.bvh"))[:: choose_size(1, 20)]:
        name, motion = path.stem.split("_")[1], kineme.read(path)
        if name in ("walk", "run"):
            said = Labelling.from_frames([name] * motion.n_frames, fps=motion.fps)
            cases.append(Case(path.stem, motion, Truth.from_labelling(said)))
    return cases


def list_found_clusters(library: Library, case: Case) -> np.ndarray:
    """Return the library's cluster of each frame of a recording's truth, as text."""
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
    """Return the share of right frames, that without borders, and clusters and actions."""
    library = build_library(folder / name, [(case.name, case.motion) for case in cases])
    wanted = np.concatenate([list_true_actions(case) for case in cases])
    given = np.concatenate([list_found_clusters(library, case) for case in cases])
    fps = cases[0].truth.fps
    truth = Truth.from_labelling(Labelling.from_frames(wanted, fps=fps))
    compared = Comparison.of(truth, Labelling.from_frames(given, fps=fps))
    right, agreed = one_to_one_accuracy(compared), one_to_one_accuracy(compared.agreed)
    return right, agreed, len({*given} - {TRANSITION}), len({*wanted} - {TRANSITION})


def show(name: str, scores: Sequence[float], note: str = "") -> None:
    """Print and record the scores of a library."""
    right, agreed, clusters, actions = scores
    print(
        f"{name}: one-to-one {right:.3f}, without borders {agreed:.3f}{note}; {clusters:g} "
        f"clusters, {actions:g} actions",
        flush=True,
    )
    record(f"vocabulary.{name}.one_to_one", round(right, 2))
    record(f"vocabulary.{name}.agreed", round(agreed, 2))
    record(f"vocabulary.{name}.clusters", clusters)
    record(f"vocabulary.{name}.actions", actions)


def show_others(folder: Path) -> None:
    """Show the mean scores of libraries of other sequences."""
    scores = [
        score(f"others_{i}", folder, list(join_hdm05(SEQUENCES, first=i * SEQUENCES)))
        for i in range(1, MORE + 1)
    ]
    each = " ".join(f"{right:.3f}" for right, *_ in scores)
    right, agreed, clusters, actions = np.mean(scores, axis=0).tolist()
    show("others", (right, agreed, round(clusters, 1), round(actions, 1)), f" ({each})")


def main() -> None:
    parser = make_parser(__doc__)
    add_option(parser)
    parser.parse_args()
    with TemporaryDirectory() as folder:
        home = Path(folder)
        trials, sequences = read_subject_86(), list(join_hdm05(SEQUENCES))
        libraries = {"subject_86": trials, "hdm05": sequences, "both": [*trials, *sequences]}
        for name, cases in libraries.items():
            show(name, score(name, home, cases))
        show_others(home)
        for name in ("uiprmd", "uiprmd_incorrect"):
            show(name, score(name, home, read_takes(name)))
        show("gaits", score("gaits", home, read_gaits()))


if __name__ == "__main__":
    main()
