"""Read Xsens DOT, Movella DOT: lines on the sensor with ``OutputRate:,60Hz``, then the table."""

from __future__ import annotations

from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

DIALECT = Dialect(
    "Xsens DOT",
    begins_with(r"OutputRate:", within=10),
    layout=Layout(
        head="PacketCounter",
        rate=r"OutputRate:[,;\t ]*(\d+(?:\.\d+)?) *Hz",
        hidden=r"PacketCounter|SampleTimeFine|Status|(?:Clip|RSSI)\w*",
    ),
)
