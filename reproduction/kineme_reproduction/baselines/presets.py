"""Define presets of the methods that kineme is compared with.

All use the rotations of 14 joints at 120 Hz, as their authors did, if the body has these joints,
and the usual features otherwise. ACA, HACA and GMM need the number of actions (``n_classes``).
Values are those of the papers; lengths that they give in frames at 120 Hz are in seconds.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from importlib import import_module
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme._util.checks import as_features
from kineme.errors import ParameterError
from kineme.methods.base import (
    COUNT,
    FACTOR,
    RATE,
    SHARE,
    SOME,
    SOME_SHARE,
    SOME_TIME,
    Columns,
    Mirror,
    Preset,
    Progress,
    Unit,
    View,
    constant,
    time_stages,
)
from kineme_reproduction.baselines.segments import Segments, cut_uniformly

Lengths = tuple[int, int]
VARIANCE_KEPT = "share of the variance that the leading directions keep"


@dataclass(frozen=True, eq=False)
class SegmentsFound:
    """Segments of the activity level, each in a cluster.

    Attributes
    ----------
    features : (samples, dims) array
    segments : Segments
    timings : dict of str to float
        Seconds per stage.
    """

    features: Floats
    segments: Segments
    timings: dict[str, float] = field(default_factory=dict)

    def columns(self) -> Columns:
        """Return activities only; methods without clusters number them."""
        n = len(self.segments.clusters)
        return {
            "level": np.full(n, "activity"),
            "kind": np.full(n, "activity"),
            "start_frame": self.segments.starts,
            "stop_frame": self.segments.stops,
            "cluster": self.segments.clusters,
            "confidence": np.full(n, np.nan),
        }

    def doubts(self, columns: Columns, fps: float) -> list[str]:  # noqa: ARG002
        """Return nothing, as the baselines give no confidence."""
        return []


@dataclass(frozen=True, kw_only=True)
class BaselinePreset(Preset):
    """A method by its constants: segments of one level."""

    method: ClassVar[str] = "baselines"
    units: ClassVar[tuple[Unit, ...]] = ("any",)
    view: ClassVar[View] = "quaternions"
    function: ClassVar[str]
    """Module and name of the function that finds the segments of features with a preset."""

    unit: Unit = "any"
    working_fps: float = constant(
        "samples per second to which the recording is resampled", unit="Hz", limits=RATE,
        default=120.0,
    )  # fmt: skip

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,  # noqa: ARG002 (left and right are told apart)
        progress: Progress | None = None,
    ) -> SegmentsFound:
        """Return segments of the activity level."""
        rows = as_features(features)
        timings: dict[str, float] = {}
        with time_stages(timings, progress)(self.name):
            segments = self.segments(rows)
        return SegmentsFound(rows, segments, timings)

    def segments(self, features: Floats) -> Segments:
        """Return the segments in features (samples, dims)."""
        # Imported by name when it runs: it loads compiled code and scikit-learn.
        module, name = self.function.split(".")
        find_segments = getattr(import_module(f"{__package__}.{module}"), name)
        found: Segments = find_segments(features, self)
        return found

    def for_signals(self) -> Self:
        """Return the preset at a rate that channels of sensors carry."""
        return replace(self, working_fps=min(self.working_fps, 30.0))


@dataclass(frozen=True, kw_only=True)
class ClassCountPreset(BaselinePreset):
    """A method that needs the number of actions."""

    n_classes: int | None = constant(
        "number of actions, which the method has to be told", limits=SOME, default=None
    )
    seed: int = constant("of all random starts", limits=COUNT, default=0, fine=True)

    def required_classes(self) -> int:
        """Return `n_classes`; raise ParameterError if it is not given."""
        if self.n_classes is None:
            raise ParameterError(
                f"{self.name} has to be told the number of actions: give n_classes "
                "(--set n_classes=4)"
            )
        return self.n_classes


@dataclass(frozen=True, kw_only=True)
class AlignedPreset(ClassCountPreset):
    """Constants that ACA and HACA share."""

    view: ClassVar[View] = "rotation vectors"

    centres: int = constant("k-means centres of the reduction to blocks", limits=SOME, default=20)
    longest_block: int = constant(
        "longest block that stands for like samples", unit="samples", limits=SOME, default=5,
        fine=True,
    )  # fmt: skip
    nearest_share: float = constant(
        "share of the blocks that are nearest to one, whose mean distance is the kernel's width",
        limits=SOME_SHARE, default=0.02, fine=True,
    )  # fmt: skip
    kmeans_starts: int = constant(
        "random starts of each k-means, of which the tightest is kept", limits=SOME, default=50,
        fine=True,
    )  # fmt: skip
    searches: int = constant(
        "searches for better segments, unless these repeat before", limits=SOME, default=20,
        fine=True,
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class AcaPreset(AlignedPreset):
    """Aligned cluster analysis."""

    function: ClassVar[str] = "aca.aca"

    shortest: int = constant("shortest segment", unit="blocks", limits=SOME, default=32)
    longest: int = constant("longest segment", unit="blocks", limits=SOME, default=60)
    starts: int = constant("initialisations, of which the best is kept", limits=SOME, default=1)


@dataclass(frozen=True, kw_only=True)
class HacaPreset(AlignedPreset):
    """Hierarchical aligned cluster analysis."""

    function: ClassVar[str] = "aca.haca"

    fine_lengths: Lengths = constant(
        "shortest and longest segment of the first level", unit="blocks", limits=SOME,
        default=(8, 10),
    )  # fmt: skip
    coarse_lengths: Lengths = constant(
        "shortest and longest segment of the second level, segments of the first", limits=SOME,
        default=(4, 6),
    )  # fmt: skip
    fine_classes: int = constant("clusters of the first level", limits=SOME, default=12)
    fine_starts: int = constant(
        "initialisations of the first level, of which the best second level is kept",
        limits=SOME, default=5,
    )  # fmt: skip
    coarse_starts: int = constant(
        "initialisations of the second level, of which the best is kept", limits=SOME, default=10
    )


@dataclass(frozen=True, kw_only=True)
class GmmPreset(ClassCountPreset):
    """Gaussian mixture."""

    function: ClassVar[str] = "barbic2004.gmm"

    variance_kept: float = constant(VARIANCE_KEPT, limits=SHARE, default=0.9)


@dataclass(frozen=True, kw_only=True)
class PcaPreset(BaselinePreset):
    """Cuts where principal components cease to fit."""

    function: ClassVar[str] = "barbic2004.pca"

    first: float = constant(
        "first part of a segment, which fixes the number of components", unit="s",
        limits=SOME_TIME, default=2.0,
    )  # fmt: skip
    rise_span: float = constant(
        "time over which the rise of the error is taken", unit="s", limits=SOME_TIME, default=0.5
    )
    variance_kept: float = constant(VARIANCE_KEPT, limits=SHARE, default=0.9)
    deviations: float = constant(
        "standard deviations by which the rise exceeds its mean at a cut", limits=FACTOR,
        default=3.0,
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class PpcaPreset(BaselinePreset):
    """Cuts where a Gaussian ceases to fit."""

    function: ClassVar[str] = "barbic2004.ppca"

    ahead: float = constant(
        "time ahead that is held against the Gaussian, and the first that it is fitted to",
        unit="s", limits=SOME_TIME, default=1.25,
    )  # fmt: skip
    growth_step: float = constant(
        "steps in which the time grows that the Gaussian is fitted to", unit="s",
        limits=SOME_TIME, default=1 / 12,
    )  # fmt: skip
    variance_kept: float = constant(VARIANCE_KEPT, limits=SHARE, default=0.95)
    rise: float = constant(
        "share of the distance's range by which a peak rises above the valley before it",
        limits=SHARE, default=0.1,
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class UniformPreset(BaselinePreset):
    """Cuts at equal distances."""

    interval: float = constant("time between two cuts", unit="s", limits=SOME_TIME, default=0.5)

    def segments(self, features: Floats) -> Segments:
        return cut_uniformly(len(features), fps=self.working_fps, seconds=self.interval)


BASELINES: tuple[BaselinePreset, ...] = (
    AcaPreset(name="aca", help="Aligned cluster analysis, 2008; told the number of actions."),
    HacaPreset(name="haca", help="The same on two levels, 2013; told the number of actions."),
    PcaPreset(name="pca", help="Cuts where principal components cease to fit, 2004."),
    PpcaPreset(name="ppca", help="Cuts where a Gaussian ceases to fit, 2004."),
    GmmPreset(name="gmm", help="Gaussian mixture, 2004; told the number of actions."),
    UniformPreset(name="uniform", help="A cut every half second: the control."),
)
