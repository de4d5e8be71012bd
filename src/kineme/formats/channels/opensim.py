"""MOT and STO: OpenSim's tables of joint angles, forces or other channels.

They tell no positions without the model that they belong to, so they are
signals, whatever their columns are called.
"""

from __future__ import annotations

from kineme.formats.channels.reading import to_signals
from kineme.formats.channels.text import TextTable, text_channels
from kineme.formats.channels.writing import write_signals
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.recordings import Signals

NAME = "MOT/STO"


def read_mot(content: FileContent, options: ReadOptions) -> Signals:
    """The channels in a MOT or STO file."""
    table = text_channels(content, TextTable.of(content), options.columns or None)
    return to_signals(content, NAME, table, options.fps)


FORMAT = Format(
    NAME,
    (".mot", ".sto"),
    lambda head: b"\nendheader" in head.lower(),
    read_mot,
    write_signals=write_signals,
    channels=True,
)
