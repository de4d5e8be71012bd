"""Read MetaMotion (MbientLab): one file per sensor, with the same time in three columns."""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

DIALECT = Dialect(
    "MetaMotion",
    begins_with(r"epoch? \(ms\),time"),
    layout=Layout(clocks={r"epoch? \(ms\)": "ms"}, hidden=r"time.*|elapsed \(s\)"),
)
