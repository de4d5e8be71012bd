"""Shimmer: Consensys writes a line of names and one of units, older programs four lines.

The four are the device, the signal, whether it is calibrated, and the unit, for each column.
"""

from __future__ import annotations

from dataclasses import replace

from kineme.formats.delimited import DelimitedText, find_separator, split_cells
from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect

_OTHERS = r".*(?:Timestamp|Battery|Packet_Reception|Event_Marker).*"
_CONSENSYS = Layout(
    words=1,
    clocks={r"\w*Timestamp(?:Sync)?(?:_Unix)?_CAL": "ms", r"\w*Timestamp\w*Formatted\w*": ""},
    hidden=_OTHERS,
)
_FOUR_LINES = Layout(words=2, clocks={".*Timestamp": "ms"}, hidden=_OTHERS)
_recognise_names = begins_with(r'"?\w*Timestamp\w*_(?:CAL|RAW)\b')
_recognise_kinds = begins_with(r"(?:CAL|RAW)[\t,;](?:CAL|RAW)\b", within=3)


def lay_out(text: DelimitedText) -> DelimitedText:
    """Return the table below two lines or four; several devices are part of the names."""
    lines = text.lines
    if _recognise_names((), lines):
        return _CONSENSYS(text)
    at = next(i for i, line in enumerate(lines) if line.startswith(("CAL", "RAW"))) - 1
    separator = find_separator(lines[at])
    devices, signals = (split_cells(line, separator) for line in lines[at - 1 : at + 1])
    if len(set(filter(None, devices))) > 1:
        signals = [" ".join(pair) for pair in zip(devices, signals, strict=False)]
    table = _FOUR_LINES(replace(text, lines=[separator.join(signals), *lines[at + 1 :]]))
    return replace(table, lines=lines, head=at, below=at + table.below)


DIALECT = Dialect(
    "Shimmer",
    lambda names, lines: _recognise_names(names, lines) or _recognise_kinds(names, lines),
    layout=lay_out,
)
