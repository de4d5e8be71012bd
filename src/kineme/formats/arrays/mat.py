"""MAT files of MATLAB: joint positions by variables, and QTM's exports.

Variables are arrays by name, see `kineme.formats.arrays.named_arrays`; also those inside a
structure, as long as it is the only one. Versions 5 to 7.2 are read as they are,
7.3 needs h5py.

QTM (Qualisys) exports a structure with ``FrameRate`` and
``Trajectories.Labeled.Data`` (markers, 4, frames), ``Labels``: millimetres, z up.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from kineme.formats.arrays.hdf5_file import SIGNATURE, parse_hdf5, texts
from kineme.formats.arrays.mat_file import parse_mat
from kineme.formats.arrays.named_arrays import Array, arrays_to_motion
from kineme.formats.files import Source
from kineme.formats.points import Points, to_motion
from kineme.formats.registry import Format, ReadOptions
from kineme.recordings.motion import Motion

_RATES = (
    "fps",
    "fs",
    "rate",
    "frame_rate",
    "framerate",
    "samplerate",
    "sampling_rate",
    "frequency",
)


def read_mat(source: Source, options: ReadOptions) -> Motion:
    """The motion in a MAT file."""
    variables = mat_variables(source)
    labeled = _labeled(variables)
    if labeled is not None:
        return _qtm_motion(source, *labeled, options)
    return arrays_to_motion(source, "MAT", arrays_of(variables), options)


def mat_variables(source: Source) -> dict[str, Any]:
    """The variables of a MAT file of either kind, by name."""
    is_hdf5 = source.data.startswith(SIGNATURE) or source.data[512:520] == SIGNATURE
    variables = parse_hdf5(source) if is_hdf5 else parse_mat(source)
    if not variables:
        raise source.error("no variable that can be read: tables and objects need writetable")
    return variables


def arrays_of(variables: Mapping[str, Any]) -> dict[str, Array]:
    """Numbers and texts as arrays; vectors and single numbers without MATLAB's other dimension."""
    inner = [value for value in variables.values() if isinstance(value, Mapping)]
    if len(inner) == 1:
        variables = {**inner[0], **variables}
    found: dict[str, Array] = {}
    for name, value in variables.items():
        if isinstance(value, np.ndarray) and value.dtype.kind in "iufb":
            single = value.ndim == 2 and 1 in value.shape
            found[name] = value.ravel() if single and value.size > 1 else value
            found[name] = found[name].reshape(()) if value.size == 1 else found[name]
        elif words := texts(value):
            found[name] = np.array(words)
    return found


def mat_channels(source: Source) -> tuple[dict[str, Array], float | None]:
    """(samples,) each: the channels by name, of whatever lengths; and their rate, if told.

    A matrix is a channel for each column, ``NAME_1`` and so on; its longer side is time.
    """
    arrays = arrays_of(mat_variables(source))
    rates = {name.lower(): array for name, array in arrays.items() if array.ndim == 0}
    rate = next((float(rates[key]) for key in _RATES if key in rates), None)
    found: dict[str, Array] = {}
    for name, array in arrays.items():
        if array.dtype.kind not in "iufb" or array.size == 0:
            continue
        if array.ndim == 1:
            found[name] = array
        elif array.ndim == 2:
            columns = array.T if len(array) >= array.shape[1] else array
            found |= {f"{name}_{i}": column for i, column in enumerate(columns, 1)}
    return found, rate


def _labeled(variables: Mapping[str, Any]) -> tuple[Mapping[str, Any], Mapping[str, Any]] | None:
    """QTM's structure, and the labelled trajectories in it."""
    for value in variables.values():
        inner = value
        for key in ("Trajectories", "Labeled"):
            inner = inner.get(key) if isinstance(inner, Mapping) else None
        if isinstance(inner, Mapping) and {"Data", "Labels"} <= inner.keys():
            return value, inner
    return None


def _qtm_motion(
    source: Source, head: Mapping[str, Any], labeled: Mapping[str, Any], options: ReadOptions
) -> Motion:
    names, data = texts(labeled["Labels"]), labeled["Data"]
    if not isinstance(data, np.ndarray) or data.dtype.kind not in "iuf" or data.ndim != 3:
        raise source.error("Trajectories.Labeled.Data are no numbers (markers, 4, frames)")
    if len(names) != data.shape[0] or data.shape[1] < 3 or 0 in data.shape:
        raise source.error(f"{len(names)} Labels for Data of shape {data.shape}")
    rate = head.get("FrameRate")
    fps = float(rate.ravel()[0]) if isinstance(rate, np.ndarray) and rate.size == 1 else 0.0
    if not options.fps and not (np.isfinite(fps) and fps > 0):
        raise source.error("no FrameRate in it: give fps= (--fps)")
    positions = np.asarray(data[:, :3], np.float64).transpose(2, 0, 1)
    unit, up = options.unit or "mm", options.up
    points = Points(names, positions, options.fps or fps, unit, up, usual_up="z")
    return to_motion(points, source.provenance("MAT of QTM", []))


FORMAT = Format("MAT", (".mat",), lambda head: head.startswith(b"MATLAB "), read_mat)
