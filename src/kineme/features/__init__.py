"""Feature vectors of poses: end effectors in the body's own frame, stacked over time.

Where there is no body: distances between points. ``bundling`` is not loaded
here: it comes with compiled code.
"""

from kineme.features.body_frame import body_frame, heading
from kineme.features.distances import compute_distance_features
from kineme.features.effectors import PARTS, EndEffectors, Names, body_size, end_effectors
from kineme.features.mirroring import mirror, mirror_features
from kineme.features.pose import pose_features, round_offsets, stack

__all__ = [
    "PARTS",
    "EndEffectors",
    "Names",
    "body_frame",
    "body_size",
    "compute_distance_features",
    "end_effectors",
    "heading",
    "mirror",
    "mirror_features",
    "pose_features",
    "round_offsets",
    "stack",
]
