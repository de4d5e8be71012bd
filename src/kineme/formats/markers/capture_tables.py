"""Tables as two capture programs write them: Vicon's Nexus and OptiTrack's Motive.

Names stand above the axes, one for three columns ``X,Y,Z``.

- Nexus: a line ``Trajectories``, the rate, names as ``Ann:LASI``, ``Frame,Sub Frame,X,Y,Z,…``,
  the units, then a row per frame up to a blank line. Devices and model outputs stand in chapters
  of their own, which are passed over.
- Motive: a line ``Format Version,…`` of facts, the rate and the unit among them; below it what
  the columns are of (markers, bones, rigid bodies), their names, perhaps more, and whether they
  are positions or rotations. Markers are taken, or bones where there are none.

Markers without a name are left out where others have one, and an empty cell is a marker not seen.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from kineme._counts import counted
from kineme._files import HEAD
from kineme.formats.delimited import rows_of, separator_of
from kineme.formats.files import FileContent
from kineme.formats.layout import cells_of
from kineme.formats.marker_sets import is_nameless
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.units import unit_named
from kineme.recordings import Motion

CHAPTERS = ("trajectories", "devices", "model outputs", "joints", "segments", "events")
"""First lines of Nexus's tables, in lower case."""

_MARKERS = re.compile(rb'^[ ",;\t]*trajectories[ ",;\t\r]*$', re.IGNORECASE | re.MULTILINE)


@dataclass(frozen=True)
class CaptureTable:
    """Where the columns of a table stand, and what is said above them.

    Parameters
    ----------
    program : str
        That wrote it.
    axes : int
        The line of the axes, counted from 0.
    below : int
        The first row.
    columns : dict of str to int
        The column of x of each point; y and z follow it.
    rate, unit : str
        As they are written.
    """

    program: str
    axes: int
    below: int
    columns: dict[str, int]
    rate: str
    unit: str


def is_capture_table(data: bytes) -> bool:
    """Whether a file is one of these tables; one of devices alone holds channels as others do."""
    first = data[:HEAD].removeprefix(b"\xef\xbb\xbf").lstrip().split(b"\n", 1)[0].lower()
    plain = first.strip(b' "\r,;\t').decode("ascii", errors="replace")
    if plain in CHAPTERS:
        return _MARKERS.search(data) is not None
    return plain.startswith("format version,")


def read_capture_table(content: FileContent, options: ReadOptions) -> Motion:
    """The motion of the markers in such a table, or of the bones where there are none."""
    lines = content.text.splitlines()
    motive = "format version" in next(filter(str.strip, lines)).lower()
    table = _motive(content, lines) if motive else _nexus(content, lines)
    separator = separator_of(lines[table.axes])
    width = lines[table.axes].count(separator) + 1
    names = [name for name in table.columns if not is_nameless(name)] or [*table.columns]
    wanted = [table.columns[name] + axis for name in names for axis in range(3)]
    end = next((i for i in range(table.below, len(lines)) if not lines[i].strip(" ,;\t")), None)
    rows = lines[table.below : end]
    values = rows_of(content, rows, table.below + 1, separator, width, wanted)
    notes = []
    if left := len(table.columns) - len(names):
        notes.append(f"{counted(left, 'point')} without a name left out")
    points = Points(
        names,
        values.reshape(len(values), -1, 3),
        options.fps or _rate(content, table),
        options.unit or unit_named(table.unit),
        options.up,
        usual_up="y" if motive else "z",
        person=options.person,
    )
    return to_motion(points, content.provenance(f"{table.program} table", notes))


def _nexus(content: FileContent, lines: Sequence[str]) -> CaptureTable:
    at = next(i for i, line in enumerate(lines) if _MARKERS.match(line.encode()))
    axes = _line_of_axes(content, lines, at)
    if axes < at + 3 or axes + 1 >= len(lines):
        raise content.error("rate and names expected under 'Trajectories', units under 'Frame'")
    separator = separator_of(lines[axes])
    names = cells_of(lines[axes - 1], separator)
    columns = _named(content, names, cells_of(lines[axes], separator), axes)
    cells = cells_of(lines[axes + 1], separator)
    units = [cell for first in columns.values() for cell in cells[first : first + 3] if cell]
    if len(set(units)) > 1:
        said = " and ".join(sorted(set(units)))
        raise content.error(f"markers are in {said}: export all of them in one unit", axes + 2)
    rate = cells_of(lines[at + 1], separator)[0]
    return CaptureTable("Nexus", axes, axes + 2, columns, rate, units[0] if units else "")


def _motive(content: FileContent, lines: Sequence[str]) -> CaptureTable:
    axes = _line_of_axes(content, lines, 0)
    separator = separator_of(lines[axes])
    said = [cells_of(line, separator) for line in lines[:axes] if line.strip()]
    facts = {key.lower(): value for key, value in zip(said[0][::2], said[0][1::2], strict=False)}
    if len(said) < 4:
        raise content.error("kinds, names and 'Position' expected above the axes", axes + 1)
    kinds, names, what = said[1], said[2], said[-1]
    kinds = [kind.lower() for kind in kinds]
    taken = next(({kind} for kind in ("marker", "bone") if kind in kinds), set(kinds))
    above = zip(cells_of(lines[axes], separator), kinds, what, strict=False)
    places = [
        axis if kind in taken and of.lower() == "position" else "" for axis, kind, of in above
    ]
    columns = _named(content, names, places, axes)
    rate = facts.get("export frame rate") or facts.get("capture frame rate", "")
    return CaptureTable("Motive", axes, axes + 1, columns, rate, facts.get("length units", ""))


def _line_of_axes(content: FileContent, lines: Sequence[str], start: int) -> int:
    for i in range(start, min(start + 12, len(lines))):
        if lines[i].strip(' "').lower().startswith("frame"):
            return i
    raise content.error("no line 'Frame' with the axes of its columns", start + 1)


def _named(
    content: FileContent, names: Sequence[str], axes: Sequence[str], line: int
) -> dict[str, int]:
    """The column of x of each point with y and z beside it."""
    found: dict[str, int] = {}
    for i, name in enumerate(names):
        if name and [cell.lower() for cell in axes[i : i + 3]] == ["x", "y", "z"]:
            found.setdefault(name, i)
    if not found:
        raise content.error("no name stands above the axes X, Y and Z", line + 1)
    return found


def _rate(content: FileContent, table: CaptureTable) -> float:
    try:
        rate = float(table.rate)
    except ValueError:
        rate = 0.0
    if not 0 < rate < float("inf"):
        raise content.error(f"{table.rate[:40]!r} is no frame rate: give fps= (--fps)")
    return rate
