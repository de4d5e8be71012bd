"""Compare our methods with other packages; started by ``run.py`` in its environment.

Other packages get the positions of the five end effectors in the body's own frame at 30 Hz,
(frames, 15), and their defaults. Those that need the number of segments get the true one (ACA and
HACA get the number of classes); a window is one second. Packages for one channel get the first
principal component.

Each method runs once untimed on the first trial, when packages compile. A cut is right within the
annotators' span ± 0.25 s.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

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
    """Input of a method: features (frames, 15) at 30 Hz, and the true number of segments."""

    features: NDArray[np.float64]
    n_segments: int

    @property
    def channel(self) -> NDArray[np.float64]:
        """Return the first principal component."""
        centred = self.features - self.features.mean(axis=0)
        return np.ascontiguousarray(centred @ np.linalg.svd(centred, full_matrices=False)[2][0])


class Result(NamedTuple):
    """Output of a method: cuts, and a label per segment if it has labels."""

    cuts: list[int]
    labels: list[int] | None = None


def claspy_clasp(task: Task) -> Result:
    from claspy.segmentation import BinaryClaSPSegmentation

    return Result(sort_cuts(BinaryClaSPSegmentation().fit_predict(task.features)))


def claspy_clap(task: Task) -> Result:
    from claspy.state_detection import AgglomerativeCLaPDetection

    states = AgglomerativeCLaPDetection().fit(task.features)
    return Result(sort_cuts(states.get_change_points()), states.get_segment_labels().tolist())


def stumpy_fluss(task: Task) -> Result:
    import stumpy

    _, indices = stumpy.mstump(task.features.T, WINDOW)
    _, cuts = stumpy.fluss(indices[-1], L=WINDOW, n_regimes=task.n_segments)
    return Result(sort_cuts(cuts))


def ruptures_kernel(task: Task) -> Result:
    import ruptures

    search = ruptures.KernelCPD(kernel="rbf").fit(task.features)
    return Result(sort_cuts(search.predict(n_bkps=task.n_segments - 1)[:-1]))


def aeon_clasp(task: Task) -> Result:
    from aeon.segmentation import ClaSPSegmenter

    segmenter = ClaSPSegmenter(period_length=WINDOW, n_cps=task.n_segments - 1)
    return Result(sort_cuts(segmenter.fit_predict(task.channel)))


def aeon_fluss(task: Task) -> Result:
    from aeon.segmentation import FLUSSSegmenter

    segmenter = FLUSSSegmenter(period_length=WINDOW, n_regimes=task.n_segments)
    return Result(sort_cuts(segmenter.fit_predict(task.channel)))


def aeon_binary(task: Task) -> Result:
    from aeon.segmentation import BinSegmenter

    segmenter = BinSegmenter(n_cps=task.n_segments - 1)
    return Result(sort_cuts(segmenter.fit_predict(task.channel)))


def aeon_gaussian(task: Task) -> Result:
    from aeon.segmentation import GreedyGaussianSegmenter

    segmenter = GreedyGaussianSegmenter(k_max=task.n_segments - 1, random_state=0)
    return Result(find_changes(segmenter.fit_predict(task.features, axis=0)))


def aeon_information(task: Task) -> Result:
    from aeon.segmentation import InformationGainSegmenter

    segmenter = InformationGainSegmenter(k_max=task.n_segments - 1)
    return Result(find_changes(segmenter.fit_predict(task.features, axis=0)))


def aeon_eagglo(task: Task) -> Result:
    from aeon.segmentation import EAggloSegmenter

    return Result(find_changes(EAggloSegmenter().fit_predict(task.features, axis=0)))


# Left out of aeon: HMMSegmenter needs the states, HidalgoSegmenter ignores time, RandomSegmenter
# is a control.
RIVALS: dict[str, Callable[[Task], Result]] = {
    rival.__name__: rival
    for rival in (
        *(claspy_clasp, claspy_clap, stumpy_fluss, ruptures_kernel),
        *(aeon_clasp, aeon_fluss, aeon_binary, aeon_gaussian, aeon_information, aeon_eagglo),
    )
}


def sort_cuts(cuts: Any) -> list[int]:
    """Sort cuts; FLUSS pads with 0 if it finds fewer than requested."""
    return sorted({int(cut) for cut in cuts} - {0})


def find_changes(labels: NDArray[np.int64]) -> list[int]:
    return (np.flatnonzero(np.diff(labels)) + 1).tolist()


def run_rival(name: str, trial: Trial) -> tuple[float, Labelling, bool]:
    """Return seconds without features, the result, and whether it has labels."""
    features = pose_features(resample(trial.motion, FPS))
    task = Task(np.ascontiguousarray(features), len(trial.truth.labels))
    began = time.perf_counter()
    cuts, labels = RIVALS[name](task)
    seconds = time.perf_counter() - began
    labelling = Labelling.from_cuts(cuts, labels, frames=trial.truth.frames, fps=FPS)
    return seconds, labelling, labels is not None


def run_own_method(name: str, trial: Trial) -> tuple[float, Labelling, bool]:
    """Return seconds with features, activities at 30 Hz, and whether they have labels."""
    began = time.perf_counter()
    segmentation = METHODS[name](trial)
    seconds = time.perf_counter() - began
    labelling = make_labelling(segmentation.activities, fps=segmentation.fps)
    labelled = len(set(labelling.labels)) < len(labelling.labels)
    return seconds, labelling.at(frames=trial.truth.frames, fps=FPS), labelled


def measure(name: str, trial: Trial) -> dict[str, Any]:
    result = run_rival if name in RIVALS else run_own_method
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # packages warn about versions of others
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
        "cuts": len(found.labels) - 1,
        "border_f1": round(border_score(compared).f1, 3),
        "frame_accuracy": None if accuracy is None else round(accuracy, 3),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", help="folder of the recordings")
    parser.add_argument("--trials", nargs="*", help="default: all at hand")
    parser.add_argument("--methods", nargs="*", default=[*METHODS, *RIVALS])
    options = parser.parse_args()
    trials = load_trials(find_folder(options.data), options.trials)
    (warm_up,) = load_trials(find_folder(options.data), [trials[0].name])
    rows = []
    for name in options.methods:
        print(name, file=sys.stderr, flush=True)
        measure(name, warm_up)
        rows += [measure(name, trial) for trial in trials]
    rows.sort(key=lambda row: row["trial"])
    print(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
