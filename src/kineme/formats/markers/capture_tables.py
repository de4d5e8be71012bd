"""Tables as capture programs write them: Vicon's Nexus, OptiTrack's Motive, Qualisys' QTM.

One name stands for three columns ``X,Y,Z``.

- Nexus: a line ``Trajectories``, the rate, names as ``Ann:LASI``, ``Frame,Sub Frame,X,Y,Z,…``,
  the units, then a row per frame up to a blank line. Devices and model outputs stand in chapters
  of their own, which are passed over.
- Motive: a line ``Format Version,…`` of facts, the rate and the unit among them; below it what
  the columns are of (markers, bones, rigid bodies), their names, perhaps more, and whether they
  are positions or rotations. Markers are taken where as many are named as there are bones or rigid
  bodies; else these.
- QTM: lines ``NO_OF_FRAMES``, ``FREQUENCY``, ``MARKER_NAMES`` and more, each with what it names
  behind a tab; then perhaps a line ``Frame, Time, LASI X, …``, and rows of millimetres. A marker
  that is exactly at the origin was not seen.

Markers without a name are left out where others have one, and an empty cell is a marker not seen.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from kineme._util.checks import format_count
from kineme.formats.delimited import DelimitedText, find_separator, is_number, split_cells
from kineme.formats.dialects import Dialect
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.units import parse_unit
from kineme.recordings import Motion
from kineme.recordings.joint_names import is_nameless

CHAPTERS = ("trajectories", "devices", "model outputs", "joints", "segments", "events")
"""First lines of Nexus's tables, in lower case."""

_MARKERS = re.compile(r'[ ",;\t]*trajectories[ ",;\t]*', re.IGNORECASE)


@dataclass(frozen=True)
class Capture:
    """Where the columns of a table stand, and what stands above them."""

    cells: Sequence[str]  # one for each column
    separator: str  # between cells
    below: int  # the first row, counted from 0
    columns: dict[str, int]  # that of x of each point; y and z follow it
    rate: str  # as written
    unit: str  # as written


def is_nexus(_: Sequence[str], lines: Sequence[str]) -> bool:
    """Return whether a file is Nexus's; one of devices alone holds channels as others do."""
    return _find_first_line(lines) in CHAPTERS and any(map(_MARKERS.fullmatch, lines))


def is_motive(_: Sequence[str], lines: Sequence[str]) -> bool:
    """Return whether a file is Motive's."""
    return _find_first_line(lines).startswith("format version,")


