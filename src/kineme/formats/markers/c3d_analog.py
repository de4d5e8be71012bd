"""The analog channels of a C3D as signals: those wanted, those of muscles, or all."""

from __future__ import annotations

from kineme.formats.channels.reading import ChannelTable, asked_for, to_signals, wanted_columns
from kineme.formats.files import FileContent, unique
from kineme.formats.markers.c3d_file import parse_c3d
from kineme.formats.markers.muscles import muscles_of
from kineme.formats.options import ReadOptions
from kineme.recordings import Signals


def read_analog(content: FileContent, options: ReadOptions) -> Signals:
    """The analog channels of a C3D: ``options.columns``, or muscles with ``emg``, or all.

    Parameters
    ----------
    content : FileContent
    options : ReadOptions

    Returns
    -------
    Signals

    Raises
    ------
    ReadError
        It has none, or not those that were asked for.
    """
    file = parse_c3d(content)
    columns, notes = options.columns or None, []
    if options.emg and columns is None:
        columns, note = muscles_of(content, file)
        notes.append(note)
    if not file.analog.size:
        raise content.error("holds no analog channels")
    names = unique(file.analog_labels)
    wanted = wanted_columns(asked_for(content, names, columns, names), names)
    values = file.analog[:, [names.index(name) for name in wanted]]
    table = ChannelTable(wanted, values, {}, file.analog_rate or None, tuple(notes))
    return to_signals(content, "C3D", table, options.fps)
