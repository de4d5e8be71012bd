"""Read and write TRC: tables of markers of OpenSim and motion capture programs.

Three lines describe the file, two hold names. Each further line has the number of a frame, its time
and x, y, z of each marker, separated by tabs or commas. An empty cell is a marker not seen.
``DataRate`` is the frame rate; if the times contradict it, they are used, with a warning. A TRC has
a unit but no up axis: OpenSim's y is used if head and feet do not show it.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from kineme._util.arrays import Floats
from kineme.formats.delimited import DelimitedText, find_separator
from kineme.formats.files import (
    RATE_ROUNDING,
    FileContent,
    clean_names,
    format_point_name,
    parse_numbers,
    save,
)
from kineme.formats.options import ReadOptions
from kineme.formats.plausibility import mark_gaps, split_at
from kineme.formats.points import Points, to_motion
from kineme.formats.registry import Format
from kineme.formats.sniffing import find_timing, place_points
from kineme.formats.units import parse_unit
from kineme.recordings import Motion
from kineme.recordings.cells import replace_decimal_comma
from kineme.recordings.regular import Timing

_MM = 0.001
_HEADER_LINES = 5


def read_trc(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of the markers in a TRC file."""
    lines = content.text.splitlines()
    if len(lines) <= _HEADER_LINES:
        raise content.error("the file ends within its five header lines and has no motion")
    separator = find_separator(lines[3])
    row = next(filter(str.strip, lines[_HEADER_LINES:]), "")
    names = _name_markers(lines[3].split(separator)[2:], len(row.split(separator)) - 2)
    if not names:
        raise content.error("no marker is named after 'Frame#' and 'Time'", 4)
    # Frame and time precede x, y, z of each marker.
    columns = ["frame", "seconds", *(f"{name}_{axis}" for name in names for axis in "xyz")]
    text = DelimitedText(
        content, lines, names=columns, head=3, first_row=_HEADER_LINES, separator=separator
    )
    table = text.numbers()
    head = _parse_header(lines[1], lines[2], find_separator(lines[1]))
    declared = head.get("NumFrames", "")
    if declared.isdigit() and int(declared) != len(table):
        content.warn(f"{declared} frames declared, {len(table)} found and kept", 3)
    positions = table[:, 2:].reshape(len(table), -1, 3)
    timing = _find_timing(content, options, head, table[:, 1])
    positions, gaps = place_points(timing, positions)
    unit = options.unit or ("pixel" if _is_image(content, head, positions) else None)
    points = Points(
        names,
        positions,
        timing.fps,
        unit,
        options.up,
        stated_unit=parse_unit(head.get("Units", "")),
        person=options.person,
    )
    notes = [*timing.notes, *text.remarks]
    provenance = content.provenance("TRC", notes).timed(timing.clock, timing.row_seconds)
    return split_at(to_motion(points, provenance), gaps)


def _is_image(content: FileContent, head: dict[str, str], positions: Floats) -> bool:
    """Return whether positions are pixels: flat, and so named in the header or the file's name.

    Sports2D writes metres above pixels, and names the file ``NAME_px_person00.trc``.
    """
    is_flat = not np.nanmax(np.abs(positions[..., 2]), initial=0.0)
    words = [head.get("Units", "").lower(), *re.split(r"[\W_]", Path(content.path).stem.lower())]
    return is_flat and not {"px", "pixel", "pixels"}.isdisjoint(words)


def write_trc(motion: Motion, path: Path) -> None:
    """Write the joints' positions to a TRC file in millimetres; cells in gaps are empty."""
    names = clean_names(path, motion.skeleton.names, format_point_name)
    n, m = motion.n_frames, len(names)
    fps = f"{motion.fps!r}"
    head = (
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}\n"
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\t"
        "OrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
        f"{fps}\t{fps}\t{n}\t{m}\tmm\t{fps}\t1\t{n}\n"
        "Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t\n"
        "\t\t" + "\t".join(f"{axis}{i}" for i in range(1, m + 1) for axis in "XYZ") + "\n\n"
    )
    row = "%d\t%.9f" + "\t%.6f" * (3 * m) + "\n"
    empty = "%d\t%.9f" + "\t" * (3 * m) + "\n"
    values = zip((motion.positions / _MM).reshape(n, -1).tolist(), mark_gaps(motion), strict=True)
    lines = (
        empty % (i + 1, i / motion.fps) if gap else row % (i + 1, i / motion.fps, *line)
        for i, (line, gap) in enumerate(values)
    )
    save(path, [head, *lines])


def _name_markers(cells: list[str], width: int) -> list[str]:
    """Return one name for each three of the ``width`` columns of coordinates.

    Programs write a varying number of tabs between names. If there is a name for every marker,
    their order assigns them; otherwise every third cell has a name, or is blank for a nameless
    marker.
    """
    names = [cell.strip() for cell in cells if cell.strip()]
    if names and 0 <= width - 3 * len(names) <= 1:  # a row may end with a separator
        return names
    # Use every third cell, without blank ones at the end.
    triples = [cells[i].strip() for i in range(0, len(cells), 3)]
    while triples and not triples[-1]:
        triples.pop()
    return [name or f"marker{i}" for i, name in enumerate(triples, 1)]


def _parse_header(keys: str, values: str, separator: str) -> dict[str, str]:
    pairs = zip(keys.split(separator), values.split(separator), strict=False)
    return {key.strip(): value.strip() for key, value in pairs}


def _find_timing(
    content: FileContent, options: ReadOptions, head: dict[str, str], times: Floats
) -> Timing:
    """Return the rate and frames of rows: of the options, the header or the times."""
    try:
        (declared,) = parse_numbers([replace_decimal_comma(head.get("DataRate", ""))])
    except ValueError:
        declared = 0.0
    if options.fps:
        return Timing(content.choose_rate(options.fps, declared))
    if declared > 0 and (len(times) < 2 or np.isnan(times).any()):
        return Timing(declared)
    timing = find_timing(content, times)
    fps = timing.fps
    # Prefer the declared rate if the times agree up to rounding.
    if abs(fps - declared) <= RATE_ROUNDING * fps:
        return replace(timing, fps=declared) if timing.order is None else timing
    if declared > 0:
        content.warn(f"DataRate is {declared:g}, but the times give {fps:g} Hz, which is used")
    return timing


FORMAT = Format(
    "TRC", (".trc",), lambda head: head.lstrip().startswith(b"PathFileType"), read_trc, write_trc
)
