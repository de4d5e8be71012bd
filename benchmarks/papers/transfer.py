"""Label transfer: table 1 of Vögele et al. 2014, HDM05 actors, time and growth.

    python -m benchmarks transfer [table] [actors] [time] [growth]

``table``: the trials of subject 86 at hand; the first one, two, ... are the
knowledge base, the others' primitives are queried; classes by majority of
annotated frames. ``actors``: human-cut exercises of HDM05, each actor from the
other two. ``time``: 126 labelled against 480 unlabelled primitives, 35.3 s in
the paper. ``growth``: more knowledge, each primitive a shaken copy of a real one,
for a recording of 30 primitives.
"""

from __future__ import annotations

import warnings
from collections import Counter
from dataclasses import replace
from resource import RUSAGE_SELF, getrusage
from statistics import median
from time import process_time

import numpy as np

import kineme
from _figures import add_option, record
from _options import command_line, few, needed
from _recordings import ACTORS, subject_86
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation
from kineme.transfer import (
    THRESHOLD,
    KnowledgeBase,
    name_primitives,
    transfer_features,
    transfer_labels,
)
from kineme.transfer.labels import REACH
from kineme.transfer.matching import Primitives, label_costs

THRESHOLDS = (0.4, 0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.1)
ALL = 1.4  # a threshold that everything is within


def table() -> None:
    cases = subject_86()
    segmentations = [kineme.segment(case.motion) for case in cases]
    truths = [
        name_primitives(found, intervals(case))
        for found, case in zip(segmentations, cases, strict=True)
    ]
    features = [transfer_features(case.motion) for case in cases]
    for n in range(1, len(cases)):
        bases = zip(cases[:n], truths[:n], strict=True)
        knowledge = KnowledgeBase.merged(
            *(KnowledgeBase.from_recording(case.motion, truth) for case, truth in bases)
        )
        queries = list(zip(segmentations, features, truths, strict=True))[n:]
        print(f"\nKB: {' & '.join(case.name for case in cases[:n])}")
        print(f"Examples: {', '.join(f'{k} {v}' for k, v in knowledge.counts().items())}")
        show_classes(labelled(queries, knowledge, THRESHOLD), list(knowledge.counts()))
        print("threshold  found correct  precision recall  (all classes of the knowledge base)")
        for threshold in THRESHOLDS:
            pairs = labelled(queries, knowledge, threshold)
            show_point(threshold, pairs, set(knowledge.counts()))


def intervals(case: object) -> Segmentation:
    """What the annotators said, cut at their mean marks, at the rate of the recording."""
    marks = case.truth.at_means()  # type: ignore[attr-defined]
    motion = case.motion  # type: ignore[attr-defined]
    borders = np.rint(marks.borders * (motion.fps / marks.fps)).astype(int)
    borders[-1] = motion.n_frames
    return spans(motion, borders, list(marks.labels))


def spans(motion: Motion, borders: np.ndarray, labels: list[str]) -> Segmentation:
    n = len(labels)
    columns = {
        "level": ["activity"] * n,
        "kind": ["activity"] * n,
        "start_frame": borders[:-1],
        "stop_frame": borders[1:],
        "label": labels,
    }
    return Segmentation.from_columns(columns, n_frames=motion.n_frames, fps=motion.fps)


def labelled(queries: list, knowledge: KnowledgeBase, threshold: float) -> list[tuple[str, str]]:
    """Truth and label of every primitive that is no transition."""
    pairs = []
    for segmentation, features, truth in queries:
        result = transfer_labels(segmentation, features, knowledge, threshold=threshold)
        rows = zip(truth.primitives, result.primitives, strict=True)
        pairs += [(right.label, row.label) for right, row in rows if row.kind == "primitive"]
    return pairs


def show_classes(pairs: list[tuple[str, str]], classes: list[str]) -> None:
    print(f"{'class':28}  found correct missed precision recall")
    found, wanted = Counter(got for _, got in pairs), Counter(truth for truth, _ in pairs)
    correct = Counter(got for truth, got in pairs if truth == got)
    for name in classes:
        right, missed = correct[name], wanted[name] - correct[name]
        precision = f"{right / found[name]:.2f}" if found[name] else "-"
        recall = f"{right / wanted[name]:.2f}" if wanted[name] else "-"
        print(f"{name:28} {found[name]:6d} {right:7d} {missed:6d} {precision:>9} {recall:>6}")


