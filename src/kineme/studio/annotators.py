"""Compare people who labelled the recordings of a folder.

Labels of a person are found in four places:

- a subfolder with a label file for each recording (``anna/walk.eaf``);
- a table with a column ``recording``;
- files beside the recordings with the person's name after that of the recording
  (``walk.anna.eaf``, ``walk_anna.csv``);
- the tables that were saved in the studio.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from kineme.errors import KinemeError, ParameterError
from kineme.labels.collections import LabelSource, find_labels
from kineme.studio.open_recordings import OpenRecordings, UnknownError
from kineme.studio.storage.sidecars import ListedRecording, make_file_id
from kineme.studio.storage.tables import find_table_path
from kineme.web.annotator_messages import (
    Agreement,
    AgreementPair,
    AnnotatorChoice,
    Difference,
    LabelLane,
    RecordingAgreement,
)
from kineme.web.tables import make_segments_message

SAVED_TABLES = "tables"
"""Id of the tables saved in the studio."""
SEPARATORS = "._- "
"""Characters that may separate the name of a recording from that of a person."""


@dataclass(frozen=True)
class Annotator:
    """A person who labelled recordings, with the label source of each recording."""

    name: str
    sources: Mapping[Path, LabelSource]


def find_annotators(recordings: OpenRecordings) -> dict[str, Annotator]:
    """Return the people who labelled recordings of the folder, by id; saved tables come last."""
    listed = _index_by_file(recordings)
    paths = [*listed]
    files = recordings.folder.annotations(listed.values()).values()
    if not paths:
        return {}
    annotators: dict[str, Annotator] = {}
    for label_file in (*recordings.folder.folders(), *files):
        try:
            sources = find_labels(paths, label_file)
        except (KinemeError, OSError):
            continue  # labels of other recordings, or unreadable
        name = label_file.stem if label_file.is_file() else label_file.name
        annotators[make_file_id(label_file)] = Annotator(name, sources)
    # Files beside recordings that hold the labels of one person each.
    beside: dict[str, dict[Path, LabelSource]] = {}
    for label_file in files:
        parsed = _parse_label_name(label_file, paths)
        if parsed and make_file_id(label_file) not in annotators:
            person, recording_path = parsed
            beside.setdefault(person, {})[recording_path] = LabelSource(label_file)
    annotators |= {f"beside {name}": Annotator(name, sources) for name, sources in beside.items()}
    saved = {
        path: LabelSource(table)
        for path, recording in listed.items()
        if (table := find_table_path(recording))
    }
    if saved:
        annotators[SAVED_TABLES] = Annotator("Tables of this studio", saved)
    return annotators


def list_annotators(recordings: OpenRecordings) -> list[AnnotatorChoice]:
    """Return the people whose labels can be compared."""
    return [
        AnnotatorChoice(id=name, name=annotator.name, recordings=len(annotator.sources))
        for name, annotator in find_annotators(recordings).items()
    ]


def measure_agreement(recordings: OpenRecordings, chosen: Sequence[str]) -> Agreement:
    """Return how well people agree, over all recordings that at least two of them labelled."""
    from kineme.evaluation.annotators import annotator_agreement, gather_labels

    people = _select_annotators(recordings, chosen)
    listed = _index_by_file(recordings)
    labelled, failures = gather_labels(
        {person.name: person.sources for person in people},
        lambda path: recordings.extent(listed[path]),
    )
    if not any(len(sides) > 1 for sides in labelled.values()):
        reason = f": {failures[0]}" if failures else ""
        raise ParameterError(f"no recording has labels by two of them{reason}")
    result = annotator_agreement(labelled)
    # `gather_labels` names a recording by its path if another one with labels has the same name.
    paths = {path for person in people for path in person.sources}
    ids = {text: listed[path].id for path in paths for text in (str(path), path.name)}
    return Agreement(
        annotators=list(result.annotators),
        by_names=result.by == "names",
        fleiss_kappa=result.fleiss_kappa,
        pairs=[
            AgreementPair(
                annotators=(pair.first, pair.second),
                cohen_kappa=pair.cohen_kappa,
                border_f1=pair.border_f1,
                recordings=pair.recordings,
            )
            for pair in result.pairs
        ],
        recordings=[
            RecordingAgreement(
                id=ids[one.recording],
                name=one.recording,
                annotators=list(one.annotators),
                fleiss_kappa=one.fleiss_kappa,
                differences=[Difference(**each._asdict()) for each in one.differences],
            )
            for one in result.recordings
        ],
        failures=failures,
    )


def make_label_lanes(
    recordings: OpenRecordings, name: str, chosen: Sequence[str]
) -> list[LabelLane]:
    """Return one lane with the labels of each selected person for a recording."""
    listed = recordings.get(name).listed
    path = listed.person_path
    n_frames, fps, clock = recordings.extent(listed)
    return [
        LabelLane(
            name=person.name,
            segmentation=make_segments_message(
                person.sources[path].of(n_frames=n_frames, fps=fps, clock=clock)
            ),
        )
        for person in _select_annotators(recordings, chosen)
        if path in person.sources
    ]


def _index_by_file(recordings: OpenRecordings) -> dict[Path, ListedRecording]:
    """Return the recordings of the folder by the path that their label files are named after."""
    return {listed.person_path: listed for listed in recordings.folder.recordings().values()}


def _select_annotators(recordings: OpenRecordings, chosen: Sequence[str]) -> list[Annotator]:
    """Return the annotators with these ids; a repeated name gets a number (anna, anna 2)."""
    available = find_annotators(recordings)
    if not set(chosen) <= available.keys():
        raise UnknownError("one of these people has no labels any more: reload the list")
    annotators: dict[str, Annotator] = {}
    for annotator in (available[annotator_id] for annotator_id in dict.fromkeys(chosen)):
        name, number = annotator.name, 2
        while name in annotators:
            name, number = f"{annotator.name} {number}", number + 1
        annotators[name] = Annotator(name, annotator.sources)
    return [*annotators.values()]


def _parse_label_name(labels: Path, recordings: Sequence[Path]) -> tuple[str, Path] | None:
    """Return person and recording from the name of a label file; None if it has no person."""
    stem = labels.stem
    matches = [
        path
        for path in recordings
        if stem.startswith(path.stem) and stem[len(path.stem) :][:1] in tuple(SEPARATORS)
    ]
    if not matches:
        return None
    # The longest match: the labels of "walk_fast" also begin with "walk".
    recording = max(matches, key=lambda path: len(path.stem))
    person = stem[len(recording.stem) :].strip(SEPARATORS)
    return (person, recording) if person else None
