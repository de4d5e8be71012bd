"""Read Sensor Logger (Android, iOS): one file per sensor, ``time`` in nanoseconds since 1970."""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

DIALECT = Dialect(
    "Sensor Logger",
    begins_with(r"time,seconds_elapsed,"),
    layout=Layout(clocks={"time": "ns"}, hidden="seconds_elapsed"),
)
