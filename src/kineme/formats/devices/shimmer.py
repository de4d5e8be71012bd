"""Read Shimmer: Consensys writes a line of names and one of units, older programs four lines.

For each column the four lines hold the device, the signal, whether it is calibrated, and the unit.
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
    """Return the table below two or four lines; names include the device if there are several."""
    lines = text.lines
    if _recognise_names((), lines):
        return _CONSENSYS(text)
    signal_line = next(i for i, line in enumerate(lines) if line.startswith(("CAL", "RAW"))) - 1
    separator = find_separator(lines[signal_line])
    devices, signals = (
        split_cells(line, separator) for line in lines[signal_line - 1 : signal_line + 1]
    )
    if len(set(filter(None, devices))) > 1:
        signals = [" ".join(pair) for pair in zip(devices, signals, strict=False)]
    table = _FOUR_LINES(replace(text, lines=[separator.join(signals), *lines[signal_line + 1 :]]))
    return replace(table, lines=lines, head=signal_line, first_row=signal_line + table.first_row)


DIALECT = Dialect(
    "Shimmer",
    lambda names, lines: _recognise_names(names, lines) or _recognise_kinds(names, lines),
    layout=lay_out,
)
