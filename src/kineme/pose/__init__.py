"""Estimate the poses of people in videos.

`PoseEstimator` describes one estimator. Estimators are registered as entry points of the group
``kineme.pose_estimators``. `estimate_poses` runs one over a video and writes a table of poses;
`kineme.formats.keypoints.poses` defines and reads this table. `kineme.read` does both for a video.
All of it runs on this machine: no frame of a video leaves it.
"""

from kineme.pose.estimating import estimate_poses
from kineme.pose.estimators import Estimate, Pose, PoseEstimator, estimator_names, register

__all__ = ["Estimate", "Pose", "PoseEstimator", "estimate_poses", "estimator_names", "register"]
