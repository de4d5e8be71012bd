"""Whether columns are channels of sensors or coordinates of a body's joints, by their names.

A table whose columns are coordinates of joints is a motion. Sensors have
coordinates, too: ``acc_x``, ``gyro.y`` or ``ForceZ`` are told by their names.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from kineme.formats.columns import joint_names
from kineme.formats.tables.pose_tables import is_pose_table

_SENSOR = re.compile(
    r"acc(el\w*)?|gyr(o\w*)?|mag(net\w*)?|imu|emg|grf|forces?|moments?|torques?|cop|gravity|"
    r"angular|rotation|attitude|velocity|vel|quat(ernion)?|orient(ation)?|[agwm]",
    re.IGNORECASE,
)


def hold_channels(columns: Sequence[str]) -> bool:
    """Whether none of the columns is a coordinate of a joint or keypoint.

    Parameters
    ----------
    columns : sequence of str
        Their names.

    Returns
    -------
    bool

    Examples
    --------
    >>> hold_channels(["time", "acc_x", "acc_y"]), hold_channels(["time", "hip_x", "hip_y"])
    (True, False)
    """
    return not (is_pose_table(columns) or any(map(is_body, joint_names(columns))))


def is_body(name: str) -> bool:
    """Whether a name with coordinates is that of a joint, and not of a sensor."""
    words = re.findall(r"[A-Z]?[a-z]+\d*|[A-Z]+\d*(?![a-z])|\d+", name)
    return not any(_SENSOR.fullmatch(word) for word in words)
