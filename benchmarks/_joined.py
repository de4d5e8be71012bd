"""Join recordings of a set, and list the classes of their frames."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import kineme
from _options import choose_size
from kineme.evaluation.comparison import UNLABELLED
from kineme.evaluation.folder import find_recordings
from kineme.labels.collections import find_labels
from kineme.labels.spans import format_text
from kineme.recordings import Signals
from sets import read_sensors

Ints = NDArray[np.int64]


def join_signals(recordings: Sequence[Signals]) -> Signals:
    """Concatenate recordings at the rate of the first."""
    values = np.concatenate([one.values for one in recordings])
    return Signals(values, recordings[0].fps, recordings[0].names)


def list_classes(truth: kineme.Segmentation) -> Ints:
    """Return the class of each frame; `UNLABELLED` without a label."""
    numbers: dict[str, int] = {}
    classes = np.full(truth.n_frames, UNLABELLED, np.int64)
    for row in truth.activities:
        if row.kind != "transition":
            number = numbers.setdefault(format_text(row), len(numbers))
            classes[row.start_frame : row.stop_frame] = number
    return classes


def parse_person(name: str) -> str:
    """Return the person from a recording name such as ``PERSON_NUMBER``."""
    return name.rpartition("_")[0]


class Piece(NamedTuple):
    """A recording and the classes of its frames."""

    name: str
    recording: Signals
    truth: Ints


def read_pieces(folder: Path) -> Iterator[Piece]:
    sources = find_labels(find_recordings(folder / "recordings"), folder / "labels.csv")
    for path, source in choose_size(list(sources.items()), list(sources.items())[:2]):
        one = read_sensors(path)
        if isinstance(one, Signals):
            truth = source.of(n_frames=one.n_frames, fps=one.fps)
            yield Piece(path.stem, one, list_classes(truth))
