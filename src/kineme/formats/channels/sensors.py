"""Whether columns are channels of sensors or coordinates of a body's joints, by their names.

A table whose columns are coordinates of joints is a motion. Sensors have
coordinates, too: ``acc_x``, ``gyro.y`` or ``ForceZ`` are told by their names.
"""

from __future__ import annotations

from collections.abc import Sequence

from kineme.formats.columns import joint_names
from kineme.formats.tables.pose_tables import is_pose_table
from kineme.recordings.coordinates import is_body


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
