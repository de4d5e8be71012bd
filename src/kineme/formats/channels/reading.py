"""From columns of numbers to signals: their rate, their holes, and what was inferred.

============== ==================================================================
CSV, TSV, text names in the first line, or numbers only (channels 1, 2, …);
               between commas, tabs, semicolons or blanks
Parquet        one channel per column
MOT, STO       OpenSim's coordinates, forces or other channels
C3D            the analog channels, or those of muscles, see `kineme.formats.markers.muscles`
MAT            vectors, and columns of matrices, of the length that most have
============== ==================================================================

The frame rate comes from the file (its own, or a column ``time``, ``time_ms``
or ``fps``, see `kineme.formats.columns`) or from the user. Columns that count
rows, and those that do not hold numbers, are no channels; this is said.
Channels with holes of up to 0.2 s are filled in a straight line; longer ones
are gaps of the recording.
"""

from __future__ import annotations

from kineme.formats.channels.gaps import without_gaps
from kineme.formats.channels.table import ChannelTable
from kineme.formats.files import FileContent
from kineme.recordings import Signals


def to_signals(content: FileContent, name: str, table: ChannelTable, fps: float | None) -> Signals:
    """The signals in a table of channels.

    Parameters
    ----------
    content : FileContent
        Where the table comes from.
    name : str
        Of the format.
    table : ChannelTable
    fps : float or None
        In place of what the table tells.

    Returns
    -------
    Signals

    Raises
    ------
    ReadError
        Nothing tells the frame rate, or holes leave nothing.
    """
    timing = table.timed(content, fps)
    values, gaps, filled = without_gaps(content, table.values, timing, table.names)
    provenance = content.provenance(name, [*table.notes, *timing.notes, *filled])
    return Signals(values, timing.fps, table.names, gaps, provenance.timed(timing.clock))
