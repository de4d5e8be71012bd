"""Recordings that have left a library, with the clusters that they had.

Who takes a recording out and puts it back finds the numbers and names of its clusters again: these
are kept by the content of the recording, whatever it is called when it comes back.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from kineme._checks import is_number
from kineme.errors import ReadError
from kineme.library.storage.layout import MOST_CLUSTERS, read_json, write_json
from kineme.library.vocabulary.numbering import Spans

LEFT = "left.json"

Left = Mapping[str, Spans]
"""Starts, stops and clusters of the activities of a recording, by the name of its piece."""


def read_left(folder: Path) -> dict[str, Spans]:
    """What a library remembers of recordings that are not in it.

    Raises
    ------
    ReadError
        The file is damaged.
    """
    path = folder / LEFT
    return {key: _spans(told, path) for key, told in read_json(path).items()}


def write_left(folder: Path, left: Left) -> None:
    """Leave that for the next build."""
    told = {key: [column.tolist() for column in spans] for key, spans in left.items()}
    if told or (folder / LEFT).exists():
        write_json(folder / LEFT, told)


def parted(left: Left, known: Left, there: Iterable[str]) -> dict[str, Spans]:
    """Of left and of known recordings those that are not there any more."""
    stay = set(there)
    return {key: spans for key, spans in {**left, **known}.items() if key not in stay}


def _spans(told: object, path: Path) -> Spans:
    if isinstance(told, list) and len(told) == 3 and all(isinstance(part, list) for part in told):
        same = len({len(part) for part in told}) == 1
        if same and all(is_number(number) for part in told for number in part):
            starts, stops, clusters = told
            if all(isinstance(c, int) and -1 <= c < MOST_CLUSTERS for c in clusters):
                return np.array(starts, float), np.array(stops, float), np.array(clusters, np.int64)
    raise ReadError(
        path, "is damaged: remove it; clusters of recordings that come back get new numbers then"
    )
