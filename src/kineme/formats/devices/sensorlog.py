"""Read SensorLog (iOS): names such as ``accelerometerAccelerationX(G)``, a clock per sensor."""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

_CLOCK = r"\w+Timestamp_since(?:Reboot|1970)\(s\)"

DIALECT = Dialect(
    "SensorLog",
    begins_with(rf"(?:logging(?:Time|Sample)\(\w+\)|{_CLOCK})[,;\t]"),
    layout=Layout(
        clocks={r"loggingTime\(txt\)": "", r"\w+_sinceReboot\(s\)": "s", _CLOCK: "s"},
        hidden=rf"loggingSample\(N\)|\w+\(txt\)|{_CLOCK}",
    ),
)
