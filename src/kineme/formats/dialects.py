"""Dialects of delimited text: tables of joints that one program writes in its own way.

A table whose columns are ``JOINT_x JOINT_y JOINT_z`` needs none, see `kineme.formats.columns`.
A dialect is told by the names of the columns or by the first lines, and has a reader of its
own. It is one module that ends in one `Dialect`. Other packages name theirs as entry points
of the group ``kineme.table_dialects``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from kineme._util.checks import Registry
from kineme.formats.columns import joint_names
from kineme.formats.delimited import DelimitedText
from kineme.formats.options import ReadOptions
from kineme.formats.registry import speaks
from kineme.recordings import Motion
from kineme.recordings.coordinates import is_body


@dataclass(frozen=True)
class Dialect:
    """How one program writes tables of joints.

    Parameters
    ----------
    name : str
        As people call it.
    recognises : callable
        From the names of the columns and the lines of the file to whether a table is of this
        dialect; there are no lines where a table is no text.
    read : callable
        From the table and `ReadOptions` to the motion in it.
    channels : bool
        Whether its columns can be read as channels, where these are asked for.
    """

    name: str
    recognises: Callable[[Sequence[str], Sequence[str]], bool]
    read: Callable[[DelimitedText, ReadOptions], Motion]
    channels: bool = True


DIALECTS: Registry[Dialect] = Registry(
    Dialect,
    "dialect of tables",
    "kineme.table_dialects",
    home="kineme.formats",
    builtins=(
        "markers.capture_tables:NEXUS",
        "markers.capture_tables:MOTIVE",
        "markers.capture_tables:QTM",
        "devices.freemocap:DIALECT",
        "keypoints.deeplabcut:DIALECT",
        "keypoints.sleap:DIALECT",
        "keypoints.mediapipe_tables:WIDE",
        "keypoints.mediapipe_tables:LONG",
    ),
    newest_first=True,
)
"""In the order in which they are tried: those of others ahead of the package's own."""


def dialect_of(names: Sequence[str], lines: Sequence[str] = ()) -> Dialect | None:
    """Return the dialect that a table is in, by its columns and by its lines where it is text.

    Or None.
    """
    dialects = DIALECTS.values()
    return next((d for d in dialects if speaks(d.name, d.recognises, names, lines)), None)


def hold_channels(names: Sequence[str], lines: Sequence[str] = ()) -> bool:
    """Return whether none of a table's columns is a coordinate of a joint or keypoint.

    A table whose columns are coordinates of joints is a motion. Sensors have coordinates, too:
    ``acc_x``, ``gyro.y`` or ``ForceZ`` are told by their names.

    Examples
    --------
    >>> hold_channels(["time", "acc_x", "acc_y"]), hold_channels(["time", "hip_x", "hip_y"])
    (True, False)
    """
    return dialect_of(names, lines) is None and not any(map(is_body, joint_names(names)))
