"""Recognise the columns of tables of labels, which may have other usual names."""

from __future__ import annotations

import re
from collections.abc import Collection
from itertools import product

SPANS = (
    ("start_s", "stop_s"),
    ("start_frame", "stop_frame"),
    ("start_s", "duration_s"),
    ("start_ms", "stop_ms"),
    ("start_ms", "duration_ms"),
)
"""Pairs of columns that give the span of a label, preferred ones first."""
ALIASES = {
    "start": ("start", "begin", "onset", "start_time", "begin_time", "t_start", "from"),
    "stop": ("stop", "end", "offset", "stop_time", "end_time", "t_stop", "t_end", "to"),
    "duration": ("duration",),
    "label": ("label", "name", "activity", "trial_type"),
    "recording": ("recording", "file", "filename", "file_name"),  # a trial may be a number
}
"""Usual names of columns, preferred ones first, see `rename_columns`."""
FROM_TO = {"from", "to"}
"""Names of times only as a pair, and only if no other column gives a time."""
OTHER_TABLES = (
    {"level", "start_frame"},  # segment tables and manifests of clips
    {"file", "start", "stop"},  # clip lists, which count frames
    {"onset", "duration", "trial_type"},  # BIDS events
)
"""Columns of tables whose columns are not renamed."""


def rename_columns(names: Collection[str]) -> list[str]:
    """Replace usual names of columns by those of kineme; exact names take precedence.

    Examples
    --------
    >>> rename_columns(["File", "Start Time", "end (ms)", "activity", "Label"])
    ['recording', 'start_s', 'stop_ms', 'activity', 'label']
    """
    renamed = list(names)
    if any(needed <= set(names) for needed in OTHER_TABLES):
        return renamed
    has_span = any(set(pair) <= set(names) for pair in SPANS)
    found = []  # rank of the alias, position and new name
    times = {}  # usual names of times by position
    for (i, name), (column, aliases) in product(enumerate(names), ALIASES.items()):
        plain = re.sub(r"[\W_]+", "_", name.lower()).strip("_")
        base, _, unit = plain.rpartition("_")
        if unit not in ("s", "ms", "frame"):
            base, unit = plain, "s"
        is_time = column in ("start", "stop", "duration")
        if base in aliases and not (is_time and has_span):
            found.append((aliases.index(base), i, f"{column}_{unit}" if is_time else column))
            if is_time:
                times[i] = base
    others = FROM_TO if {*times.values()} != FROM_TO else set()
    for _, i, column in sorted(found):
        if column not in renamed and times.get(i) not in others:
            renamed[i] = column
    return renamed


def holds_spans(names: Collection[str]) -> bool:
    """Return whether columns, under these or other usual names, are spans with labels."""
    found = set(rename_columns(names))
    return any({*pair, "label"} <= found for pair in SPANS)
