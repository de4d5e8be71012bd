"""Read tables of capture programs: Vicon's Nexus, OptiTrack's Motive, Qualisys' QTM.

Each name stands above three columns ``X,Y,Z``.

- Nexus: a line ``Trajectories``, the rate, names such as ``Ann:LASI``, ``Frame,Sub Frame,X,Y,Z,…``,
  the units, then a row per frame up to a blank line. Devices and model outputs are in sections of
  their own, which are skipped.
- Motive: a line ``Format Version,…`` with the rate, the unit and other metadata. Below it are the
  kinds of the columns (markers, bones, rigid bodies), their names, further lines, and whether they
  are positions or rotations. Markers are read if there are at least as many named ones as bones or
  rigid bodies, otherwise those.
- QTM: lines ``NO_OF_FRAMES``, ``FREQUENCY``, ``MARKER_NAMES`` and others, each with its value after
  a tab; then optionally a line ``Frame, Time, LASI X, …``, and rows in millimetres. A marker
  exactly at the origin was not seen.

Markers without a name are left out if others have one. An empty cell is a marker not seen.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from kineme._util.checks import format_count
from kineme.formats.delimited import DelimitedText, find_separator, split_cells
from kineme.formats.dialects import Dialect
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.units import parse_unit
from kineme.recordings import Motion
from kineme.recordings.cells import is_number
from kineme.recordings.joint_names import is_nameless

CHAPTERS = ("trajectories", "devices", "model outputs", "joints", "segments", "events")
"""First lines of Nexus's tables, in lower case."""

_MARKERS = re.compile(r'[ ",;\t]*trajectories[ ",;\t]*', re.IGNORECASE)


@dataclass(frozen=True)
class Capture:
    """Positions of the columns of a table, and its metadata."""

    cells: Sequence[str]  # one per column
    separator: str
    first_row: int  # index of a line
    columns: dict[str, int]  # column of x of each point; y and z follow
    rate: str  # as written
    unit: str  # as written


def is_nexus(_: Sequence[str], lines: Sequence[str]) -> bool:
    """Return whether a file is Nexus's with trajectories; tables of devices are ordinary ones."""
    return _find_first_line(lines) in CHAPTERS and any(map(_MARKERS.fullmatch, lines))


def is_motive(_: Sequence[str], lines: Sequence[str]) -> bool:
    """Return whether a file is Motive's."""
    return _find_first_line(lines).startswith("format version,")


def is_qtm(_: Sequence[str], lines: Sequence[str]) -> bool:
    """Return whether a file is QTM's table of markers."""
    return _find_first_line(lines).startswith("no_of_frames") and "MARKER_NAMES" in _parse_header(
        lines
    )


def read_capture(
    table: DelimitedText,
    options: ReadOptions,
    *,
    program: str,
    look: Callable[[FileContent, Sequence[str]], Capture],
    usual_up: str = "z",
) -> Motion:
    """Return the motion of the markers in a table, whose structure ``look`` finds."""
    content, lines = table.content, table.lines
    capture = look(content, lines)
    columns = capture.columns
    names = [name for name in columns if not is_nameless(name)] or [*columns]
    chosen = [columns[name] + axis for name in names for axis in range(3)]
    first_row = capture.first_row
    # A blank line ends the section.
    rows_below = range(first_row, len(lines))
    end = next((i for i in rows_below if not lines[i].strip(" ,;\t")), None)
    rows = DelimitedText(
        content, lines[:end], capture.cells, first_row - 1, first_row, capture.separator
    )
    # Axes: frames, markers, coordinates.
    values = rows.numbers(chosen).reshape(-1, len(names), 3)
    if program == "QTM":
        values[(values == 0).all(axis=2)] = np.nan
    notes = list(rows.remarks)
    if n_left_out := len(columns) - len(names):
        notes.append(f"{format_count(n_left_out, 'point')} without a name left out")
    points = Points(
        names,
        values,
        _parse_rate(content, capture, options.fps),
        options.unit,
        options.up,
        stated_unit=parse_unit(capture.unit),
        usual_up=usual_up,
        person=options.person,
    )
    return to_motion(points, content.provenance(f"{program} table", notes))


def _find_first_line(lines: Sequence[str]) -> str:
    first = next(filter(str.strip, lines), "")
    return first.lower().strip(' "\r,;\t')


def _parse_nexus(content: FileContent, lines: Sequence[str]) -> Capture:
    """Return where the markers, rate and unit are in an export of Nexus."""
    at = next(i for i, line in enumerate(lines) if _MARKERS.fullmatch(line))
    axes = _find_axis_line(content, lines, at)
    if axes < at + 3 or axes + 1 >= len(lines):
        raise content.error("rate and names expected under 'Trajectories', units under 'Frame'")
    separator = find_separator(lines[axes])
    names = split_cells(lines[axes - 1], separator)
    cells = split_cells(lines[axes], separator)
    columns = _find_columns(content, names, cells, axes)
    below = split_cells(lines[axes + 1], separator)
    units = [cell for first in columns.values() for cell in below[first : first + 3] if cell]
    if len(set(units)) > 1:
        listed = " and ".join(sorted(set(units)))
        raise content.error(f"markers are in {listed}: export all of them in one unit", axes + 2)
    rate, unit = split_cells(lines[at + 1], separator)[0], units[0] if units else ""
    return Capture(cells, separator, first_row=axes + 2, columns=columns, rate=rate, unit=unit)


