"""Tables of single devices and their programs: one module each, which ends in one `Device`.

A device is recognised by the lines of its file. It says where its table stands and what the
header tells of it, so that joints, channels, ``columns=`` and ``emg=`` are all read from the same
table. `find_table` asks the devices first; `sniff` is for files that no device claims.
"""

from __future__ import annotations

from kineme.formats.delimited import DelimitedText
from kineme.formats.devices import actigraph, empatica, xsens_mt_manager
from kineme.formats.files import FileContent
from kineme.formats.sniffing import sniff

DEVICES = (xsens_mt_manager.DEVICE, actigraph.DEVICE, empatica.DEVICE)
"""In the order in which they are tried."""


def find_table(content: FileContent) -> DelimitedText:
    """Return the table in a file of text, as its device writes it or as it looks."""
    lines = content.text.splitlines()
    device = next((each for each in DEVICES if each.recognises(lines)), None)
    return device.find(content) if device else sniff(content)
