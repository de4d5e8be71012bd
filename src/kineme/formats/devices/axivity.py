"""Read Axivity: acceleration in g exported by OmGui, with or without names, at dates."""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

_NUMBER = r" *-?\d+\.\d+"
_ROW = rf"\d{{4}}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{{3}}(?:,{_NUMBER}){{3}}\s*$"

DIALECT = Dialect(
    "Axivity",
    begins_with(rf"Time, *Accel-X \(g\),|{_ROW}"),
    layout=Layout(names=("time", "x", "y", "z"), clocks={"(?i)time": ""}),
)
