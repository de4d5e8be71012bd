"""Read tables of joint positions or channels (CSV, TSV, MOT, STO, Parquet), and write CSV.

`kineme.formats.delimited` parses text tables, `kineme.formats.points` names of joint columns, and
`kineme.formats.dialects` tables of specific programs. MOT and STO, OpenSim's tables of joint
angles, forces or other channels, hold no positions without their model. They are read as signals,
whatever their columns are called.

CSV files are written with ``time`` in seconds and ``JOINT_x JOINT_y JOINT_z`` in metres, y up,
empty in gaps; the skeleton is not written.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from kineme.formats.channels.parquet import (
    find_parquet_times,
    open_parquet,
    read_parquet_channels,
    read_parquet_columns,
    refuse_interleaved,
)
from kineme.formats.channels.reading import (
    describe_header_rate,
    read_text_channels,
    select_columns,
    to_signals,
)
from kineme.formats.channels.writing import write_signals
from kineme.formats.delimited import DelimitedText, as_text, make_unique_names
from kineme.formats.dialects import find_table, hold_channels, recognise_table
from kineme.formats.files import FileContent, clean_names, format_point_name, save
from kineme.formats.keypoints.poses import holds_poses, parse_poses, poses_to_motion
from kineme.formats.listing import refuse_labels
from kineme.formats.options import ReadOptions
from kineme.formats.plausibility import mark_gaps
from kineme.formats.points import columns_to_motion, is_used
from kineme.formats.registry import Format
from kineme.recordings import Motion, Signals
from kineme.recordings.cells import is_number
from kineme.recordings.column_names import EMPTY
from kineme.recordings.times import NO_TIMES, RATE, is_date, is_timing


def read_table(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """Return the joints or keypoints in a text table, or its channels if there are none."""
    refuse_labels(content)
    table, dialect = recognise_table(content)
    if options.channels and dialect and not dialect.channels:
        raise content.error(f"is a {dialect.name} table of joints, which is a motion")
    if dialect and dialect.read and not (options.channels and dialect.motion):
        recording = dialect.read(table, replace(options, columns=None))
        if not options.channels:
            return recording
        if isinstance(recording, Signals):
            names = recording.names
            chosen = select_columns(content, names, options.columns or None, names)
            return recording.select(chosen or names)
    elif not options.channels and not hold_channels(table.names):
        return _read_joints(table, options)
    channels = read_text_channels(table, options.columns or None)
    return to_signals(content, TABLE.name, channels, options.fps)


def read_mot(content: FileContent, options: ReadOptions) -> Signals:
    """Return the channels in a MOT or STO file."""
    channels = read_text_channels(find_table(content), options.columns or None)
    return to_signals(content, OPENSIM.name, channels, options.fps)


def read_parquet(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """Return the joint positions in a Parquet table, or its channels if there are none."""
    file = open_parquet(content)
    if holds_poses(file) and not options.channels:
        return poses_to_motion(content, parse_poses(content, file), options)
    stored_names = file.schema_arrow.names
    names = make_unique_names(stored_names)
    if options.channels or hold_channels(names):
        table = read_parquet_channels(content, file, options.columns or None)
        return to_signals(content, PARQUET.name, table, options.fps)
    refuse_interleaved(content, file)
    times = find_parquet_times(file)
    stored = [name for name in stored_names if name in times or is_used(name)]
    used = read_parquet_columns(content, file, stored)
    # Joints are found by name, so other columns are listed but not read.
    columns = dict.fromkeys(names, np.empty(0)) | {
        times.get(name, name): np.asarray(column.to_numpy())
        for name, column in zip(make_unique_names(used.column_names), used.columns, strict=True)
    }
    return columns_to_motion(content, PARQUET.name, columns, options)


def write_csv(motion: Motion, path: Path) -> None:
    """Write the joints' positions to a CSV file, in metres with y up."""
    joints = clean_names(
        path, motion.skeleton.names, lambda n: format_point_name(n.replace('"', "'"))
    )
    rate = [RATE] if motion.n_frames < 2 else []  # a single time defines no rate
    names = [*rate, "time", *(f"{joint}_{axis}" for joint in joints for axis in "xyz")]
    head = ",".join(f'"{name}"' if "," in name else name for name in map(as_text, names)) + "\n"
    first = "".join(f"{motion.fps!r}," for _ in rate)
    cells = 3 * len(joints)
    # Format strings are much faster than formatting each number.
    row = f"{first}%.9f{',%.9f' * cells}\n"
    empty = f"{first}%.9f{',' * cells}\n"
    values = motion.positions.reshape(motion.n_frames, -1).tolist()
    rows = zip(motion.times.tolist(), values, mark_gaps(motion), strict=True)
    save(path, [head, *(empty % t if gap else row % (t, *line) for t, line, gap in rows)])


def _read_joints(table: DelimitedText, options: ReadOptions) -> Motion:
    table.refuse_interleaved()
    names, content = table.names, table.content
    remarks = list(table.remarks)
    if options.fps is None and not table.times and table.rate:
        options = replace(options, fps=table.rate)
        remarks.append(describe_header_rate(table.rate))
    elif options.fps:
        content.choose_rate(options.fps, table.rate)  # warns if they differ
    # With a given rate, columns of times are not read.
    times = {} if options.fps else table.times
    used = [
        i
        for i, name in enumerate(names)
        if name in times or (is_used(name) and not is_timing(name))
    ]
    # Refuse a column of times that begins with something else, such as a frame's name.
    for i, cell in enumerate(table.first_cells):
        is_value = is_number(cell) or is_date(cell) or cell.lower() in EMPTY
        if i in used and is_timing(names[i]) and not is_value:
            reason = f"column {names[i]!r} {NO_TIMES}: give fps= (--fps)"
            raise content.error(reason, table.first_row + 1)
    values = table.numbers(used)
    columns = {
        times.get(names[i], names[i]): column for i, column in zip(used, values.T, strict=True)
    }
    return columns_to_motion(content, TABLE.name, columns, options).noted(*remarks)


TABLE = Format(
    "table", (".csv", ".tsv"), lambda _: False, read_table, write_csv, write_signals, channels=True
)
TEXT = replace(TABLE, name="text table", suffixes=(".txt", ".dat"), write=None)
OPENSIM = Format(
    "MOT/STO",
    (".mot", ".sto"),
    lambda head: b"\nendheader" in head.lower(),
    read_mot,
    write_signals=write_signals,
    channels=True,
)
PARQUET = Format(
    "Parquet table",
    (".parquet",),
    lambda head: head.startswith(b"PAR1"),
    read_parquet,
    write_signals=write_signals,
    channels=True,
)
FORMATS = (PARQUET, TABLE, TEXT, OPENSIM)
