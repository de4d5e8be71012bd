"""Clusters of recordings that were taken out of a library, for when the recordings come back.

They are kept by the key of the analysis: by content, whatever the recording is called then.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from kineme.errors import ReadError
from kineme.library.storage.layout import MOST_CLUSTERS, read_json, write_json
from kineme.transfer.clusters import Spans

REMOVED = "left.json"
DAMAGED = "is damaged: remove it; clusters of recordings that come back get new numbers then"
Kept = tuple[list[float], list[float], list[int]]
"""Starts, stops and clusters of activities."""


def read_removed(folder: Path) -> dict[str, Spans]:
    """Return the activities of recordings that were taken out, by key."""
    try:
        content = read_json(folder / REMOVED, Kept)
    except ReadError as error:
        raise ReadError(folder / REMOVED, DAMAGED) from error
    for starts, stops, clusters in content.values():
        is_even = len(starts) == len(stops) == len(clusters)
        if not (is_even and all(-1 <= cluster < MOST_CLUSTERS for cluster in clusters)):
            raise ReadError(folder / REMOVED, DAMAGED)
    return {
        key: (np.array(starts, float), np.array(stops, float), np.array(clusters, np.int64))
        for key, (starts, stops, clusters) in content.items()
    }


def write_removed(
    folder: Path, removed: Mapping[str, Spans], before: Mapping[str, Spans], keys: Iterable[str]
) -> None:
    """Keep activities of recordings, removed earlier or there before, that have no key now."""
    present = set(keys)
    content = {
        key: [column.tolist() for column in spans]
        for key, spans in {**removed, **before}.items()
        if key not in present
    }
    if content or (folder / REMOVED).exists():
        write_json(folder / REMOVED, content)
