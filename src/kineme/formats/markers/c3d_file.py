"""The layout of C3D files: header, parameters, then points and analog samples frame by frame.

Blocks are of 512 bytes. Integers and floats are those of the processor that the
parameter section names: Intel, DEC or MIPS (SGI). A frame holds four numbers
for each point, x, y, z and its residual (below zero: not seen), and then
the analog samples; all are 16-bit integers to be scaled, or floats where the
scale is below zero. A point exactly at the origin was not seen either: programs
without residuals write that.

Counts that outgrow 16 bits stand in several places, of which any may be wrong
or saturated. Frames: the largest of the counts given that the file has room
for. Labels beyond the 255th: in LABELS2, LABELS3 and so on. A parameter may be
an integer where the manual has a float, and the other way round.

Nothing is allocated that the file does not hold.

Why this is no wrapper of ezc3d, with which the tests compare it: a damaged
file makes that library end the whole process, and it does not read MIPS files.

Source: Motion Lab Systems, "The C3D file format: a technical user guide" (2021).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

import numpy as np
from numpy.typing import NDArray

from kineme.formats.files import FileContent
from kineme.formats.markers.c3d_layout import Layout, Stored, read_header
from kineme.formats.markers.c3d_parameters import (
    Parameters,
    as_float32,
    number_type,
    read_parameters,
    string,
)

Floats = NDArray[np.float64]
_HEADER_EVENTS = 12345  # marks a header whose events have labels of four letters


@dataclass(frozen=True)
class C3D:
    """What a C3D file holds.

    Parameters
    ----------
    labels : list of str
        One per point.
    points : ndarray of shape (frames, points, 3)
        In ``unit``, NaN where not seen.
    rate : float
        Frames per second, 0 if the file has none.
    first_frame : int
        The number of the first frame, counted from 1.
    analog : ndarray of shape (samples, channels)
        Scaled.
    analog_labels, analog_units : list of str
        One per channel.
    analog_rate : float
        Samples per second.
    events : tuple of (float, str)
        Second from the first frame, and label.
    parameters : Parameters
        Everything in the parameter section.
    """

    labels: list[str]
    points: Floats
    rate: float
    first_frame: int
    analog: Floats
    analog_labels: list[str]
    analog_units: list[str]
    analog_rate: float
    events: tuple[tuple[float, str], ...]
    parameters: Parameters


def parse_c3d(content: FileContent) -> C3D:
    """The contents of a C3D file.

    Raises
    ------
    ReadError
        It is no C3D file, or holds less than one frame.
    """
    parameters = read_parameters(content)
    file = Layout(content, parameters, read_header(content, parameters))
    raw = file.frames()
    n = file.n_points
    points, seen = _points(raw[:, : 4 * n].reshape(len(raw), n, 4), file.scale)
    points[~seen] = np.nan
    analog = _analog(file, raw[:, 4 * n :])
    return C3D(
        labels=_labels(parameters, "POINT", n, "point"),
        points=points,
        rate=file.rate,
        first_frame=file.first_frame,
        analog=analog,
        analog_labels=_labels(parameters, "ANALOG", analog.shape[1], "channel"),
        analog_units=_padded(parameters.strings("ANALOG", "UNITS"), analog.shape[1]),
        analog_rate=file.rate * len(analog) / len(raw),
        events=_events(file),
        parameters=parameters,
    )


def _analog(file: Layout, raw: Stored) -> Floats:
    """(samples, channels): what follows the points in each frame, scaled."""
    total = raw.shape[1]
    per_frame = file.header.samples_per_frame or 1
    channels = int(file.parameters.number("ANALOG", "USED", total // per_frame))
    if channels <= 0 or total % channels:
        return np.empty((0, 0))
    values = raw.reshape(-1, channels)
    if "UNSIGNED" in file.parameters.strings("ANALOG", "FORMAT") and values.dtype.kind == "i":
        values = values.view(values.dtype.str.replace("i", "u"))
    scale = _per_channel(file.parameters, "SCALE", channels, 1.0)
    scale *= file.parameters.number("ANALOG", "GEN_SCALE", 1.0)
    scaled = (values - _per_channel(file.parameters, "OFFSET", channels, 0.0)) * scale
    return np.asarray(scaled, np.float64)


def _per_channel(parameters: Parameters, name: str, channels: int, usual: float) -> Floats:
    given = parameters.numbers("ANALOG", name, signed=True)[:channels]
    return np.array(given + [usual] * (channels - len(given)))


def _events(file: Layout) -> tuple[tuple[float, str], ...]:
    """Those of the EVENT group, else those of the header; times count from frame 1."""
    if file.rate == 0:
        return ()
    skipped = (file.first_frame - 1) / file.rate
    found = _group_events(file.parameters) or _header_events(file)
    return tuple(sorted((round(t - skipped, 6), label) for t, label in found if np.isfinite(t)))


def _group_events(parameters: Parameters) -> list[tuple[float, str]]:
    used = int(parameters.number("EVENT", "USED", 0))
    times = parameters.numbers("EVENT", "TIMES")
    labels = parameters.strings("EVENT", "LABELS")
    contexts = _padded(parameters.strings("EVENT", "CONTEXTS"), len(labels))
    names = [f"{who} {label}".strip() for who, label in zip(contexts, labels, strict=False)]
    minutes = zip(times[::2], times[1::2], strict=False)
    return [(60 * m + s, name) for (m, s), name in zip(minutes, names, strict=False)][:used]


def _header_events(file: Layout) -> list[tuple[float, str]]:
    data, kind = file.content.data, file.parameters.processor
    marker, n = np.frombuffer(data, number_type(kind, real=False), 2, 2 * 149).tolist()
    if marker != _HEADER_EVENTS:
        return []
    words = np.frombuffer(data, number_type(kind, real=True), 18, 2 * 152)
    times = as_float32(words, kind).tolist()
    labels = [string(data[at : at + 4]) for at in range(2 * 198, 2 * 198 + 72, 4)]
    return list(zip(times, labels, strict=True))[: max(n, 0)]


def _points(quads: Stored, scale: float) -> tuple[Floats, NDArray[np.bool_]]:
    """Positions (frames, points, 3), and where they were seen."""
    positions = quads[:, :, :3].astype(np.float64)
    if quads.dtype.kind == "i":
        positions *= scale
    seen = (quads[:, :, 3] >= 0) & np.isfinite(positions).all(axis=2)
    return positions, seen & positions.any(axis=2)


def _labels(parameters: Parameters, group: str, n: int, usual: str) -> list[str]:
    labels = list(parameters.strings(group, "LABELS"))
    for number in count(2):
        more = parameters.strings(group, f"LABELS{number}")
        if not more or len(labels) >= n:
            break
        labels += more
    return [label or f"{usual}{i}" for i, label in enumerate(_padded(labels, n), 1)]


def _padded(labels: list[str], n: int) -> list[str]:
    return labels[:n] + [""] * (n - len(labels))
