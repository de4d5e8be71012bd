"""People who labelled the recordings of a folder: who there is, and how far they agree.

A person is a folder in it, with a label file for a recording or more (``anna/walk.eaf``); a table
with a column ``recording``; what files beside the recordings have in their names behind that of
the recording (``walk.anna.eaf``, ``walk_anna.csv``); and whoever works here: the saved tables.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from kineme.errors import KinemeError, ParameterError
from kineme.labels.collections import LabelSource, find_labels
from kineme.studio.open_recordings import OpenRecordings, UnknownError
from kineme.studio.storage.listed import ListedRecording, make_file_id
from kineme.studio.storage.tables import find_table_path
from kineme.web.annotator_messages import (
    Agreement,
    AgreementPair,
    AnnotatorChoice,
    Difference,
    LabelLane,
    RecordingAgreement,
)

TABLES_HERE = "tables"
BEHIND = "._- "
"""What parts the name of a recording from that of a person."""


@dataclass(frozen=True)
class Annotator:
    """Who labelled recordings, and where."""

    name: str
    sources: Mapping[Path, LabelSource]


def find_annotators(recordings: OpenRecordings) -> dict[str, Annotator]:
    """Return the people who labelled recordings of the folder by id; whoever works here last."""
    listed = _index_by_file(recordings)
    paths = [*listed]
    files = recordings.folder.annotations(listed.values()).values()
    if not paths:
        return {}
    found: dict[str, Annotator] = {}
    for place in (*recordings.folder.folders(), *files):
        try:
            sources = find_labels(paths, place)
        except (KinemeError, OSError):
            continue  # of other recordings, or of one that it does not name
        name = place.stem if place.is_file() else place.name
        found[make_file_id(place)] = Annotator(name, sources)
    beside: dict[str, dict[Path, LabelSource]] = {}
    for path in files:
        if make_file_id(path) not in found and (named := _parse_label_name(path, paths)):
            beside.setdefault(named[0], {})[named[1]] = LabelSource(path)
    found |= {f"beside {name}": Annotator(name, sources) for name, sources in beside.items()}
    saved = {
        path: LabelSource(table)
        for path, each in listed.items()
        if (table := find_table_path(each))
    }
    if saved:
        found[TABLES_HERE] = Annotator("Tables of this studio", saved)
    return found


def list_annotators(recordings: OpenRecordings) -> list[AnnotatorChoice]:
    """Who there is to compare."""
    return [
        AnnotatorChoice(id=name, name=each.name, recordings=len(each.sources))
        for name, each in find_annotators(recordings).items()
    ]


def measure_agreement(recordings: OpenRecordings, chosen: Sequence[str]) -> Agreement:
    """Return how far some of them agree, over all recordings for which two of them have labels."""
    from kineme.evaluation.annotators import annotator_agreement, gather_labels
    from kineme.evaluation.score import to_finite

    people = _select_annotators(recordings, chosen)
    listed = _index_by_file(recordings)
    labelled, failures = gather_labels(
        {who.name: who.sources for who in people},
        lambda path: recordings.extent(listed[path]),
    )
    if not any(len(sides) > 1 for sides in labelled.values()):
        reason = f": {failures[0]}" if failures else ""
        raise ParameterError(f"there is no recording of which two of them have labels{reason}")
    found = annotator_agreement(labelled)
    ids = {text: each.id for path, each in listed.items() for text in (str(path), path.name)}
    return Agreement(
        annotators=list(found.annotators),
        by_names=found.by == "names",
        fleiss_kappa=to_finite(found.fleiss_kappa),
        pairs=[
            AgreementPair(
                annotators=(pair.first, pair.second),
                cohen_kappa=to_finite(pair.cohen_kappa),
                border_f1=to_finite(pair.border_f1),
                recordings=pair.recordings,
            )
            for pair in found.pairs
        ],
        recordings=[
            RecordingAgreement(
                id=ids[one.recording],
                name=one.recording,
                annotators=list(one.annotators),
                fleiss_kappa=to_finite(one.fleiss_kappa),
                differences=[Difference(**each._asdict()) for each in one.differences],
            )
            for one in found.recordings
        ],
        failures=failures,
    )


def make_label_lanes(
    recordings: OpenRecordings, name: str, chosen: Sequence[str]
) -> list[LabelLane]:
    """Return what some of them say of a recording, one lane each."""
    from kineme.web.tables import make_segments_message

    listed = recordings.get(name).listed
    path = listed.called
    n_frames, fps, clock = recordings.extent(listed)
    return [
        LabelLane(
            name=who.name,
            segmentation=make_segments_message(
                who.sources[path].of(n_frames=n_frames, fps=fps, clock=clock)
            ),
        )
        for who in _select_annotators(recordings, chosen)
        if path in who.sources
    ]


def _index_by_file(recordings: OpenRecordings) -> dict[Path, ListedRecording]:
    """Return the recordings of the folder by the files that labels of them are called after."""
    return {each.called: each for each in recordings.folder.recordings().values()}


def _select_annotators(recordings: OpenRecordings, chosen: Sequence[str]) -> list[Annotator]:
    """Those of that id, with names that tell them apart."""
    present = find_annotators(recordings)
    if not set(chosen) <= present.keys():
        raise UnknownError("one of these people has no labels any more; look who there is now")
    found: dict[str, Annotator] = {}
    for each in (present[name] for name in dict.fromkeys(chosen)):
        name, number = each.name, 2
        while name in found:
            name, number = f"{each.name} {number}", number + 1
        found[name] = Annotator(name, each.sources)
    return [*found.values()]


def _parse_label_name(labels: Path, recordings: Sequence[Path]) -> tuple[str, Path] | None:
    """Person and recording that the name of a label file tells, if it does."""
    stem = labels.stem
    fitting = [
        path
        for path in recordings
        if stem.startswith(path.stem) and stem[len(path.stem) :][:1] in tuple(BEHIND)
    ]
    if not fitting:
        return None
    recording = max(fitting, key=lambda path: len(path.stem))
    person = stem[len(recording.stem) :].strip(BEHIND)
    return (person, recording) if person else None
