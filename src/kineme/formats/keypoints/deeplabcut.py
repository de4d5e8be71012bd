"""DeepLabCut: tables of keypoints under rows of names.

Rows ``scorer``, ``individuals`` (where there are several), ``bodyparts`` and
``coords`` (x, y, perhaps z, likelihood), then a row per frame. Keypoints less
likely than 0.6, DeepLabCut's own limit for plots, count as not seen. Of several
individuals ``person`` names one. There is no frame rate in the file: ``fps`` gives it.
"""

from __future__ import annotations

from kineme.errors import SeveralPeopleError
from kineme.formats.columns import columns_to_motion
from kineme.formats.delimited import rows_of
from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion

LIKELY = 0.6


def is_deeplabcut(line: str) -> bool:
    """Whether this first line is that of DeepLabCut."""
    return line.lower().startswith("scorer,")


def read_deeplabcut(
    content: FileContent, lines: list[str], first: int, options: ReadOptions
) -> Motion:
    """The motion of the keypoints in a table whose first line is ``first`` of the file."""
    heads: dict[str, list[str]] = {}
    for line in lines[:4]:
        kind, *cells = [cell.strip() for cell in line.split(",")]
        if kind.lower() in ("scorer", "individuals", "bodyparts", "coords"):
            heads[kind.lower()] = cells
    if not {"bodyparts", "coords"} <= heads.keys():
        raise content.error("rows 'bodyparts' and 'coords' expected under 'scorer'", first + 1)
    parts, coords = heads["bodyparts"], heads["coords"]
    who = heads.get("individuals", [""] * len(parts))
    if len({len(parts), len(coords), len(who)}) > 1:
        raise content.error("the rows of names differ in length", first + 1)
    wanted = _wanted(content, list(dict.fromkeys(who)), options.person)
    below = first + len(heads)
    values = rows_of(content, lines[len(heads) :], below, ",", 1 + len(parts))[:, 1:]
    columns = {
        f"{part}_{coord}": column
        for part, coord, someone, column in zip(parts, coords, who, values.T, strict=True)
        if someone == wanted
    }
    return columns_to_motion(content, "DeepLabCut", columns, options, limit=LIKELY)


def _wanted(content: FileContent, individuals: list[str], person: str | None) -> str:
    """The individual to read."""
    if person in individuals:
        return person
    shown = ", ".join(individuals[:8])
    if person is not None:
        reason = f"there is no person {person!r}: choose from {shown}"
        raise SeveralPeopleError(content.path, reason, individuals)
    if len(individuals) > 1:
        reason = f"{len(individuals)} individuals are in it: choose one with person= (--person), "
        raise SeveralPeopleError(content.path, f"{reason}of {shown}", individuals)
    return individuals[0]
