"""Read Xsens MT Manager and MTw Awinda: text exports of one motion tracker.

Lines that start with ``//`` state the rate. Columns of counters and clocks may be empty, and others
hold parts of a date: none of them is a channel or a usable time.
"""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect
from kineme.formats.sniffing import MAX_HEADER_LINES

_has_comments = begins_with("//")
_has_counter = begins_with(r'"?(?:Packet)?Counter\b', within=MAX_HEADER_LINES)

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
