"""Register segmenters of other packages as presets, so that they are scored like every method.

Input: standardized channels, averaged to 20 samples per second. All run with their defaults.
Methods that need the number of classes get the true one. If a package finds only borders, Ward's
linkage of the means and deviations of the channels joins segments to that many clusters.
Packages that are not installed are left out; ``benchmarks/rivals/requirements.txt`` lists them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.util import find_spec
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from kineme.methods.presets import register
from kineme.methods.segments import number_by_appearance
from kineme_reproduction.baselines.presets import BaselinePreset, ClassCountPreset
from kineme_reproduction.baselines.segments import Segments, unclustered

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
RATE = 20.0


@dataclass(frozen=True, kw_only=True)
class RivalPreset(BaselinePreset):
    """A segmenter of another package, at 20 samples per second."""

    package: ClassVar[str] = ""

    def for_signals(self) -> Self:
        return replace(self, working_fps=RATE)


class ClapPreset(RivalPreset):
    """Change points by ClaSP, states by CLaP."""

    package: ClassVar[str] = "claspy"

    def segments(self, features: Floats) -> Segments:
        from claspy.segmentation import BinaryClaSPSegmentation
        from claspy.state_detection import AgglomerativeCLaPDetection

        cuts = np.asarray(BinaryClaSPSegmentation().fit_predict(features), np.int64)
        if not len(cuts):  # CLaP needs two segments at least
            return unclustered(cuts, len(features))
        found = AgglomerativeCLaPDetection().fit(features, change_points=cuts)
        states = np.unique(found.get_segment_labels(), return_inverse=True)[1]
        cuts = np.asarray(found.get_change_points(), np.int64)
        return Segments(cuts, number_by_appearance(states), len(features))


@dataclass(frozen=True, kw_only=True)
class KernelChangePreset(RivalPreset, ClassCountPreset):
    """Change points with an RBF kernel and the usual penalty log n; clusters by Ward's linkage."""

    package: ClassVar[str] = "ruptures"

    def segments(self, features: Floats) -> Segments:
        import ruptures

        search = ruptures.KernelCPD(kernel="rbf", min_size=round(RATE / 2)).fit(features)
        ends = search.predict(pen=float(np.log(len(features))))
        return cluster_segments(np.asarray(ends[:-1], np.int64), features, self.required_classes())


@dataclass(frozen=True, kw_only=True)
class HiddenMarkovPreset(RivalPreset, ClassCountPreset):
    """A Gaussian hidden Markov model with the true number of states."""

    package: ClassVar[str] = "tsseg"

    def segments(self, features: Floats) -> Segments:
        from tsseg.algorithms import GaussianHMMDetector

        model = GaussianHMMDetector(n_states=self.required_classes(), random_state=self.seed)
        states = np.asarray(model.fit_predict(features), np.int64)
        cuts = np.flatnonzero(np.diff(states)) + 1
        return Segments(cuts, number_by_appearance(states[np.append(0, cuts)]), len(features))


def cluster_segments(cuts: Ints, features: Floats, n_classes: int) -> Segments:
    """Cluster the segments between cuts into at most so many clusters."""
    from scipy.cluster.hierarchy import fcluster, linkage

    if not len(cuts):
        return unclustered(cuts, len(features))
    parts = np.split(features, cuts)
    shapes = np.array([np.append(part.mean(axis=0), part.std(axis=0)) for part in parts])
    joined = fcluster(linkage(shapes, "ward"), n_classes, "maxclust")
    return Segments(cuts, number_by_appearance(joined - 1), len(features))


RIVALS = (
    ClapPreset(name="claspy", help="ClaSP and CLaP"),
    KernelChangePreset(name="ruptures", help="change points of a kernel"),
    HiddenMarkovPreset(name="tsseg_hmm", help="a Gaussian hidden Markov model"),
)


def register_rivals() -> tuple[list[str], list[str]]:
    """Register presets; return their names, and those of packages that are not installed."""
    here = [rival for rival in RIVALS if find_spec(rival.package)]
    for rival in here:
        register(rival, replace=True)
    return [rival.name for rival in here], [r.package for r in RIVALS if r not in here]
