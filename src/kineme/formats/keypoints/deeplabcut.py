"""DeepLabCut: tables of keypoints under rows of names.

Rows ``scorer``, ``individuals`` (where there are several), ``bodyparts`` and
``coords`` (x, y, perhaps z, likelihood), then a row per frame. Keypoints less
likely than 0.6, DeepLabCut's own limit for plots, count as not seen. Of several
individuals ``person`` names one. There is no frame rate in the file: ``fps`` gives it.
"""

from __future__ import annotations

from dataclasses import replace

from kineme.formats.columns import columns_to_motion
from kineme.formats.delimited import DelimitedText, split_cells
from kineme.formats.dialects import Dialect
from kineme.formats.options import ReadOptions
from kineme.formats.persons import choose_person
from kineme.recordings import Motion

LIKELY = 0.6


def read_deeplabcut(table: DelimitedText, options: ReadOptions) -> Motion:
    """Return the motion of the keypoints of one individual."""
    content, line = table.content, table.head + 2
    labels: dict[str, list[str]] = {}
    for row in table.lines[table.head : table.head + 4]:
        kind, *cells = split_cells(row, table.separator)
        if kind.lower() in ("scorer", "individuals", "bodyparts", "coords"):
            labels[kind.lower()] = cells
    if not {"bodyparts", "coords"} <= labels.keys():
        raise content.error("rows 'bodyparts' and 'coords' expected under 'scorer'", line)
    parts, coords = labels["bodyparts"], labels["coords"]
    individuals = labels.get("individuals", [""] * len(parts))
    if len({len(parts), len(coords), len(individuals)}) > 1:
        raise content.error("the rows of names differ in length", line)
    several = list(dict.fromkeys(individuals))
    individual = choose_person(content.path, several, options.person, "individuals")
    names = ["frame", *(f"{part}_{coord}" for part, coord in zip(parts, coords, strict=True))]
    values = replace(table, names=names, below=table.head + len(labels)).numbers()[:, 1:]
    columns = {
        name: column
        for name, owner, column in zip(names[1:], individuals, values.T, strict=True)
        if owner == individual
    }
    motion = columns_to_motion(content, "DeepLabCut", columns, options, limit=LIKELY)
    provenance = motion.provenance.of_person(individual, several)
    return replace(motion, provenance=provenance)


DIALECT = Dialect(
    "DeepLabCut",
    lambda names, _: len(names) > 1 and names[0].lower() == "scorer",
    read_deeplabcut,
    channels=False,
    motion=True,
)
