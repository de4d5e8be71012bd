"""What results are compared with, as presets like any other.

All of them see a body by the rotations of 14 joints, where it has these, and at
120 Hz, as their authors did; any other recording as every method sees it.
ACA, HACA and GMM have to be told how many actions there are (``n_classes``).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import as_features
from kineme.errors import ParameterError
from kineme.methods.base import RATE, Mirror, Preset, Unit, View
from kineme.methods.constants import COUNT, SOME, SOME_TIME, constant

if TYPE_CHECKING:
    from kineme.methods.baselines.found import SegmentsFound
    from kineme.methods.baselines.segments import Segments
    from kineme.methods.stages import Progress

Floats = NDArray[np.float64]
Lengths = tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class BaselinePreset(Preset):
    """What the baselines share: how they see a recording."""

    method: ClassVar[str] = "baselines"
    units: ClassVar[tuple[Unit, ...]] = ("any",)
    view: ClassVar[View] = "quaternions"

    unit: Unit = "any"
    working_fps: float = constant(
        "samples per second at which the recording is looked at", unit="Hz", limits=RATE,
        default=120.0,
    )  # fmt: skip

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,  # noqa: ARG002 (left and right are told apart)
        progress: Progress | None = None,
    ) -> SegmentsFound:
        """Segments of the activity level; see the method's own module."""
        from kineme.methods.baselines.found import SegmentsFound
        from kineme.methods.stages import stopwatch

        rows = as_features(features)
        timings: dict[str, float] = {}
        with stopwatch(timings, progress)(self.name):
            segments = self.segments(rows)
        return SegmentsFound(rows, segments, timings)

    def segments(self, features: Floats) -> Segments:
        """The segments in features (samples, dims)."""
        raise NotImplementedError

    def for_signals(self) -> Self:
        """The preset at a rate that channels of sensors carry."""
        return replace(self, working_fps=min(self.working_fps, 30.0))


@dataclass(frozen=True, kw_only=True)
class ToldPreset(BaselinePreset):
    """A baseline that has to be told the number of actions."""

    n_classes: int | None = constant(
        "number of actions, which the method has to be told", limits=SOME, default=None
    )
    seed: int = constant("of all random starts", limits=COUNT, default=0, fine=True)

    def told(self) -> int:
        """The number of actions; ParameterError if nobody said."""
        if self.n_classes is None:
            raise ParameterError(
                f"{self.name} has to be told the number of actions: give n_classes (--n-classes)"
            )
        return self.n_classes


@dataclass(frozen=True, kw_only=True)
class AcaPreset(ToldPreset):
    """Aligned cluster analysis; see `kineme.methods.baselines.aca`."""

    view: ClassVar[View] = "rotation vectors"

    shortest: int = constant(
        "shortest segment, blocks of at most 5 samples", limits=SOME, default=32
    )
    longest: int = constant("longest segment, blocks", limits=SOME, default=60)
    starts: int = constant("initialisations, of which the best is kept", limits=SOME, default=1)
    centres: int = constant("k-means centres of the reduction to blocks", limits=SOME, default=20)

    def segments(self, features: Floats) -> Segments:
        """Segments of least total distance to their cluster."""
        from kineme.methods.baselines.aca import aca

        return aca(
            features,
            n_classes=self.told(),
            shortest=self.shortest,
            longest=self.longest,
            starts=self.starts,
            centres=self.centres,
            seed=self.seed,
        )


@dataclass(frozen=True, kw_only=True)
class HacaPreset(ToldPreset):
    """Hierarchical aligned cluster analysis; see `kineme.methods.baselines.haca`."""

    view: ClassVar[View] = "rotation vectors"

    fine_lengths: Lengths = constant(
        "shortest and longest segment of the first level, blocks of at most 5 samples",
        limits=SOME, default=(8, 10),
    )  # fmt: skip
    coarse_lengths: Lengths = constant(
        "shortest and longest segment of the second level, segments of the first", limits=SOME,
        default=(4, 6),
    )  # fmt: skip
    centres: int = constant("k-means centres of the reduction to blocks", limits=SOME, default=20)

    def segments(self, features: Floats) -> Segments:
        """Segments of the second level."""
        from kineme.methods.baselines.haca import haca

        return haca(
            features,
            n_classes=self.told(),
            fine_lengths=self.fine_lengths,
            coarse_lengths=self.coarse_lengths,
            centres=self.centres,
            seed=self.seed,
        )


@dataclass(frozen=True, kw_only=True)
class GmmPreset(ToldPreset):
    """Gaussian mixture; see `kineme.methods.baselines.gmm`."""

    def segments(self, features: Floats) -> Segments:
        """Runs of samples whose likeliest Gaussian is the same."""
        from kineme.methods.baselines.gmm import gmm

        return gmm(features, n_classes=self.told(), seed=self.seed)


@dataclass(frozen=True, kw_only=True)
class PcaPreset(BaselinePreset):
    """Cuts where principal components cease to fit; see `kineme.methods.baselines.pca`."""

    def segments(self, features: Floats) -> Segments:
        """Segments that share their principal components."""
        from kineme.methods.baselines.pca import pca

        return pca(features, fps=self.working_fps)


@dataclass(frozen=True, kw_only=True)
class PpcaPreset(BaselinePreset):
    """Cuts where a Gaussian ceases to fit; see `kineme.methods.baselines.pca`."""

    def segments(self, features: Floats) -> Segments:
        """Segments that share their Gaussian."""
        from kineme.methods.baselines.pca import ppca

        return ppca(features, fps=self.working_fps)


@dataclass(frozen=True, kw_only=True)
class UniformPreset(BaselinePreset):
    """Cuts at equal distances; see `kineme.methods.baselines.uniform`."""

    interval: float = constant("time between two cuts", unit="s", limits=SOME_TIME, default=0.5)

    def segments(self, features: Floats) -> Segments:
        """Segments of equal length."""
        from kineme.methods.baselines.uniform import uniform

        return uniform(len(features), fps=self.working_fps, seconds=self.interval)


BASELINES: tuple[BaselinePreset, ...] = (
    AcaPreset(name="aca", help="Aligned cluster analysis, 2008; told the number of actions."),
    HacaPreset(name="haca", help="The same on two levels, 2013; told the number of actions."),
    PcaPreset(name="pca", help="Cuts where principal components cease to fit, 2004."),
    PpcaPreset(name="ppca", help="Cuts where a Gaussian ceases to fit, 2004."),
    GmmPreset(name="gmm", help="Gaussian mixture, 2004; told the number of actions."),
    UniformPreset(name="uniform", help="A cut every half second: the control."),
)
