"""Read MAT files of MATLAB: variables with joint positions, exports of QTM, or channels.

Variables are named arrays, see `kineme.formats.arrays.named_arrays`. If the file holds exactly one
structure, its fields count as variables. Versions 5 to 7.2 are read directly, 7.3 needs h5py.

QTM (Qualisys) exports a structure with ``FrameRate`` and ``Trajectories.Labeled.Data``
(markers, 4, frames) and ``Labels``, in millimetres with z up.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from kineme._util.arrays import Array
from kineme.formats.arrays.hdf5_file import SIGNATURE, collect_texts, parse_hdf5
from kineme.formats.arrays.mat_file import parse_mat
from kineme.formats.arrays.named_arrays import Arrays, arrays_to_motion
from kineme.formats.channels.reading import (
    ChannelTable,
    list_needed_columns,
    make_channel_table,
    select_columns,
    to_signals,
)
from kineme.formats.dialects import hold_channels
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.registry import Format
from kineme.recordings import Motion, Signals
from kineme.recordings.coordinates import is_body
from kineme.recordings.times import is_timing

_RATES = (
    "fps", "fs", "rate", "frame_rate", "framerate", "samplerate", "sampling_rate", "frequency",
)  # fmt: skip


def read_mat(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """Return the motion in a MAT file, or its channels if it holds no joints."""
    variables = read_variables(content)
    labeled = _find_labeled(variables)
    if labeled is not None and not options.channels:
        return _read_qtm(content, *labeled, options)
    arrays = to_arrays(variables)
    if options.channels or _hold_channels(arrays):
        table = arrays_to_channels(content, arrays, options.columns or None)
        return to_signals(content, "MAT", table, options.fps)
    return arrays_to_motion(content, "MAT", arrays, options)


def read_variables(content: FileContent) -> dict[str, Any]:
    """Return the variables of a MAT file of any version, by name."""
    # Version 7.3 puts a header of 512 bytes before the HDF5 signature.
    is_hdf5 = content.data.startswith(SIGNATURE) or content.data[512:520] == SIGNATURE
    variables = parse_hdf5(content) if is_hdf5 else parse_mat(content)
    if not variables:
        raise content.error(
            "it has no readable variable: export tables and objects with writetable"
        )
    return variables


def to_arrays(variables: Mapping[str, Any]) -> dict[str, Array]:
    """Return numbers and texts as arrays; drop MATLAB's second dimension of vectors and scalars."""
    structures = [value for value in variables.values() if isinstance(value, Mapping)]
    # The fields of a single structure count as variables.
    if len(structures) == 1:
        variables = {**structures[0], **variables}
    arrays: dict[str, Array] = {}
    for name, value in variables.items():
        if isinstance(value, np.ndarray) and value.dtype.kind in "iufb":
            # MATLAB has no vectors: they are matrices of one row or column.
            single = value.ndim == 2 and 1 in value.shape
            arrays[name] = value.ravel() if single and value.size > 1 else value
            arrays[name] = arrays[name].reshape(()) if value.size == 1 else arrays[name]
        elif words := collect_texts(value):
            arrays[name] = np.array(words)
    return arrays


def arrays_to_channels(
    content: FileContent, arrays: Arrays, columns: Sequence[str] | None
) -> ChannelTable:
    """Return the named channels in a MAT file's arrays, or those of the most frequent length.

    Each column of a matrix is a channel, ``NAME_1`` and so on; the longer side is time.
    """
    rates = {name.lower(): array for name, array in arrays.items() if array.ndim == 0}
    rate = next((float(rates[key]) for key in _RATES if key in rates), None)
    channels: dict[str, Array] = {}
    for name, array in arrays.items():
        if array.dtype.kind not in "iufb" or array.size == 0:
            continue
        if array.ndim == 1:
            channels[name] = array
        elif array.ndim == 2:
            tracks = array.T if len(array) >= array.shape[1] else array
            channels |= {f"{name}_{i}": track for i, track in enumerate(tracks, 1)}
    lengths = Counter(map(len, channels.values()))
    # The most frequent length; on a tie the longest.
    length = max(lengths, key=lambda n: (lengths[n], n), default=0)
    times = {name: name for name in channels if is_timing(name)}
    columns = select_columns(content, list(channels), columns, list(channels), times)
    if columns:
        length = len(channels[columns[0]])
    as_long = [name for name, channel in channels.items() if len(channel) == length]
    chosen = list_needed_columns(columns, as_long, times)
    for name in chosen:
        if name not in as_long:
            raise content.error(
                f"column {name!r} is not as long as {chosen[0]!r}: choose columns of one rate"
            )
    values = {name: np.asarray(channels[name], np.float64) for name in chosen}
    table = make_channel_table(content, as_long, values, columns, times)
    others = [name for name in channels if name not in as_long]
    if columns is None and others:
        note = f"left out, since their length differs: {', '.join(others)}"
        table = replace(table, notes=(*table.notes, note))
    has_rate = rate is not None and np.isfinite(rate) and rate > 0
    return replace(table, rate=rate) if has_rate else table


def _hold_channels(arrays: Arrays) -> bool:
    """Return whether no array holds positions of joints, by names and shapes."""
    if {"poses", "positions"} & arrays.keys():
        return False
    flat = [name for name, array in arrays.items() if array.ndim <= 1]
    tracks = (name for name, a in arrays.items() if a.ndim == 2 and a.shape[1] == 3)
    return hold_channels(flat) and not any(map(is_body, tracks))


def _find_labeled(
    variables: Mapping[str, Any],
) -> tuple[Mapping[str, Any], Mapping[str, Any]] | None:
    """Return QTM's structure and its labelled trajectories, or None."""
    for value in variables.values():
        item = value
        for key in ("Trajectories", "Labeled"):
            item = item.get(key) if isinstance(item, Mapping) else None
        if isinstance(item, Mapping) and {"Data", "Labels"} <= item.keys():
            return value, item
    return None


def _read_qtm(
    content: FileContent, head: Mapping[str, Any], labeled: Mapping[str, Any], options: ReadOptions
) -> Motion:
    names, data = collect_texts(labeled["Labels"]), labeled["Data"]
    if not isinstance(data, np.ndarray) or data.dtype.kind not in "iuf" or data.ndim != 3:
        raise content.error(
            "Trajectories.Labeled.Data must be numbers of shape (markers, 4, frames)"
        )
    if len(names) != data.shape[0] or data.shape[1] < 3 or 0 in data.shape:
        raise content.error(f"{len(names)} Labels for Data of shape {data.shape}")
    rate = head.get("FrameRate")
    fps = float(rate.ravel()[0]) if isinstance(rate, np.ndarray) and rate.size == 1 else 0.0
    if not options.fps and not (np.isfinite(fps) and fps > 0):
        raise content.error("it has no FrameRate: give fps= (--fps)")
    # Markers, axes, frames become frames, markers, axes; the fourth number is a residual.
    positions = np.asarray(data[:, :3], np.float64).transpose(2, 0, 1)
    points = Points(
        names,
        positions,
        options.fps or fps,
        options.unit,
        options.up,
        stated_unit="mm",
        usual_up="z",
        person=options.person,
    )
    return to_motion(points, content.provenance("MAT of QTM", []))


FORMAT = Format("MAT", (".mat",), lambda head: head.startswith(b"MATLAB "), read_mat, channels=True)
