"""Xsens MT Manager: text exports of one motion tracker.

Lines that begin with ``//`` stand above the names and tell the update rate. Columns of counters and
clocks may be empty, and some tell fields of a date: none of them is a channel, and the
rate is that of the header.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import islice

from kineme.formats.delimited import DelimitedText
from kineme.formats.devices.device import Device
from kineme.formats.files import FileContent
from kineme.formats.sniffing import HIGHEST, sniff

_CLOCK = re.compile(
    r"PacketCounter|SampleTime\w*|Year|Month|Day|Hour|Minute|Second|UTC_\w+|Status\w*|RSSI"
)
_NAMES = re.compile(r'"?PacketCounter\b')


def recognises(lines: Sequence[str]) -> bool:
    """Return whether comments stand above a line of names that begins with the packet counter."""
    if not lines or not lines[0].startswith("//"):
        return False
    head = next((line for line in islice(lines, HIGHEST) if not line.startswith("//")), "")
    return bool(_NAMES.match(head))


def find(content: FileContent) -> DelimitedText:
    """Return the table without its counters and clocks, at the rate of the header."""
    table = sniff(content)
    hidden = frozenset(name for name in table.names if _CLOCK.fullmatch(name))
    return replace(table, hidden=hidden, clocks={})


DEVICE = Device("Xsens MT Manager", recognises, find)
