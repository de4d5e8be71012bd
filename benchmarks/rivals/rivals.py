"""The comparison itself; started by ``run.py`` in its environment.

Outside packages get the positions of the five end effectors in the body's own
frame at 30 Hz, (frames, 15), and their own defaults. Where a package has to be
told the number of segments, it is the true one, as ACA and HACA are told the
number of classes; where it needs a window, that is one second. What takes one
channel only gets the first principal component. ClaSP picks window and number
itself.

Each method runs once untimed, on a copy of the first trial: that is when
packages compile. A cut is right within the annotators' span ± 0.25 s.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from kineme.evaluation import (
    Comparison,
    Labelling,
    border_score,
    make_labelling,
    one_to_one_accuracy,
)
from kineme.features import pose_features
from kineme.recordings.operations import resample
from kineme_reproduction.benchmark import METHODS
from kineme_reproduction.trials import FPS, Trial, find_folder, load_trials

WINDOW = int(FPS)


class Task(NamedTuple):
    """What a rival is given: features (frames, 15) at 30 Hz, and the true number of segments."""

    features: NDArray[np.float64]
    n_segments: int

    @property
    def channel(self) -> NDArray[np.float64]:
        """The first principal component."""
        centred = self.features - self.features.mean(axis=0)
        return np.ascontiguousarray(centred @ np.linalg.svd(centred, full_matrices=False)[2][0])


class Found(NamedTuple):
    """What it gives back: cuts, and a label per segment where it has labels."""

    cuts: list[int]
    labels: list[int] | None = None


def claspy_clasp(task: Task) -> Found:
    from claspy.segmentation import BinaryClaSPSegmentation

    return Found(sorted_cuts(BinaryClaSPSegmentation().fit_predict(task.features)))


def claspy_clap(task: Task) -> Found:
    from claspy.state_detection import AgglomerativeCLaPDetection

    states = AgglomerativeCLaPDetection().fit(task.features)
    return Found(sorted_cuts(states.get_change_points()), states.get_segment_labels().tolist())


def stumpy_fluss(task: Task) -> Found:
    import stumpy

    _, indices = stumpy.mstump(task.features.T, WINDOW)
    _, cuts = stumpy.fluss(indices[-1], L=WINDOW, n_regimes=task.n_segments)
    return Found(sorted_cuts(cuts))


def ruptures_kernel(task: Task) -> Found:
    import ruptures

    search = ruptures.KernelCPD(kernel="rbf").fit(task.features)
    return Found(sorted_cuts(search.predict(n_bkps=task.n_segments - 1)[:-1]))


def aeon_clasp(task: Task) -> Found:
    from aeon.segmentation import ClaSPSegmenter

    segmenter = ClaSPSegmenter(period_length=WINDOW, n_cps=task.n_segments - 1)
    return Found(sorted_cuts(segmenter.fit_predict(task.channel)))


def aeon_fluss(task: Task) -> Found:
    from aeon.segmentation import FLUSSSegmenter

    segmenter = FLUSSSegmenter(period_length=WINDOW, n_regimes=task.n_segments)
    return Found(sorted_cuts(segmenter.fit_predict(task.channel)))


def aeon_binary(task: Task) -> Found:
    from aeon.segmentation import BinSegmenter

    segmenter = BinSegmenter(n_cps=task.n_segments - 1)
    return Found(sorted_cuts(segmenter.fit_predict(task.channel)))


def aeon_gaussian(task: Task) -> Found:
    from aeon.segmentation import GreedyGaussianSegmenter

    segmenter = GreedyGaussianSegmenter(k_max=task.n_segments - 1, random_state=0)
    return Found(changes(segmenter.fit_predict(task.features, axis=0)))


def aeon_information(task: Task) -> Found:
    from aeon.segmentation import InformationGainSegmenter

    segmenter = InformationGainSegmenter(k_max=task.n_segments - 1)
    return Found(changes(segmenter.fit_predict(task.features, axis=0)))


def aeon_eagglo(task: Task) -> Found:
    from aeon.segmentation import EAggloSegmenter

    return Found(changes(EAggloSegmenter().fit_predict(task.features, axis=0)))


# aeon's HMMSegmenter has to be given the states, its HidalgoSegmenter clusters frames without
# regard to time, its RandomSegmenter is a control.
RIVALS: dict[str, Callable[[Task], Found]] = {
    rival.__name__: rival
    for rival in (
        *(claspy_clasp, claspy_clap, stumpy_fluss, ruptures_kernel),
        *(aeon_clasp, aeon_fluss, aeon_binary, aeon_gaussian, aeon_information, aeon_eagglo),
    )
}


def sorted_cuts(cuts: Any) -> list[int]:
    """Ascending; a 0 is how FLUSS fills up where it finds fewer than asked for."""
    return sorted({int(cut) for cut in cuts} - {0})


def changes(labels: NDArray[np.int64]) -> list[int]:
    return (np.flatnonzero(np.diff(labels)) + 1).tolist()


def rival_result(name: str, trial: Trial) -> tuple[float, Labelling, bool]:
    """Seconds, result, and whether it has labels; features are not timed."""
    features = pose_features(resample(trial.motion, FPS))
    task = Task(np.ascontiguousarray(features), len(trial.truth.labels))
    began = time.perf_counter()
    cuts, labels = RIVALS[name](task)
    seconds = time.perf_counter() - began
    labelling = Labelling.from_cuts(cuts, labels, frames=trial.truth.frames, fps=FPS)
    return seconds, labelling, labels is not None


def own_result(name: str, trial: Trial) -> tuple[float, Labelling, bool]:
    """Seconds with features, the activity level at 30 Hz, and whether it has labels."""
    began = time.perf_counter()
    segmentation = METHODS[name](trial)
    seconds = time.perf_counter() - began
    labelling = make_labelling(segmentation.activities, fps=segmentation.fps)
    labelled = len(set(labelling.labels)) < len(labelling.labels)
    return seconds, labelling.at(frames=trial.truth.frames, fps=FPS), labelled


def measured(name: str, trial: Trial) -> dict[str, Any]:
    result = rival_result if name in RIVALS else own_result
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what other packages say of each other's versions
            seconds, found, labelled = result(name, trial)
    except Exception as error:  # noqa: BLE001 (a rival that fails is a result)
        return {"trial": trial.name, "method": name, "error": f"{type(error).__name__}: {error}"}
    compared = Comparison.of(trial.truth, found)
    accuracy = one_to_one_accuracy(compared) if labelled else None
    return {
        "trial": trial.name,
        "method": name,
        "seconds": round(seconds, 3),
        "recording_seconds": round(trial.truth.frames / FPS, 1),
        "true_cuts": len(trial.truth.labels) - 1,
        "cuts": found.borders[1:-1].tolist(),
        "labels": list(found.labels) if labelled else None,
        "border_f1": round(border_score(compared).f1, 3),
        "frame_accuracy": None if accuracy is None else round(accuracy, 3),
    }


def show(rows: list[dict[str, Any]], console: Console) -> None:
    table = Table("trial", "method", title="cuts in frames at 30 Hz, F1 of borders, frame accuracy")
    for name in ("seconds", "cuts", "true", "F1", "frames"):
        table.add_column(name, justify="right")
    for row in rows:
        if "error" in row:
            table.add_row(row["trial"], row["method"], row["error"])
            continue
        accuracy = "" if row["frame_accuracy"] is None else f"{row['frame_accuracy']:.3f}"
        table.add_row(
            *(row["trial"], row["method"], f"{row['seconds']:.2f}", str(len(row["cuts"]))),
            *(str(row["true_cuts"]), f"{row['border_f1']:.3f}", accuracy),
        )
    console.print(table)
    means = Table("method", title="means over trials")
    for name in ("seconds", "F1"):
        means.add_column(name, justify="right")
    for method in dict.fromkeys(row["method"] for row in rows if "error" not in row):
        own = [row for row in rows if row["method"] == method and "error" not in row]
        means.add_row(
            method,
            f"{np.mean([row['seconds'] for row in own]):.2f}",
            f"{np.mean([row['border_f1'] for row in own]):.3f}",
        )
    console.print(means)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", help="folder of the recordings")
    parser.add_argument("--trials", nargs="*", help="default: all at hand")
    parser.add_argument("--methods", nargs="*", default=[*METHODS, *RIVALS])
    parser.add_argument("--json", type=Path, help="write the results here too")
    options = parser.parse_args()
    trials = load_trials(find_folder(options.data), options.trials)
    (warm_up,) = load_trials(find_folder(options.data), [trials[0].name])
    progress = Console(stderr=True)
    rows = []
    for name in options.methods:
        progress.print(f"{name}: warming up")
        measured(name, warm_up)
        for trial in trials:
            progress.print(f"{name}: {trial.name}")
            rows.append(measured(name, trial))
    rows.sort(key=lambda row: row["trial"])
    show(rows, Console())
    if options.json:
        packages = ("kineme", "claspy", "stumpy", "ruptures", "aeon", "numpy", "numba")
        result = {"versions": {name: version(name) for name in packages}, "results": rows}
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
