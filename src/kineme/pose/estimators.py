"""Define and register pose estimators, and choose one.

An estimator turns the pictures of a video into named keypoints of the people in them. Each is one
module with one `PoseEstimator`. Other packages add theirs with `register`, or as an entry point of
the group ``kineme.pose_estimators``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import Registry, check_one_of
from kineme.errors import MissingDependencyError

Picture = NDArray[np.uint8]
"""(height, width, 3): red, green and blue, upright."""


@dataclass(frozen=True)
class Pose:
    """One person in one picture.

    Parameters
    ----------
    image : (keypoints, 2) array
        Pixels from the left and from the top.
    confidence : (keypoints,) array
        Confidence of each keypoint, 0 to 1.
    metres : (keypoints, 3) array, optional
        Position relative to the middle of the hips: to the right of the picture, up, and towards
        the camera. None if the estimator gives no depth.

    Examples
    --------
    >>> Pose(np.array([[320.0, 180.0]]), np.array([0.9])).image.shape
    (1, 2)
    """

    image: Floats
    confidence: Floats
    metres: Floats | None = None


Estimate = Callable[[Picture, float], Sequence[Pose]]
"""Takes a picture and its time in seconds, in the order of time; returns the people in it."""


@dataclass(frozen=True)
class PoseEstimator:
    """A pose estimator.

    Parameters
    ----------
    name : str
        The name that selects it.
    keypoints : sequence of str
        Names of the keypoints, such as ``left_knee``.
    package : str
        The package that it needs.
    start : callable
        Takes the path of a model (None for the estimator's own) and returns a context manager that
        gives an `Estimate`. It is called once per video, so an estimator may track people.
    limit : float
        Confidence below which a keypoint is not used when the poses are read.

    Examples
    --------
    >>> from contextlib import contextmanager
    >>> @contextmanager
    ... def start(model):
    ...     yield lambda picture, time: [Pose(np.array([[40.0, 9.0]]), np.array([0.9]))]
    >>> PoseEstimator("nose", ["nose"], "numpy", start).is_installed
    True
    """

    name: str
    keypoints: Sequence[str]
    package: str
    start: Callable[[Path | None], AbstractContextManager[Estimate]]
    limit: float = 0.0

    @property
    def is_installed(self) -> bool:
        """Return whether the package that it needs is installed."""
        return find_spec(self.package) is not None


ESTIMATORS: Registry[PoseEstimator] = Registry(
    PoseEstimator,
    "pose estimator",
    "kineme.pose_estimators",
    home="kineme.pose",
    builtins=("mediapipe_estimator:ESTIMATOR", "rtmlib_estimator:ESTIMATOR"),
)


def register(new: PoseEstimator, *, replace: bool = False) -> None:
    """Add an estimator; raise ParameterError if its name is taken and ``replace`` is False.

    Examples
    --------
    >>> register(ESTIMATORS["mediapipe"], replace=True)
    """
    ESTIMATORS.register(new, replace=replace)


def estimator_names() -> tuple[str, ...]:
    """Return the names of the estimators, the preferred one first.

    Examples
    --------
    >>> estimator_names()
    ('mediapipe', 'rtmlib')
    """
    return tuple(ESTIMATORS)


def choose_estimator(name: str | None) -> PoseEstimator:
    """Return the estimator of this name, or the first whose package is installed.

    Raises ParameterError for an unknown name, MissingDependencyError if no package is installed.
    """
    if name is not None:
        check_one_of(name, ESTIMATORS, "estimator")
    candidates = [each for each in ESTIMATORS.values() if name in (None, each.name)]
    for each in candidates:
        if each.is_installed:
            return each
    raise MissingDependencyError(candidates[0].package, "video")
