"""Read GENEActiv: a header that starts with ``Device Type,GENEActiv``, then rows without names.

A colon precedes the milliseconds of times, ``2026-05-07 23:59:57:500``.
"""

from __future__ import annotations

import re
from dataclasses import replace

from kineme.formats.delimited import DelimitedText
from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

_MILLISECONDS = re.compile(r"(?<=^....-..-.. ..:..:..):(?=\d{3},)")
_LAYOUT = Layout(
    head=r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3},",
    names=("time", "x", "y", "z", "light", "button", "temperature"),
    clocks={"time": ""},
    rate=r"Measurement Frequency,(\d+(?:\.\d+)?)",
    hidden="light|button|temperature",
)


def lay_out(text: DelimitedText) -> DelimitedText:
    """Return the table with times in ISO 8601."""
    lines = [_MILLISECONDS.sub(".", line, count=1) for line in text.lines]
    return _LAYOUT(replace(text, lines=lines))


DIALECT = Dialect("GENEActiv", begins_with("Device Type,GENEActiv"), layout=lay_out)
