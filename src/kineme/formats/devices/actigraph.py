"""ActiGraph: raw acceleration as ActiLife exports it.

The first line tells how the dates are written, ``date format dd/MM/yyyy``, and the rate. A table
without times follows ten lines of header at that rate.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from kineme.formats.delimited import DelimitedText
from kineme.formats.devices.device import Device
from kineme.formats.files import FileContent
from kineme.formats.sniffing import sniff

_HEADER = re.compile(r"data (?:table )?file created by actigraph\b", re.IGNORECASE)
_DATES = re.compile(
    r"date format (d+|M+|y+)[-/. ](?!\1)(d+|M+|y+)[-/. ](?!\1|\2)(d+|M+|y+)", re.IGNORECASE
)


def recognises(lines: Sequence[str]) -> bool:
    """Return whether the first line names ActiGraph as the maker of the file."""
    return bool(lines) and _HEADER.search(lines[0]) is not None


def find(content: FileContent) -> DelimitedText:
    """Return the table, its dates in the header's order."""
    table = sniff(content)
    order = _DATES.search(table.lines[0])
    if order is None:
        return table
    fields = "".join(order.groups()).lower()
    return replace(table, day_before_month=fields.find("d") < fields.find("m"))


DEVICE = Device("ActiGraph", recognises, find)