def show_point(threshold: float, pairs: list[tuple[str, str]], classes: set[str]) -> None:
    found = sum(bool(got) for _, got in pairs)
    right = sum(truth == got for truth, got in pairs)
    wanted = sum(truth in classes for truth, _ in pairs)
    precision = f"{right / found:.3f}" if found else "-"
    print(f"{threshold:9.2f} {found:6d} {right:7d} {precision:>10} {right / wanted:6.3f}")


def actors() -> None:
    folder = needed("hdm05")
    bases: dict[str, list[KnowledgeBase]] = {}
    queries: dict[str, list] = {}
    for actor in ACTORS:
        skeleton = folder / "asf" / f"HDM_{actor}.asf"
        for path in sorted((folder / "amc").glob(f"HDM_{actor}_*_120.amc"))[:: few(1, 6)]:
            motion = kineme.read(path, skeleton=skeleton)
            whole = np.array([0, motion.n_frames])
            truth = spans(motion, whole, [path.stem.split("_")[2]])
            blank = spans(motion, whole, [""])
            bases.setdefault(actor, []).append(KnowledgeBase.from_recording(motion, truth))
            queries.setdefault(actor, []).append((blank, transfer_features(motion), truth))
    folds = {
        actor: KnowledgeBase.merged(*(b for a in ACTORS if a != actor for b in bases[a]))
        for actor in ACTORS
    }
    print("\nHDM05, one actor left out; threshold, found, correct, precision, recall")
    for threshold in (*THRESHOLDS, ALL):
        pairs = []
        for actor, knowledge in folds.items():
            for blank, features, truth in queries[actor]:
                result = transfer_labels(blank, features, knowledge, threshold=threshold)
                pairs.append((truth.activities[0].label, result.activities[0].label))
        show_point(threshold, pairs, {truth for truth, _ in pairs})
    print("\nat full recall")
    show_classes(pairs, sorted({truth for truth, _ in pairs}))
    right = sum(truth == got for truth, got in pairs)
    print(f"accuracy {right / len(pairs):.3f} ({right} of {len(pairs)})")


def real_primitives() -> Primitives:
    parts, lengths = [], []
    for case in subject_86():
        truth = name_primitives(kineme.segment(case.motion), intervals(case))
        base = KnowledgeBase.from_recording(case.motion, truth)
        parts.append(base.features)
        lengths.append(base.lengths)
    lengths = np.concatenate(lengths)
    return Primitives(np.concatenate(parts), lengths, np.arange(len(lengths)))


def copies(real: Primitives, n: int, seed: int) -> Primitives:
    """So many primitives, drawn from the real ones, each displaced by about 0.05."""
    rng = np.random.default_rng(seed)
    chosen = rng.integers(len(real), size=n)
    lengths = real.lengths[chosen]
    frames = np.concatenate([np.arange(real.starts[p], real.starts[p + 1]) for p in chosen])
    shift = rng.normal(0, 0.05 / real.features.shape[1] ** 0.5, (n, real.features.shape[1]))
    features = real.features[frames]
    features += np.repeat(shift.astype(np.float32), lengths, axis=0)
    return replace(real, features=features, lengths=lengths, runs=np.arange(n))


def measure(real: Primitives, n_unknown: int, n_known: int, runs: int) -> float:
    unknown, known = copies(real, n_unknown, 1), copies(real, n_known, 2)
    codes = np.arange(n_known) % 10
    took = []
    for _ in range(runs):
        start = process_time()
        label_costs(unknown, known, codes, 10, radius=REACH * THRESHOLD)
        took.append(process_time() - start)
    return median(took)


def time() -> None:
    seconds = measure(real_primitives(), 480, 126, 5)
    record("transfer.time.processor", round(seconds, 2), unit="s")
    print(f"\n126 labelled, 480 unlabelled: {seconds:.2f} s (paper: 35.3 s)")


def growth() -> None:
    real = real_primitives()
    print("\nlabelled  seconds  ms per labelled  peak GB, for 30 unlabelled primitives")
    for n in few((100, 1000, 10_000, 100_000), (100,)):
        seconds = measure(real, 30, n, 1)
        peak = getrusage(RUSAGE_SELF).ru_maxrss / 1e6
        print(f"{n:8d} {seconds:8.2f} {1000 * seconds / n:16.3f} {peak:8.2f}", flush=True)
        record(f"transfer.growth.{n}.processor", round(seconds, 1), unit="s")
        record(f"transfer.growth.{n}.memory", round(peak, 1), unit="GB")


WORKS = {"table": table, "actors": actors, "time": time, "growth": growth}


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("works", nargs="*", default=list(WORKS), help=", ".join(WORKS))
    add_option(parser)
    for name in parser.parse_args().works:
        WORKS[name]()


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
