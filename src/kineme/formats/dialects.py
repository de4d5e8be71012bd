"""Recognise and lay out tables that a specific program or device writes in its own way.

A table with named columns, including a time, needs no dialect. A dialect is recognised by the
column names or the first lines. It has a ``layout``, which locates the table and its columns, or
its own reader. Other packages register theirs as entry points of the group
``kineme.table_dialects``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from kineme._util.checks import Registry
from kineme.formats.delimited import DelimitedText
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.registry import recognises_safely
from kineme.formats.sniffing import sniff
from kineme.recordings import Motion, Signals
from kineme.recordings.column_names import group_axes, is_body


@dataclass(frozen=True)
class Dialect:
    """The way one program or device writes tables.

    Parameters
    ----------
    name : str
        Name shown to users.
    recognises : callable
        Takes the column names (as `sniff` finds them) and the lines of the file, and returns
        whether a table has this dialect. Tables that are not text have no lines.
    read : callable, optional
        Takes the table and `ReadOptions`, and returns the recording. By default the columns are
        read like those of any table. ``columns`` are then selected from the returned signals.
    channels : bool
        Whether channels can be requested.
    motion : bool
        Whether ``read`` always returns a motion. Requested channels are then columns of the table.
    layout : callable, optional
        Takes the table found by `sniff` and returns it with the columns of this program, like
        `kineme.formats.devices.Layout`.
    """

    name: str
    recognises: Callable[[Sequence[str], Sequence[str]], bool]
    read: Callable[[DelimitedText, ReadOptions], Motion | Signals] | None = None
    channels: bool = True
    motion: bool = False
    layout: Callable[[DelimitedText], DelimitedText] | None = None


DIALECTS: Registry[Dialect] = Registry(
    Dialect,
    "dialect of tables",
    "kineme.table_dialects",
    home="kineme.formats",
    builtins=(
        "devices.layouts:DIALECTS",
        "devices.actigraph:DIALECT",
        "devices.delsys:DIALECT",
        "devices.empatica:DIALECT",
        "devices.freemocap:DIALECT",
        "devices.geneactiv:DIALECT",
        "devices.opensignals:DIALECT",
        "devices.shimmer:DIALECT",
        "markers.capture_tables:DIALECTS",
        "keypoints.animals:DIALECTS",
        "keypoints.mediapipe:DIALECTS",
    ),
    newest_first=True,
)
"""Dialects in the order in which they are tried: those of other packages come first."""


def recognise_table(content: FileContent) -> tuple[DelimitedText, Dialect | None]:
    """Return the table in a text file, laid out by its dialect, and the dialect or None."""
    table = sniff(content)
    dialect = find_dialect(table.names, table.lines)
    if dialect and dialect.layout:
        table = dialect.layout(table)
        table = replace(table, notes=(f"read as {dialect.name} writes it", *table.notes))
    return table, dialect


def find_table(content: FileContent) -> DelimitedText:
    """Return the table in a text file, laid out by its dialect."""
    return recognise_table(content)[0]


def find_dialect(names: Sequence[str], lines: Sequence[str] = ()) -> Dialect | None:
    """Return the dialect of a table, given its column names and its lines, or None."""
    dialects = DIALECTS.values()
    return next(
        (d for d in dialects if recognises_safely(d.name, d.recognises, names, lines)), None
    )


def hold_channels(names: Sequence[str]) -> bool:
    """Return whether no column of a table is a coordinate of a joint or keypoint.

    A table of joint coordinates is a motion. Sensors have coordinates, too: ``acc_x``, ``gyro.y``
    or ``ForceZ`` are recognised by name.

    Examples
    --------
    >>> hold_channels(["time", "acc_x", "acc_y"]), hold_channels(["time", "hip_x", "hip_y"])
    (True, False)
    """
    dialect = find_dialect(names)
    has_reader = dialect is not None and dialect.read is not None
    return not has_reader and not any(map(is_body, group_axes(names)))
