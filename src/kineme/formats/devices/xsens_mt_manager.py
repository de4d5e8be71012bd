"""Xsens MT Manager and MTw Awinda: text exports of one motion tracker.

Lines that begin with ``//`` tell the rate. Columns of counters and clocks may be empty, and some
tell fields of a date: none of them is a channel or tells the time.
"""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect
from kineme.formats.sniffing import HIGHEST

_has_comments = begins_with("//")
_has_counter = begins_with(r'"?(?:Packet)?Counter\b', within=HIGHEST)

DIALECT = Dialect(
    "Xsens MT Manager",
    lambda names, lines: _has_comments(names, lines) and _has_counter(names, lines),
    layout=Layout(
        head=r"(?!//)",
        rate=r"(?:Update|Sample) [Rr]ate: *(\d+(?:\.\d+)?)",
        hidden=r"(?:Packet)?Counter|SampleTimeFine|Year|Month|Day|Hour|Minute|Second|UTC_\w+"
        r"|Status\w*|RSSI",
    ),
)
