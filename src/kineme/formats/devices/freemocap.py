"""Read FreeMoCap: joints by trajectory, ``body_nose_x``, …, in millimetres with z up.

The column ``timestamp`` holds nanoseconds from an arbitrary start, or seconds in other versions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from kineme.formats.delimited import DelimitedText
from kineme.formats.dialects import Dialect
from kineme.formats.options import ReadOptions
from kineme.formats.points import columns_to_motion
from kineme.recordings import Motion
from kineme.recordings.column_names import group_axes

_BODY = "body_"
_OTHERS = ("left_hand_", "right_hand_", "face_")
_MIN_NANOSECONDS = 1e5  # larger steps of a clock are nanoseconds, not seconds


def recognises(names: Sequence[str], _: Sequence[str]) -> bool:
    """Return whether the columns are a time stamp and coordinates of ``body_`` joints."""
    return "timestamp" in names and f"{_BODY}nose" in group_axes(names)


def read(table: DelimitedText, options: ReadOptions) -> Motion:
    """Return the motion of the body's joints; those of hands and face are left out."""
    used = [
        i
        for i, name in enumerate(table.names)
        if name == "timestamp" or (name.startswith(_BODY) and name[-2:] in ("_x", "_y", "_z"))
    ]
    values = table.numbers(used)
    columns = {
        table.names[i].removeprefix(_BODY): column for i, column in zip(used, values.T, strict=True)
    }
    times = columns.pop("timestamp")
    if not options.fps:
        unit = "ns" if np.nanmedian(np.diff(times)) >= _MIN_NANOSECONDS else "s"
        columns[f"timestamp ({unit})"] = times
    options = replace(options, unit=options.unit or "mm", up=options.up or "z")
    has_others = any(name.startswith(_OTHERS) for name in table.names)
    notes = ["hands and face are left out"] if has_others else []
    return columns_to_motion(table.content, "FreeMoCap table", columns, options).noted(*notes)


DIALECT = Dialect("FreeMoCap", recognises, read, motion=True)
