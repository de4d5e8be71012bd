"""A view: what a method is given of a recording, and where that lies in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from kineme._arrays import Floats
from kineme.methods.base import Mirror
from kineme.segmentation.spans import RecordedSpan


@dataclass(frozen=True, eq=False)
class View:
    """The features of a recording at the working rate of a preset.

    Attributes
    ----------
    features : sequence of (samples, dims) arrays
        One of each span without a gap.
    spans : sequence of RecordedSpan
    notes : sequence of str
        What is to be known of them.
    mirror : callable, optional
        Exchanges left and right in the features, where they have these.
    joints : bool
        Whether channels are places of joints, and the preset wants to be told.
    """

    features: Sequence[Floats]
    spans: Sequence[RecordedSpan]
    notes: Sequence[str]
    mirror: Mirror | None = None
    joints: bool = False
