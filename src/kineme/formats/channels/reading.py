"""Signals from files: tables, OpenSim's MOT and STO, analog channels of C3D, MAT files.

============== ==================================================================
CSV, TSV, text names in the first line, or numbers only (channels 1, 2, …);
               between commas, tabs, semicolons or blanks
Parquet        one channel per column
MOT, STO       OpenSim's coordinates, forces or other channels
C3D            the analog channels, or those of muscles, see `kineme.formats.channels.muscles`
MAT            vectors, and columns of matrices, of the length that most have
============== ==================================================================

The frame rate comes from the file (its own, or a column ``time``, ``time_ms``
or ``fps``, see `kineme.formats.columns`) or from the user. Columns that count
rows, and those that do not hold numbers, are no channels; this is said.

A table whose columns are coordinates of joints is a motion. Sensors have
coordinates, too: ``acc_x``, ``gyro.y`` or ``ForceZ`` are told by their names.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from kineme._checks import as_texts, check_path, is_number
from kineme.errors import FileError, ParameterError
from kineme.formats.channels.gaps import without_gaps
from kineme.formats.channels.tables import KINDS, kind_of, read_muscles
from kineme.formats.columns import joint_names
from kineme.formats.files import load
from kineme.formats.tables.pose_tables import is_pose_table
from kineme.recordings.signals import Signals

_SUFFIXES = (".csv", ".tsv", ".txt", ".dat", ".mot", ".sto", ".parquet")
_SENSOR = re.compile(
    r"acc(el\w*)?|gyr(o\w*)?|mag(net\w*)?|imu|emg|grf|forces?|moments?|torques?|cop|gravity|"
    r"angular|rotation|attitude|velocity|vel|quat(ernion)?|orient(ation)?|[agwm]",
    re.IGNORECASE,
)


def read_signals(
    path: str | PathLike[str],
    *,
    columns: Sequence[str] | None = None,
    fps: float | None = None,
    emg: bool = False,
) -> Signals:
    """The channels in a file, with what was inferred in their provenance.

    Channels with holes of up to 0.2 s are filled in a straight line; longer
    ones are gaps of the recording.

    Parameters
    ----------
    path : the file
    columns : the channels wanted, by name and in this order; all by default
    fps : frames per second, in place of the file's
    emg : of the analog channels of a C3D only those of muscles, where ``columns`` names none;
        their envelopes are `segment_signals`' part

    Raises
    ------
    ReadError : missing or damaged, no such channel, nothing that tells the frame rate,
        or, with ``emg``, which channels of a C3D are muscles
    MissingDependencyError : Parquet without pyarrow
    ParameterError : a frame rate that is not positive
    """
    check_path(path, "read_signals")
    if columns is not None:
        columns = as_texts(columns, "columns")
    if fps is not None and not (is_number(fps) and fps > 0):
        raise ParameterError(f"fps is {fps!r:.60}: give frames per second, above 0")
    source = load(path)
    if not source.data.strip():
        raise source.error("the file is empty")
    kind = kind_of(source)
    table = read_muscles(source) if emg and kind == "C3D" and columns is None else None
    table = table or KINDS[kind].read(source, columns)
    timing = table.timed(source, fps)
    values, gaps, filled = without_gaps(source, table.values, timing, table.names)
    provenance = source.provenance(kind, [*table.notes, *timing.notes, *filled])
    return Signals(values, timing.fps, table.names, gaps, provenance)


def is_signal_file(path: str | PathLike[str]) -> bool:
    """Whether a file holds channels without a skeleton.

    Yes for MOT and STO, and for tables without coordinates of joints or keypoints;
    no for anything else, files that cannot be read among them.
    """
    if Path(path).suffix.lower() not in _SUFFIXES:
        return False
    try:
        source = load(path)
        kind = kind_of(source)
        names = KINDS[kind].names(source)
    except FileError:
        return False
    bodies = is_pose_table(names) or any(map(_is_body, joint_names(names)))
    return kind == "MOT/STO" or not bodies


def _is_body(joint: str) -> bool:
    """Whether a name with coordinates is that of a joint, and not of a sensor."""
    words = re.findall(r"[A-Z]?[a-z]+\d*|[A-Z]+\d*(?![a-z])|\d+", joint)
    return not any(_SENSOR.fullmatch(word) for word in words)
