"""Poses from videos: estimators of keypoints, and the file that their poses are kept in.

`PoseEstimator` is one estimator, found by entry points of the group ``kineme.pose_estimators``.
`estimate_poses` runs it over a video and leaves a table of poses, which
`kineme.formats.keypoints.poses` describes and reads. `kineme.read` does both for the name of a
video. Everything happens on this machine: no frame of a video leaves it.
"""

from kineme.pose.estimating import estimate_poses
from kineme.pose.estimators import Estimate, Pose, PoseEstimator, estimator_names, register

__all__ = ["Estimate", "Pose", "PoseEstimator", "estimate_poses", "estimator_names", "register"]
