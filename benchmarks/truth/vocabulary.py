"""How well the clusters of a library agree with what people say, one mapping for all recordings.

    python -m benchmarks vocabulary [--most 400] [--keep FOLDER] [--record]

Three libraries: the five trials of subject 86; six sequences of HDM05 exercises, two of each of
three people; all of them. Each cluster of a library stands for one action at most, the same in all
its recordings; told is the share of frames that are right then, and how many clusters there are
for how many actions. Then the mean of five more libraries, of six other sequences each; then takes
of ten exercises of rehabilitation, done rightly and wrongly (UI-PRMD), and walks and runs of a game
studio.
``--most`` lets so many local clusters at most be compared pairwise, as in larger libraries.
``--keep`` keeps what was found in each recording alone for the next time.

``--growth 100 1000 10000`` measures instead the processor seconds of joining so many local
clusters, those of shaken copies of subject 86.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np

import kineme
import kineme.library.compiling
from _figures import add_option, record
from _libraries import SHAKEN, library_of
from _options import DATA, command_line, few
from _recordings import Case, hdm05, subject_86
from _sources import of_bodies
from kineme import Library
from kineme.evaluation import TRANSITION, Comparison, Labelling, Truth, one_to_one_accuracy
from kineme.library.compiling import compile_tables
from kineme.library.storage.analyses import read_analysis, read_features, write_analysis
from kineme.library.storage.layout import ANALYSES
from kineme.transfer.clusters import CONSTANTS, find_local_clusters

SEQUENCES, MORE = 6, few(5, 1)


def said_in(case: Case) -> np.ndarray:
    """The action at each frame of a recording's truth, called the same in all recordings."""
    if case.made is None:
        return case.truth.labelling().per_frame()
    rows = case.made.activities
    names = [TRANSITION if row.kind == "transition" else row.label for row in rows]
    return np.repeat(np.array(names, dtype=object), rows.stop_frame - rows.start_frame)


def takes(name: str) -> list[Case]:
    """Takes of one exercise each, which is what is said of all of it."""
    cases = []
    for key, path, rows in of_bodies(name, "labels.csv")[:: few(1, 10)]:
        motion = kineme.read(path)
        said = Labelling.from_frames([rows[0]["label"]] * motion.n_frames, fps=motion.fps)
        cases.append(Case(key, motion, Truth.from_labelling(said)))
    return cases


def gaits() -> list[Case]:
    """Walks and runs in many styles, as their files are named."""
    cases = []
    for path in sorted((DATA / "rigs" / "bandai_namco").glob("*.bvh"))[:: few(1, 20)]:
        name, motion = path.stem.split("_")[1], kineme.read(path)
        if name in ("walk", "run"):
            said = Labelling.from_frames([name] * motion.n_frames, fps=motion.fps)
            cases.append(Case(path.stem, motion, Truth.from_labelling(said)))
    return cases


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
    truth = Truth.from_labelling(Labelling.from_frames(wanted, fps=fps))
    compared = Comparison.of(truth, Labelling.from_frames(given, fps=fps))
    right, agreed = one_to_one_accuracy(compared), one_to_one_accuracy(compared.agreed)
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
    """Processor seconds of joining so many local clusters."""
    kineme.library.compiling.CONSTANTS = replace(CONSTANTS, most=most)
    cases = subject_86()
    library = library_of(folder / "subject_86", [(case.name, case.motion) for case in cases])
    for size in sizes:
        with TemporaryDirectory() as home:
            entries = many(library, size, Path(home))
            kept = sum(path.stat().st_size for path in (Path(home) / ANALYSES).glob("*.npy"))
            started = process_time()
            tables, _ = compile_tables(Path(home), entries, {}, 0, lambda _: None)
            seconds = process_time() - started
        found = tables["local_clusters"]
        n, clusters = len(found), len(set(found.column("cluster").to_pylist()))
        print(f"{n} local clusters: {seconds:.1f} s, {clusters} clusters", flush=True)
        record(f"vocabulary.growth.{size}.seconds", round(seconds, 1), unit="s")
        record(f"vocabulary.growth.{size}.features", round(kept / 1e6), unit="MB")


def many(library: Library, size: int, home: Path) -> list[tuple[str, Path, str]]:
    """Shaken copies of recordings with so many local clusters, each shaken in its own way."""
    (home / ANALYSES).mkdir()
    keys = library.recordings["piece"]
    own = [(read_analysis(library.folder / ANALYSES, key), key) for key in keys]
    entries, n = [], 0
    while n < size:
        piece, key = own[len(entries) % len(own)]
        rng = np.random.default_rng(len(entries))
        features = read_features(library.folder / ANALYSES, key)
        features = features + np.float32(SHAKEN) * rng.standard_normal(features.shape, np.float32)
        features /= np.linalg.norm(features, axis=1, keepdims=True)
        name = f"{len(entries):032x}"
        write_analysis(home / ANALYSES, name, piece, features)
        entries.append((name, home / name, name))
        n += len(find_local_clusters(piece.table, 0))
    return entries


def main() -> None:
    options = command_line(__doc__)
    options.add_argument("--most", type=int, default=CONSTANTS.most)
    options.add_argument("--keep", type=Path)
    options.add_argument("--growth", type=int, nargs="+", default=[])
    add_option(options)
    given = options.parse_args()
    kineme.library.compiling.CONSTANTS = replace(CONSTANTS, most=given.most)
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
        show("uiprmd", home, takes("uiprmd"))
        show("uiprmd_incorrect", home, takes("uiprmd_incorrect"))
        show("gaits", home, gaits())
        if given.quick:
            show_growth(home, [20], given.most)


if __name__ == "__main__":
    main()
