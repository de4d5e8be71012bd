"""Read ActiGraph: acceleration or counts exported by ActiLife, below a header between dashes.

The header states the rate and the format of dates, ``date format dd/MM/yyyy``. Counts sum up the
activity in each epoch of a length, ``Epoch Period (hh:mm:ss) 00:01:00``, which is zero for raw
acceleration. Names may be missing.
"""

from __future__ import annotations

import re
from dataclasses import replace

from kineme.formats.delimited import DelimitedText
from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect
from kineme.formats.sniffing import MAX_HEADER_LINES

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
    """Return the table with the header's date format and, for counts, the rate of its epochs."""
    epochs = (_EPOCH.match(line) for line in text.lines[:MAX_HEADER_LINES])
    hours, minutes, seconds = next(
        (map(int, match.groups()) for match in epochs if match), (0, 0, 0)
    )
    epoch_s = 3600 * hours + 60 * minutes + seconds  # 0 for raw acceleration
    # Users choose the columns of counts. If no line names them, they are numbered from "1".
    table = replace(_LAYOUT, names=("1",))(text) if epoch_s else _LAYOUT(text)
    if date_format := _DATES.search(text.lines[0]):
        fields = "".join(date_format.groups()).lower()
        table = replace(table, day_before_month=fields.find("d") < fields.find("m"))
    return replace(table, rate=1 / epoch_s) if epoch_s else table


DIALECT = Dialect("ActiGraph", begins_with(_HEADER), layout=lay_out)
