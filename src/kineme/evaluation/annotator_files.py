"""What several people say of the recordings of a folder: from their files to tables to compare."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from kineme.errors import KinemeError
from kineme.labels.collections import Extent, LabelSource
from kineme.segments.segmentation import Segmentation


class AnnotatorLabels(NamedTuple):
    """By recording and annotator what was read, and a sentence on each that could not be."""

    labelled: dict[str, dict[str, Segmentation]]
    failures: list[str]


def extent_of(path: Path) -> Extent:
    """Return the extent of the recording in a file."""
    from kineme.formats import read

    recording = read(path)
    return Extent(recording.n_frames, recording.fps, recording.provenance.clock)


def labels_of_annotators(
    sources: Mapping[str, Mapping[Path, LabelSource]],
    extent: Callable[[Path], Extent] = extent_of,
) -> AnnotatorLabels:
    """Return the labels of the recordings for which two people or more have some.

    The sources are by annotator and recording, see `kineme.labels.collections.labels_of`; the
    labels by the names of recordings, or by their paths where names come again.
    """
    paths = list(dict.fromkeys(path for places in sources.values() for path in places))
    names = [path.name for path in paths]
    labelled: dict[str, dict[str, Segmentation]] = {}
    failures: list[str] = []
    for path in sorted(paths):
        found = {who: places[path] for who, places in sources.items() if path in places}
        if len(found) < 2:
            continue
        name = path.name if names.count(path.name) == 1 else str(path)
        try:
            n_frames, fps, clock = extent(path)
        except KinemeError as error:
            failures.append(f"{name}: {error}")
            continue
        sides = labelled.setdefault(name, {})
        for who, source in found.items():
            try:
                sides[who] = source.of(n_frames=n_frames, fps=fps, clock=clock)
            except KinemeError as error:
                failures.append(f"{name}, {who}: {error}")
            else:
                if "activity" not in sides[who].activities.kind:
                    failures.append(f"{name}, {who}: {source.path} says nothing of it")
                    del sides[who]
    return AnnotatorLabels(labelled, failures)


def annotator_names(paths: Sequence[Path]) -> list[str]:
    """What tells the files or folders of people apart: their names, with folders where needed.

    Examples
    --------
    >>> annotator_names([Path("labels/anna"), Path("labels/ben.csv")])
    ['anna', 'ben']
    >>> annotator_names([Path("anna/labels.csv"), Path("ben/labels.csv")])
    ['anna/labels', 'ben/labels']
    """
    plain = [
        path.absolute() if path.is_dir() else path.absolute().with_suffix("") for path in paths
    ]
    # As many folders as it takes to make all names different.
    for parts in range(1, max(len(path.parts) for path in plain) + 1):
        names = ["/".join(path.parts[-parts:]) for path in plain]
        if len(set(names)) == len(names):
            return names
    return [str(path) for path in paths]
