"""Feature vectors of poses: end effectors in the body's own frame, stacked over time.

Without a body, features are distances between points. ``bundling`` is not imported
here, because it loads compiled code.
"""

from kineme.features.distances import compute_distance_features
from kineme.features.effectors import PARTS, EndEffectors, Names, end_effectors, measure_body_size
from kineme.features.mirroring import mirror, mirror_features
from kineme.features.pose import (
    compute_body_frame,
    compute_heading,
    pose_features,
    round_offsets,
    stack,
)

__all__ = [
    "PARTS",
    "EndEffectors",
    "Names",
    "compute_body_frame",
    "compute_distance_features",
    "compute_heading",
    "end_effectors",
    "measure_body_size",
    "mirror",
    "mirror_features",
    "pose_features",
    "round_offsets",
    "stack",
]