def _parse_motive(content: FileContent, lines: Sequence[str]) -> Capture:
    """Return where the markers, rate and unit are in an export of Motive."""
    axes = _find_axis_line(content, lines, 0)
    separator = find_separator(lines[axes])
    above = [split_cells(line, separator) for line in lines[:axes] if line.strip(' ",;\t')]
    # Names and values of the metadata alternate.
    pairs = zip(above[0][::2], above[0][1::2], strict=False)
    metadata = {key.lower(): value for key, value in pairs}
    if len(above) < 4:
        raise content.error("kinds, names and 'Position' expected above the axes", axes + 1)
    kinds, names, quantity_names = above[1], above[2], above[-1]
    kinds = [kind.lower() for kind in kinds]
    points = _find_point_kinds(kinds, names)
    cells = split_cells(lines[axes], separator)
    position_axes = [
        axis if kind in points and quantity.lower() == "position" else ""
        for axis, kind, quantity in zip(cells, kinds, quantity_names, strict=False)
    ]
    columns = _find_columns(content, names, position_axes, axes)
    rate = metadata.get("export frame rate") or metadata.get("capture frame rate", "")
    unit = metadata.get("length units", "")
    return Capture(cells, separator, first_row=axes + 1, columns=columns, rate=rate, unit=unit)


def _find_point_kinds(kinds: Sequence[str], names: Sequence[str]) -> set[str]:
    """Return the kind of columns that hold the body.

    A body has more markers than bones. If there are fewer, they are stray markers. Markers without
    a name and markers of a rigid body, ``Hips:Marker1``, do not count: they add nothing to it.
    """
    names_by_kind: dict[str, set[str]] = {}
    for kind, name in zip(kinds, names, strict=False):
        names_by_kind.setdefault(kind, set()).add(name)
    rigid = names_by_kind.get("rigid body", set())
    markers = {
        name
        for name in names_by_kind.get("marker", set())
        if not is_nameless(name) and name.rpartition(":")[0] not in rigid
    }
    bone_kind = next((kind for kind in ("bone", "rigid body") if kind in names_by_kind), None)
    if "marker" in names_by_kind and (
        bone_kind is None or len(markers) >= len(names_by_kind[bone_kind])
    ):
        return {"marker"}
    return {bone_kind} if bone_kind else set(kinds)


def _parse_qtm(content: FileContent, lines: Sequence[str]) -> Capture:
    """Return where the markers and rate are in an export of QTM."""
    metadata = _parse_header(lines)
    names = metadata["MARKER_NAMES"]
    below = next((i for i, line in enumerate(lines) if is_number(line.split("\t")[0])), len(lines))
    cells = lines[below].split("\t") if below < len(lines) else []
    # Frame and time come first; a row may end with a tab.
    has_times = len(cells) >= 3 * len(names) + 2
    columns = {name: 3 * i + 2 * has_times for i, name in enumerate(names)}
    if len(cells) < 3 * len(names):
        raise content.error(f"{len(cells)} columns for {len(names)} markers", below + 1)
    numbered = [str(i) for i in range(3 * len(names) + 2 * has_times)]
    rate = "".join(metadata.get("FREQUENCY", []))
    return Capture(numbered, "\t", first_row=below, columns=columns, rate=rate, unit="mm")


def _parse_header(lines: Sequence[str]) -> dict[str, list[str]]:
    """Return the values in the lines at the top of QTM's table, by their names."""
    metadata: dict[str, list[str]] = {}
    for line in lines:
        name, *values = line.rstrip().split("\t")
        if not name.isupper():
            break
        metadata[name] = values
    return metadata


def _find_axis_line(content: FileContent, lines: Sequence[str], start: int) -> int:
    for i in range(start, min(start + 12, len(lines))):
        if lines[i].strip(' "').lower().startswith("frame"):
            return i
    raise content.error("no line with 'Frame' and the axes of the columns found", start + 1)


def _find_columns(
    content: FileContent, names: Sequence[str], axes: Sequence[str], line: int
) -> dict[str, int]:
    """Return the column of x of each point that is followed by y and z."""
    columns: dict[str, int] = {}
    for i, name in enumerate(names):
        if name and [cell.lower() for cell in axes[i : i + 3]] == ["x", "y", "z"]:
            columns.setdefault(name, i)
    if not columns:
        raise content.error("no name found above the axes X, Y and Z", line + 1)
    return columns


def _parse_rate(content: FileContent, table: Capture, requested: float | None) -> float:
    try:
        rate = float(table.rate)
    except ValueError:
        rate = 0.0
    return content.choose_rate(requested, rate, f"{table.rate[:40]!r} is not a frame rate")


DIALECTS = (
    Dialect(
        "Nexus", is_nexus, partial(read_capture, program="Nexus", look=_parse_nexus), motion=True
    ),
    Dialect(
        "Motive",
        is_motive,
        partial(read_capture, program="Motive", look=_parse_motive, usual_up="y"),
        motion=True,
    ),
    Dialect("QTM", is_qtm, partial(read_capture, program="QTM", look=_parse_qtm), motion=True),
)
