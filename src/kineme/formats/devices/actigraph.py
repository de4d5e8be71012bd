"""ActiGraph: acceleration or counts as ActiLife exports them, below a header between dashes.

The header tells the rate and how dates are written, ``date format dd/MM/yyyy``. Counts have the
period of ``Epoch Period (hh:mm:ss) 00:01:00``, which is zero for acceleration. Names may be
missing.
"""

from __future__ import annotations

import re
from dataclasses import replace

from kineme.formats.delimited import DelimitedText
from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect
from kineme.formats.sniffing import HIGHEST

_HEADER = r"-* *Data (?:Table )?File Created By ActiGraph\b"
_DATES = re.compile(r"date format (d+|M+|y+)[-/. ](?!\1)(d+|M+|y+)[-/. ](?!\1|\2)(d+|M+|y+)")
_EPOCH = re.compile(r"Epoch Period \(hh:mm:ss\) (\d+):(\d+):(\d+)")
_LAYOUT = Layout(
    head=r"(?!-|Serial|Start|Epoch|Download|Current)",
    names=[f"Accelerometer {axis}" for axis in "XYZ"],
    clocks={"Timestamp|Time": ""},
    rate=r" at (\d+(?:\.\d+)?) Hz",
    hidden="Date",
)


def lay_out(text: DelimitedText) -> DelimitedText:
    """Return the table, its dates in the order of the header and at the rate of its epochs."""
    epochs = (_EPOCH.match(line) for line in text.lines[:HIGHEST])
    hours, minutes, seconds = next((map(int, each.groups()) for each in epochs if each), (0, 0, 0))
    period = 3600 * hours + 60 * minutes + seconds
    # the columns of counts are those that somebody chose
    table = replace(_LAYOUT, names=("1",))(text) if period else _LAYOUT(text)
    if order := _DATES.search(text.lines[0]):
        fields = "".join(order.groups()).lower()
        table = replace(table, day_before_month=fields.find("d") < fields.find("m"))
    return replace(table, rate=1 / period) if period else table


DIALECT = Dialect("ActiGraph", begins_with(_HEADER), layout=lay_out)
