"""Dialects of delimited text: tables that one program or device writes in its own way.

A table whose columns are named, with a time among them, needs none. A dialect is recognised by the
names of the columns or the first lines. It has a ``layout``, which says where the table stands and
what its columns are, or a reader of its own. It is one module that ends in one `Dialect`. Other
packages name theirs as entry points of the group ``kineme.table_dialects``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pkgutil import iter_modules

from kineme._util.checks import Registry
from kineme.formats import devices
from kineme.formats.columns import list_joints
from kineme.formats.delimited import DelimitedText
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.registry import recognises_safely
from kineme.formats.sniffing import sniff
from kineme.recordings import Motion, Signals
from kineme.recordings.coordinates import is_body


@dataclass(frozen=True)
class Dialect:
    """How one program or device writes tables.

    Parameters
    ----------
    name : str
        As people call it.
    recognises : callable
        From the names of the columns and the lines of the file to whether a table is of this
        dialect. The names are those that `sniff` finds. There are no lines where a table is no
        text.
    read : callable, optional
        From the table and `ReadOptions` to the recording in it. By default the columns are read
        as those of any table. ``columns`` are chosen from the signals that it returns.
    channels : bool
        Whether channels can be asked for.
    motion : bool
        Whether ``read`` always returns a motion. Channels are then the columns of the table.
    layout : callable, optional
        From the table as `sniff` finds it to the table as this program means it, such as
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
        # of each module in the folder
        *(f"devices.{module.name}:DIALECT" for module in iter_modules(devices.__path__)),
        "markers.capture_tables:NEXUS",
        "markers.capture_tables:MOTIVE",
        "markers.capture_tables:QTM",
        "keypoints.deeplabcut:DIALECT",
        "keypoints.sleap:DIALECT",
        "keypoints.mediapipe_tables:WIDE",
        "keypoints.mediapipe_tables:LONG",
    ),
    newest_first=True,
)
"""In the order in which they are tried: those of others ahead of the package's own."""


def recognise_table(content: FileContent) -> tuple[DelimitedText, Dialect | None]:
    """Return the table in a file of text, laid out as its dialect says, and the dialect if any."""
    table = sniff(content)
    dialect = find_dialect(table.names, table.lines)
    if dialect and dialect.layout:
        table = dialect.layout(table)
        table = replace(table, notes=(f"read as {dialect.name} writes it", *table.notes))
    return table, dialect


def find_table(content: FileContent) -> DelimitedText:
    """Return the table in a file of text, laid out as its dialect says."""
    return recognise_table(content)[0]


def find_dialect(names: Sequence[str], lines: Sequence[str] = ()) -> Dialect | None:
    """Return the dialect of a table, by its columns and its lines if it is text; or None."""
    dialects = DIALECTS.values()
    return next(
        (d for d in dialects if recognises_safely(d.name, d.recognises, names, lines)), None
    )


def hold_channels(names: Sequence[str], lines: Sequence[str] = ()) -> bool:
    """Return whether none of a table's columns is a coordinate of a joint or keypoint.

    A table whose columns are coordinates of joints is a motion. Sensors have coordinates, too:
    ``acc_x``, ``gyro.y`` or ``ForceZ`` are told by their names.

    Examples
    --------
    >>> hold_channels(["time", "acc_x", "acc_y"]), hold_channels(["time", "hip_x", "hip_y"])
    (True, False)
    """
    dialect = find_dialect(names, lines)
    has_reader = dialect is not None and dialect.read is not None
    return not has_reader and not any(map(is_body, list_joints(names)))
