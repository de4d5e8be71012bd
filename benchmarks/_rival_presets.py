"""Segmenters of other packages as presets, so that they are scored as every method is.

They get the channels in standard deviations, averaged to 20 samples a second, and run with
their defaults. What has to be told a number is told the true number of classes. Cuts without
clusters leave each segment a cluster of its own: there only scores of borders mean something.
Packages that are not installed are left out; ``benchmarks/rivals/requirements.txt`` names them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.util import find_spec
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from kineme.methods.baselines.constants import ToldConstants
from kineme.methods.baselines.presets import BaselinePreset
from kineme.methods.baselines.segments import Segments, unclustered
from kineme.methods.presets import register
from kineme.methods.segments import by_first_appearance

Floats = NDArray[np.float64]
RATE = 20.0


@dataclass(frozen=True, kw_only=True)
class RivalPreset(BaselinePreset):
    """What all share: channels as they are, 20 times a second."""

    package: ClassVar[str] = ""

    def for_signals(self) -> Self:
        return replace(self, working_fps=RATE)


class ClapPreset(RivalPreset):
    """ClaSP's change points, and which segments are one state by CLaP."""

    package: ClassVar[str] = "claspy"

    def segments(self, features: Floats) -> Segments:
        from claspy.state_detection import AgglomerativeCLaPDetection

        found = AgglomerativeCLaPDetection().fit(features)
        cuts = np.asarray(found.get_change_points(), np.int64)
        states = np.unique(found.get_segment_labels(), return_inverse=True)[1]
        return Segments(cuts, by_first_appearance(states), len(features))


class KernelChangePreset(RivalPreset):
    """Change points of an RBF kernel; log n for each, as it is usual."""

    package: ClassVar[str] = "ruptures"

    def segments(self, features: Floats) -> Segments:
        import ruptures

        search = ruptures.KernelCPD(kernel="rbf", min_size=round(RATE / 2)).fit(features)
        return unclustered(search.predict(pen=float(np.log(len(features))))[:-1], len(features))


@dataclass(frozen=True, kw_only=True)
class HiddenMarkovPreset(ToldConstants, RivalPreset):
    """A hidden Markov model with a Gaussian for each state, told how many there are."""

    package: ClassVar[str] = "tsseg"

    def segments(self, features: Floats) -> Segments:
        from tsseg.algorithms import GaussianHMMDetector

        model = GaussianHMMDetector(n_states=self.told(), random_state=self.seed)
        states = np.asarray(model.fit_predict(features), np.int64)
        cuts = np.flatnonzero(np.diff(states)) + 1
        return Segments(cuts, by_first_appearance(states[np.append(0, cuts)]), len(features))


RIVALS = (
    ClapPreset(name="claspy", help="ClaSP and CLaP"),
    KernelChangePreset(name="ruptures", help="change points of a kernel"),
    HiddenMarkovPreset(name="tsseg_hmm", help="a Gaussian hidden Markov model"),
)


def register_rivals() -> tuple[list[str], list[str]]:
    """Names of the presets whose packages are here, and of the packages that are not."""
    here = [rival for rival in RIVALS if find_spec(rival.package)]
    for rival in here:
        register(rival)
    return [rival.name for rival in here], [r.package for r in RIVALS if r not in here]
