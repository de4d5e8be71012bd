"""The search index: the windows of all recordings of a library, stored beside its tables.

``windows.LENGTH.npy`` holds the windows of one length, in the order of the table of recordings.
Libraries below `FROM_HOURS` have no index: they are searched as a whole.
"""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from kineme._util.arrays import Ints
from kineme.errors import ReadError
from kineme.library.storage.analyses import read_windows
from kineme.library.storage.layout import ANALYSES, BODIES, TABLES
from kineme.library.storage.places import copy_nearby, write_locally
from kineme.library.windows import LENGTHS, NUMBERS, Bytes, count_windows, group_by_length

FROM_HOURS = 100.0
"""Hours of recordings of bodies from which on a library has an index."""


class Windows(NamedTuple):
    """The windows of one length.

    Attributes
    ----------
    length : int
    embedded : (windows, 32) array of int8
        Memory-mapped.
    firsts : (recordings + 1,) array
        First window of each recording, and the total number.
    samples : (recordings,) array
        Number of feature samples of each recording.
    """

    length: int
    embedded: Bytes
    firsts: Ints
    samples: Ints


def write_index(folder: Path, tables: str, recordings: dict[str, list[Any]]) -> None:
    """Write an index beside the tables of that name, if the library is large enough."""
    samples = _list_samples(recordings)
    rates = zip(samples.tolist(), recordings["features_fps"], strict=True)
    if sum(n / fps for n, fps in rates if n) < FROM_HOURS * 3600:
        return
    home = folder / TABLES / tables
    if all(_make_path(home, length).is_file() for length in LENGTHS):
        return
    with ExitStack() as stack:
        drafts = {
            length: np.lib.format.open_memmap(
                stack.enter_context(write_locally(_make_path(home, length))),
                mode="w+",
                dtype=np.int8,
                shape=(int(count_windows(samples, length).sum()), NUMBERS),
            )
            for length in LENGTHS
        }
        firsts = dict.fromkeys(LENGTHS, 0)
        # Write into memory-mapped files, since all windows may not fit into memory.
        for row in np.flatnonzero(samples):
            windows = read_windows(folder / ANALYSES, recordings["piece"][row])
            for length, part in group_by_length(windows, int(samples[row])):
                drafts[length][firsts[length] : firsts[length] + len(part)] = part
                firsts[length] += len(part)
        for draft in drafts.values():
            draft.flush()


def open_index(
    folder: Path, tables: str, recordings: dict[str, list[Any]], length: int
) -> Windows | None:
    """Return the windows of one length, or None if the library has no index."""
    path = _make_path(folder / TABLES / tables, length)
    try:
        embedded: Bytes = np.load(copy_nearby(path), mmap_mode="r", allow_pickle=False)
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise ReadError(path, "is damaged: remove it and build the library again") from error
    samples = _list_samples(recordings)
    firsts = np.concatenate([[0], np.cumsum(count_windows(samples, length))])
    if embedded.shape != (firsts[-1], NUMBERS) or embedded.dtype != np.int8:
        raise ReadError(path, "is damaged: remove it and build the library again")
    return Windows(length, embedded, firsts, samples)


def _list_samples(recordings: dict[str, list[Any]]) -> Ints:
    """Return the number of samples of each recording, 0 for those that are not bodies."""
    bodies = np.array(recordings["vocabulary"], object) == BODIES
    return np.where(bodies, np.array(recordings["samples"], np.int64), 0)


def _make_path(home: Path, length: int) -> Path:
    return home / f"windows.{length}.npy"
