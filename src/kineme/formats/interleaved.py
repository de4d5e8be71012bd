"""Tables with several rows for one time: of several people, devices or joints in turn."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice, pairwise

from kineme.formats.columns import is_timing
from kineme.formats.files import FileContent
from kineme.formats.layout import cells_of

WHOSE = frozenset(
    {"person", "person_id", "subject", "participant", "individual", "track", "track_id"}
    | {"device", "device_id", "sensor", "sensor_id", "joint", "bodypart"}
)
"""Names of columns that tell whose a row is, in lower case."""

_FRAME = frozenset({"frame", "frame_id", "frame_idx"})
_LOOKED_AT = 50  # rows


def refuse_interleaved(
    content: FileContent, names: Sequence[str], rows: Sequence[str], separator: str
) -> None:
    """ReadError where rows of one time or frame are those of several people, devices or joints.

    Parameters
    ----------
    content : FileContent
    names : sequence of str
        Of the columns.
    rows : sequence of str
        The lines below.
    separator : str
        Between cells.
    """
    when = [i for i, name in enumerate(names) if is_timing(name) or name.lower() in _FRAME]
    whose = [i for i, name in enumerate(names) if name.lower() in WHOSE]
    if not (when and whose):
        return
    cells = [cells_of(row, separator) for row in islice(filter(str.strip, rows), _LOOKED_AT)]
    full = [row for row in cells if len(row) == len(names)]
    for one, other in pairwise(full):
        told = [i for i in whose if one[i] != other[i]]
        if told and all(one[i] == other[i] for i in when):
            k = told[0]
            raise content.error(
                f"rows of one time are told apart by column {names[k]!r} "
                f"({one[k]:.20}, {other[k]:.20}): give each a file or columns of its own"
            )
