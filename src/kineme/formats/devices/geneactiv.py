"""GENEActiv: lines ``Device Type,GENEActiv`` and more, then rows without names.

The thousandths of a second stand behind a colon, ``2026-05-07 23:59:57:500``.
"""

from __future__ import annotations

import re
from dataclasses import replace

from kineme.formats.delimited import DelimitedText
from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

_THOUSANDTHS = re.compile(r"(?<=^....-..-.. ..:..:..):(?=\d{3},)")
_LAYOUT = Layout(
    head=r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3},",
    names=("time", "x", "y", "z", "light", "button", "temperature"),
    clocks={"time": ""},
    rate=r"Measurement Frequency,(\d+(?:\.\d+)?)",
    hidden="light|button|temperature",
)


def lay_out(text: DelimitedText) -> DelimitedText:
    """Return the table, its times as ISO 8601 writes them."""
    lines = [_THOUSANDTHS.sub(".", line, count=1) for line in text.lines]
    return _LAYOUT(replace(text, lines=lines))


DIALECT = Dialect("GENEActiv", begins_with("Device Type,GENEActiv"), layout=lay_out)
