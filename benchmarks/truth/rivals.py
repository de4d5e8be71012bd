"""Compare our methods with other packages on subject 86.

    pip install -r benchmarks/rivals/requirements.txt  # in an environment of its own
    python -m benchmarks rivals [--trials 86_01 …] [--methods claspy_clasp …]

Other packages get the positions of the five end effectors in the body's own frame at 30 Hz,
(frames, 15), and their defaults. Those that need the number of segments get the true one (ACA and
HACA get the number of classes); a window is one second. Packages for one channel get the first
principal component. Of aeon, HMMSegmenter (needs the states), HidalgoSegmenter (ignores time) and
RandomSegmenter (a control) are left out.

Each method runs once untimed on the first trial, when packages compile. A cut is right within the
annotators' span ± 0.25 s.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from _options import DATA, choose_size, find_data, make_parser, need_packages
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


def run_clasp(task: Task) -> Result:
    from claspy.segmentation import BinaryClaSPSegmentation

    return Result(sort_cuts(BinaryClaSPSegmentation().fit_predict(task.features)))


def run_clap(task: Task) -> Result:
    from claspy.state_detection import AgglomerativeCLaPDetection

    states = AgglomerativeCLaPDetection().fit(task.features)
    return Result(sort_cuts(states.get_change_points()), states.get_segment_labels().tolist())


def run_fluss(task: Task) -> Result:
    import stumpy

    _, indices = stumpy.mstump(task.features.T, WINDOW)
    _, cuts = stumpy.fluss(indices[-1], L=WINDOW, n_regimes=task.n_segments)
    return Result(sort_cuts(cuts))


def run_kernel_change(task: Task) -> Result:
    import ruptures

    search = ruptures.KernelCPD(kernel="rbf").fit(task.features)
    return Result(sort_cuts(search.predict(n_bkps=task.n_segments - 1)[:-1]))


def use_aeon(segmenter: str, choose: Callable[[int], dict[str, Any]]) -> Callable[[Task], Result]:
    """Return a method of aeon, with its options for a number of segments."""

    def run(task: Task) -> Result:
        from aeon import segmentation

        method = getattr(segmentation, segmenter)(**choose(task.n_segments))
        if segmenter in ONE_CHANNEL:
            return Result(sort_cuts(method.fit_predict(task.channel)))
        labels = method.fit_predict(task.features, axis=0)
        return Result((np.flatnonzero(np.diff(labels)) + 1).tolist())

    return run


ONE_CHANNEL = ("ClaSPSegmenter", "FLUSSSegmenter", "BinSegmenter")
"""Segmenters of aeon for one channel, which return cuts; others return a label per frame."""
AEON: dict[str, tuple[str, Callable[[int], dict[str, Any]]]] = {
    "aeon_clasp": ("ClaSPSegmenter", lambda n: {"n_cps": n - 1, "period_length": WINDOW}),
    "aeon_fluss": ("FLUSSSegmenter", lambda n: {"n_regimes": n, "period_length": WINDOW}),
    "aeon_binary": ("BinSegmenter", lambda n: {"n_cps": n - 1}),
    "aeon_gaussian": ("GreedyGaussianSegmenter", lambda n: {"k_max": n - 1, "random_state": 0}),
    "aeon_information": ("InformationGainSegmenter", lambda n: {"k_max": n - 1}),
    "aeon_eagglo": ("EAggloSegmenter", lambda _: {}),
}
RIVALS: dict[str, Callable[[Task], Result]] = {
    "claspy_clasp": run_clasp,
    "claspy_clap": run_clap,
    "stumpy_fluss": run_fluss,
    "ruptures_kernel": run_kernel_change,
    **{name: use_aeon(*segmenter) for name, segmenter in AEON.items()},
}


def sort_cuts(cuts: Any) -> list[int]:
    """Sort cuts; FLUSS pads with 0 if it finds fewer than requested."""
    return sorted({int(cut) for cut in cuts} - {0})


def run_rival(name: str, trial: Trial) -> tuple[float, Labelling, bool]:
    """Return seconds without features, the result, and whether it has labels."""
    features = pose_features(resample(trial.motion, FPS))
    task = Task(np.ascontiguousarray(features), len(trial.truth.labels))
    began = perf_counter()
    cuts, labels = RIVALS[name](task)
    seconds = perf_counter() - began
    labelling = Labelling.from_cuts(cuts, labels, frames=trial.truth.frames, fps=FPS)
    return seconds, labelling, labels is not None


def run_own_method(name: str, trial: Trial) -> tuple[float, Labelling, bool]:
    """Return seconds with features, activities at 30 Hz, and whether they have labels."""
    began = perf_counter()
    segmentation = METHODS[name](trial)
    seconds = perf_counter() - began
    labelling = make_labelling(segmentation.activities, fps=segmentation.fps)
    labelled = len(set(labelling.labels)) < len(labelling.labels)
    return seconds, labelling.at(frames=trial.truth.frames, fps=FPS), labelled


def measure(name: str, trial: Trial) -> str:
    """Return a line with the scores and the time of a method on a trial."""
    title = f"{trial.name} {name:20}"
    run = run_rival if name in RIVALS else run_own_method
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # packages warn about versions of others
            seconds, found, labelled = run(name, trial)
    except Exception as error:  # noqa: BLE001 (a rival that fails is a result)
        return f"{title} {type(error).__name__}: {error}"
    compared = Comparison.of(trial.truth, found)
    accuracy = f"{one_to_one_accuracy(compared):.3f}" if labelled else "–"
    cuts = f"{len(found.labels) - 1} of {len(trial.truth.labels) - 1}"
    return f"{title}{seconds:9.3f} s{cuts:>12}{border_score(compared).f1:11.3f}{accuracy:>10}"


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--trials", nargs="*", help="default: all at hand")
    parser.add_argument("--methods", nargs="*", default=[*METHODS, *RIVALS])
    options = parser.parse_args()
    find_data("cmu86")
    # The names of rivals begin with that of their package.
    rivals = [name for name in options.methods if name in RIVALS]
    need_packages(*sorted({name.partition("_")[0] for name in rivals}))
    trials = load_trials(find_folder(DATA), options.trials)[: choose_size(None, 1)]
    print(f"{'':26}{'time':>11}{'cuts':>12}{'border F1':>11}{'frames':>10}")
    for name in options.methods:
        measure(name, trials[0])
        for trial in trials:
            print(measure(name, trial), flush=True)


if __name__ == "__main__":
    main()
