"""Read phyphox: quoted names with their unit, the time in seconds first."""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

DIALECT = Dialect(
    "phyphox",
    begins_with(r'"Time \(s\)"[,;\t]"[^"]+ \([^"]+\)"'),
    layout=Layout(clocks={r"Time \(s\)": "s"}),
)
