"""Read BioStamp (MC10): one file per sensor, times in milli- or microseconds since 1970."""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

DIALECT = Dialect(
    "BioStamp",
    begins_with(r"Timestamp \((?:ms|microseconds)\),(?:Accel|Gyro|Sample)\b"),
    layout=Layout(clocks={r"Timestamp \(ms\)": "ms", r"Timestamp \(microseconds\)": "us"}),
)
