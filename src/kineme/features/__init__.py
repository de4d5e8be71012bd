"""Feature vectors of poses: end effectors in the body's own frame, stacked over time."""

from kineme.features.body_frame import body_frame
from kineme.features.effectors import PARTS, EndEffectors, Names, end_effectors
from kineme.features.pose import offsets_in_frames, pose_features, stack

__all__ = [
    "PARTS",
    "EndEffectors",
    "Names",
    "body_frame",
    "end_effectors",
    "offsets_in_frames",
    "pose_features",
    "stack",
]
