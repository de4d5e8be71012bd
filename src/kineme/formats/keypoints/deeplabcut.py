"""Read DeepLabCut: tables of keypoints below several rows of names.

These rows are ``scorer``, ``individuals`` (if there are several), ``bodyparts`` and ``coords``
(x, y, optionally z, likelihood). A row per frame follows. Keypoints with a likelihood below 0.6,
DeepLabCut's limit for plots, count as not seen. ``person`` selects one of several individuals. The
file has no frame rate: ``fps`` is required.
"""

from __future__ import annotations

from dataclasses import replace

from kineme.formats.delimited import DelimitedText, split_cells
from kineme.formats.dialects import Dialect
from kineme.formats.options import ReadOptions, choose_person
from kineme.formats.points import columns_to_motion
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
    unique_individuals = list(dict.fromkeys(individuals))
    individual = choose_person(content.path, unique_individuals, options.person, "individuals")
    names = ["frame", *(f"{part}_{coord}" for part, coord in zip(parts, coords, strict=True))]
    values = replace(table, names=names, first_row=table.head + len(labels)).numbers()[:, 1:]
    columns = {
        name: column
        for name, owner, column in zip(names[1:], individuals, values.T, strict=True)
        if owner == individual
    }
    motion = columns_to_motion(content, "DeepLabCut", columns, options, limit=LIKELY)
    provenance = motion.provenance.of_person(individual, unique_individuals)
    return replace(motion, provenance=provenance)


DIALECT = Dialect(
    "DeepLabCut",
    lambda names, _: len(names) > 1 and names[0].lower() == "scorer",
    read_deeplabcut,
    channels=False,
    motion=True,
)
