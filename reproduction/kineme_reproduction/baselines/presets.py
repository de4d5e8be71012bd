"""What results are compared with, as presets like any other; see `constants` for their fields."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.checks import as_features
from kineme.methods.base import Mirror
from kineme_reproduction.baselines.constants import (
    AcaConstants,
    BaselineConstants,
    GmmConstants,
    HacaConstants,
    PcaConstants,
    PpcaConstants,
    UniformConstants,
)

if TYPE_CHECKING:
    from kineme.methods.base import Progress
    from kineme_reproduction.baselines.found import SegmentsFound
    from kineme_reproduction.baselines.segments import Segments

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class BaselinePreset(BaselineConstants):
    """A method by its constants: segments of one level."""

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,  # noqa: ARG002 (left and right are told apart)
        progress: Progress | None = None,
    ) -> SegmentsFound:
        """Segments of the activity level; see the method's own module."""
        from kineme.methods.base import time_stages
        from kineme_reproduction.baselines.found import SegmentsFound

        rows = as_features(features)
        timings: dict[str, float] = {}
        with time_stages(timings, progress)(self.name):
            segments = self.segments(rows)
        return SegmentsFound(rows, segments, timings)

    def segments(self, features: Floats) -> Segments:
        """The segments in features (samples, dims)."""
        raise NotImplementedError

    def for_signals(self) -> Self:
        """The preset at a rate that channels of sensors carry."""
        return replace(self, working_fps=min(self.working_fps, 30.0))


@dataclass(frozen=True, kw_only=True)
class AcaPreset(AcaConstants, BaselinePreset):
    """Aligned cluster analysis; see `kineme_reproduction.baselines.aca`."""

    def segments(self, features: Floats) -> Segments:
        """Segments of least total distance to their cluster."""
        from kineme_reproduction.baselines.aca import aca

        return aca(features, self)


@dataclass(frozen=True, kw_only=True)
class HacaPreset(HacaConstants, BaselinePreset):
    """Hierarchical aligned cluster analysis; see `kineme_reproduction.baselines.haca`."""

    def segments(self, features: Floats) -> Segments:
        """Segments of the second level."""
        from kineme_reproduction.baselines.haca import haca

        return haca(features, self)


@dataclass(frozen=True, kw_only=True)
class GmmPreset(GmmConstants, BaselinePreset):
    """Gaussian mixture; see `kineme_reproduction.baselines.gmm`."""

    def segments(self, features: Floats) -> Segments:
        """Runs of samples whose likeliest Gaussian is the same."""
        from kineme_reproduction.baselines.gmm import gmm

        return gmm(features, self)


@dataclass(frozen=True, kw_only=True)
class PcaPreset(PcaConstants, BaselinePreset):
    """Cuts where principal components cease to fit; see `kineme_reproduction.baselines.pca`."""

    def segments(self, features: Floats) -> Segments:
        """Segments that share their principal components."""
        from kineme_reproduction.baselines.pca import pca

        return pca(features, self)


@dataclass(frozen=True, kw_only=True)
class PpcaPreset(PpcaConstants, BaselinePreset):
    """Cuts where a Gaussian ceases to fit; see `kineme_reproduction.baselines.pca`."""

    def segments(self, features: Floats) -> Segments:
        """Segments that share their Gaussian."""
        from kineme_reproduction.baselines.pca import ppca

        return ppca(features, self)


@dataclass(frozen=True, kw_only=True)
class UniformPreset(UniformConstants, BaselinePreset):
    """Cuts at equal distances; see `kineme_reproduction.baselines.uniform`."""

    def segments(self, features: Floats) -> Segments:
        """Segments of equal length."""
        from kineme_reproduction.baselines.uniform import uniform

        return uniform(len(features), fps=self.working_fps, seconds=self.interval)


BASELINES: tuple[BaselinePreset, ...] = (
    AcaPreset(name="aca", help="Aligned cluster analysis, 2008; told the number of actions."),
    HacaPreset(name="haca", help="The same on two levels, 2013; told the number of actions."),
    PcaPreset(name="pca", help="Cuts where principal components cease to fit, 2004."),
    PpcaPreset(name="ppca", help="Cuts where a Gaussian ceases to fit, 2004."),
    GmmPreset(name="gmm", help="Gaussian mixture, 2004; told the number of actions."),
    UniformPreset(name="uniform", help="A cut every half second: the control."),
)