def is_qtm(_: Sequence[str], lines: Sequence[str]) -> bool:
    """Return whether a file is a table of markers of Qualisys'."""
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
    """Return the motion of the markers in a table of a program, once it was looked at."""
    content, lines = table.content, table.lines
    capture = look(content, lines)
    columns = capture.columns
    names = [name for name in columns if not is_nameless(name)] or [*columns]
    chosen = [columns[name] + axis for name in names for axis in range(3)]
    below = range(capture.below, len(lines))
    # A blank line ends the chapter.
    end = next((i for i in below if not lines[i].strip(" ,;\t")), None)
    rows = DelimitedText(
        content, lines[:end], capture.cells, capture.below - 1, capture.below, capture.separator
    )
    # Frames, markers, axes.
    values = rows.numbers(chosen).reshape(-1, len(names), 3)
    if program == "QTM":
        values[(values == 0).all(axis=2)] = np.nan
    notes = list(rows.remarks)
    if left := len(columns) - len(names):
        notes.append(f"{format_count(left, 'point')} without a name left out")
    points = Points(
        names,
        values,
        options.fps or _parse_rate(content, capture),
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
    rate = split_cells(lines[at + 1], separator)[0]
    return Capture(cells, separator, axes + 2, columns, rate, units[0] if units else "")


def _parse_motive(content: FileContent, lines: Sequence[str]) -> Capture:
    axes = _find_axis_line(content, lines, 0)
    separator = find_separator(lines[axes])
    above = [split_cells(line, separator) for line in lines[:axes] if line.strip()]
    # Facts are name and value in turn.
    pairs = zip(above[0][::2], above[0][1::2], strict=False)
    facts = {key.lower(): value for key, value in pairs}
    if len(above) < 4:
        raise content.error("kinds, names and 'Position' expected above the axes", axes + 1)
    kinds, names, quantities = above[1], above[2], above[-1]
    kinds = [kind.lower() for kind in kinds]
    points = _find_point_kinds(kinds, names)
    cells = split_cells(lines[axes], separator)
    places = [
        axis if kind in points and quantity.lower() == "position" else ""
        for axis, kind, quantity in zip(cells, kinds, quantities, strict=False)
    ]
    columns = _find_columns(content, names, places, axes)
    rate = facts.get("export frame rate") or facts.get("capture frame rate", "")
    unit = facts.get("length units", "")
    return Capture(cells, separator, axes + 1, columns, rate, unit)


def _find_point_kinds(kinds: Sequence[str], names: Sequence[str]) -> set[str]:
    """Return the kind of column that holds the body.

    A body has more markers than bones. Fewer are strays, and so are those without a name and the
    markers of a rigid body, ``Hips:Marker1``, which tell no more than it does.
    """
    found: dict[str, set[str]] = {}
    for kind, name in zip(kinds, names, strict=False):
        found.setdefault(kind, set()).add(name)
    rigid = found.get("rigid body", set())
    markers = {
        name
        for name in found.get("marker", set())
        if not is_nameless(name) and name.rpartition(":")[0] not in rigid
    }
    solid = next((kind for kind in ("bone", "rigid body") if kind in found), None)
    if "marker" in found and (solid is None or len(markers) >= len(found[solid])):
        return {"marker"}
    return {solid} if solid else set(kinds)


def _parse_qtm(content: FileContent, lines: Sequence[str]) -> Capture:
    facts = _parse_header(lines)
    names = facts["MARKER_NAMES"]
    below = next((i for i, line in enumerate(lines) if is_number(line.split("\t")[0])), len(lines))
    cells = lines[below].split("\t") if below < len(lines) else []
    # Frame and time take two columns.
    timed = len(cells) >= 3 * len(names) + 2  # frame and time stand first; a row may end in a tab
    columns = {name: 3 * i + 2 * timed for i, name in enumerate(names)}
    if len(cells) < 3 * len(names):
        raise content.error(f"{len(cells)} columns for {len(names)} markers", below + 1)
    numbered = [str(i) for i in range(3 * len(names) + 2 * timed)]
    return Capture(numbered, "\t", below, columns, "".join(facts.get("FREQUENCY", [])), "mm")


def _parse_header(lines: Sequence[str]) -> dict[str, list[str]]:
    """Return what the lines at the top of a table of Qualisys' name, by what they begin with."""
    facts: dict[str, list[str]] = {}
    for line in lines:
        name, *values = line.rstrip().split("\t")
        if not name.isupper():
            break
        facts[name] = values
    return facts


def _find_axis_line(content: FileContent, lines: Sequence[str], start: int) -> int:
    for i in range(start, min(start + 12, len(lines))):
        if lines[i].strip(' "').lower().startswith("frame"):
            return i
    raise content.error("no line 'Frame' with the axes of its columns", start + 1)


def _find_columns(
    content: FileContent, names: Sequence[str], axes: Sequence[str], line: int
) -> dict[str, int]:
    """Return the column of x of each point with y and z beside it."""
    found: dict[str, int] = {}
    for i, name in enumerate(names):
        if name and [cell.lower() for cell in axes[i : i + 3]] == ["x", "y", "z"]:
            found.setdefault(name, i)
    if not found:
        raise content.error("no name stands above the axes X, Y and Z", line + 1)
    return found


def _parse_rate(content: FileContent, table: Capture) -> float:
    try:
        rate = float(table.rate)
    except ValueError:
        rate = 0.0
    if not 0 < rate < float("inf"):
        raise content.error(f"{table.rate[:40]!r} is no frame rate: give fps= (--fps)")
    return rate


NEXUS = Dialect(
    "Nexus", is_nexus, partial(read_capture, program="Nexus", look=_parse_nexus), motion=True
)
MOTIVE = Dialect(
    "Motive",
    is_motive,
    partial(read_capture, program="Motive", look=_parse_motive, usual_up="y"),
    motion=True,
)
QTM = Dialect("QTM", is_qtm, partial(read_capture, program="QTM", look=_parse_qtm), motion=True)
