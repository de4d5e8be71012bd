"""How far several people agree about the same recordings, beyond what chance would give.

Every frame counts, at the rate at which results are compared (`kineme.evaluation.inputs`). Frames
that somebody says nothing of are a class of their own, as is usual where units of time are
tallied (Bakeman, Quera and Gnisci, Observer agreement for timed-event sequential data, 2009).

A class is a name, in capitals or small letters. Where people name things differently, or not at
all, the classes of a second one stand for those of a first by the one-to-one mapping in which most
frames of all recordings agree (`map_clusters`); for all together, the first of all is meant.

Over a folder the kappas count the frames of all recordings together: of two people on those that
both labelled, of all on those that all labelled. Border F1 is the mean over recordings, and either
of the two is taken for the truth in turn.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Ints
from kineme._version import __version__
from kineme.errors import KinemeError, ParameterError
from kineme.evaluation.comparison import Comparison, Spans, find_runs, map_clusters
from kineme.evaluation.inputs import make_comparison
from kineme.evaluation.label_truth import make_truth
from kineme.evaluation.measures import border_score, cohen_kappa
from kineme.evaluation.score import to_finite, to_plain
from kineme.evaluation.truth import TRANSITION, UNLABELLED, Truth
from kineme.labels.collections import Extent, LabelSource
from kineme.segments.segmentation import Segmentation

By = Literal["names", "mapping"]

SHARED = 0.5
"""Of the names of the one who has fewer, the share that the other must have for names to count."""

Labelled = Mapping[str, Mapping[str, Segmentation]]
"""By recording and annotator, in the order in which they are shown."""


class Pair(NamedTuple):
    """How far two people agree, on as many recordings as both labelled; nan where on none."""

    first: str
    second: str
    cohen_kappa: float
    border_f1: float
    recordings: int


class Difference(NamedTuple):
    """A span in seconds in which not all say the same, and what each says; empty is nothing."""

    start_s: float
    stop_s: float
    labels: tuple[str, ...]


@dataclass(frozen=True)
class RecordingAgreement:
    """How far those who labelled a recording agree about it, and where they differ.

    No difference is shorter than the tolerance of borders.
    """

    recording: str
    annotators: tuple[str, ...]
    fleiss_kappa: float
    differences: tuple[Difference, ...]


@dataclass(frozen=True)
class AnnotatorAgreement:
    """How far several people agree about some recordings.

    Parameters
    ----------
    annotators : tuple of str
        Their names.
    by : {"names", "mapping"}
        Whether classes are names, or stand for each other by the best mapping.
    fleiss_kappa : float
        Of all of them, on the recordings that all labelled; nan where there is none.
    pairs : tuple of Pair
        Any two of them.
    recordings : tuple of RecordingAgreement
        Those that at least two labelled.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> labels = kineme.read_segments(bundled_truth())
    >>> found = annotator_agreement({"take": {"Anna": labels, "Ben": labels}})
    >>> [record["annotators"] for record in found.records()]
    ['Anna, Ben', 'Anna, Ben', 'Anna, Ben']
    """

    annotators: tuple[str, ...]
    by: By
    fleiss_kappa: float
    pairs: tuple[Pair, ...]
    recordings: tuple[RecordingAgreement, ...]

    def records(self) -> list[dict[str, Any]]:
        """One record for each pair, one for all, and one for each recording."""
        head = {"recording": "*", "by": self.by}
        pairs = [
            {
                **head,
                "annotators": f"{pair.first}, {pair.second}",
                "cohen_kappa": pair.cohen_kappa,
                "border_f1": pair.border_f1,
            }
            for pair in self.pairs
        ]
        kappas = [("*", self.annotators, self.fleiss_kappa)]
        kappas += [(one.recording, one.annotators, one.fleiss_kappa) for one in self.recordings]
        return pairs + [
            {**head, "recording": name, "annotators": ", ".join(who), "fleiss_kappa": kappa}
            for name, who, kappa in kappas
        ]

    def to_json(self) -> str:
        """Everything as one JSON object; a kappa that cannot be had is null."""
        content = {
            "kineme": __version__,
            "annotators": self.annotators,
            "by": self.by,
            "fleiss_kappa": self.fleiss_kappa,
            "pairs": [to_plain(pair._asdict()) for pair in self.pairs],
            "recordings": [
                {
                    "recording": one.recording,
                    "annotators": one.annotators,
                    "fleiss_kappa": to_finite(one.fleiss_kappa),
                    "differences": [each._asdict() for each in one.differences],
                }
                for one in self.recordings
            ],
        }
        return json.dumps(to_plain(content), ensure_ascii=False)


def fleiss_kappa(counts: ArrayLike) -> float:
    """Fleiss' kappa: how far several people agree beyond what chance would give.

    κ = (P - Pe) / (1 - Pe). P is the mean over subjects of the share of pairs of people who agree,
    (Σ_j n_ij² - n) / (n (n - 1)); Pe is Σ_j p_j², p_j being the share of class j in all that was
    said. Source: Fleiss, Measuring nominal scale agreement among many raters, 1971, equations 1
    to 7. Of two people it is Scott's pi, which Cohen's kappa is close to.

    Parameters
    ----------
    counts : array_like of int, (subjects, classes)
        How many people put a subject, such as a frame, into a class; of each subject as many, two
        at least.

    Returns
    -------
    float
        1 is equal, 0 is chance, below is worse; also 1 where there is one class only, nan where
        there is no subject.

    Raises
    ------
    ParameterError
        Subjects have different numbers of people, or fewer than two.

    Examples
    --------
    >>> fleiss_kappa([[3, 0], [3, 0], [0, 3], [0, 3]])
    1.0
    >>> round(fleiss_kappa([[3, 0], [2, 1], [1, 2], [0, 3]]), 3)
    0.333
    """
    table = np.asarray(counts, np.float64)
    if table.ndim != 2:
        raise ParameterError(f"counts are subjects x classes, not of shape {table.shape}")
    if not len(table):
        return math.nan
    people = table.sum(axis=1)
    n = float(people[0])
    if n < 2 or (people != n).any():
        raise ParameterError("every subject needs as many people, and two at least")
    # Pairs of people who agree, of all ordered pairs, averaged over subjects.
    agreed = float(np.mean((np.square(table).sum(axis=1) - n) / (n * (n - 1))))
    # Shares of the classes in everything that was said.
    by_chance = float(np.square(table.sum(axis=0) / table.sum()).sum())
    return (agreed - by_chance) / (1 - by_chance) if by_chance < 1 else 1.0


def annotator_agreement(labelled: Labelled) -> AnnotatorAgreement:
    """Return how far people agree who labelled the same recordings.

    Parameters
    ----------
    labelled : mapping of str to mapping of str to Segmentation
        By the name of a recording what each annotator says of it, all of as many frames. Its
        activities count.

    Returns
    -------
    AnnotatorAgreement

    Raises
    ------
    ParameterError
        No recording has labels of two people.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> labels = kineme.read_segments(bundled_truth())
    >>> found = annotator_agreement({"take": {"Anna": labels, "Ben": labels}})
    >>> found.by, round(found.fleiss_kappa, 3), found.pairs[0].border_f1
    ('names', 1.0, 1.0)
    """
    several = {name: sides for name, sides in labelled.items() if len(sides) > 1}
    if not several:
        raise ParameterError("no recording has labels of two people")
    people = tuple(dict.fromkeys(who for sides in labelled.values() for who in sides))
    truths = {
        name: {who: _make_truth(found) for who, found in sides.items()}
        for name, sides in several.items()
    }
    # Names are compared only if people use the same ones; else clusters are mapped.
    by: By = "names" if _have_names_in_common(several, truths) else "mapping"
    sides_by = _Sides(truths, by)
    pairs = tuple(sides_by.pair(first, second) for first, second in combinations(people, 2))
    stacks = sides_by.stacks(people[0])
    all_of = [stacks[name] for name, sides in truths.items() if len(sides) == len(people)]
    together = (
        fleiss_kappa(_count_annotators(np.concatenate(all_of, axis=1))) if all_of else math.nan
    )
    recordings = tuple(
        RecordingAgreement(
            name,
            tuple(sides),
            fleiss_kappa(_count_annotators(stacks[name])),
            tuple(_find_differences(tuple(sides.values()), stacks[name])),
        )
        for name, sides in truths.items()
    )
    return AnnotatorAgreement(people, by, together, pairs, recordings)


Truths = Mapping[str, Mapping[str, Truth]]
"""By recording and annotator, at the rate of comparison."""


class _Sides:
    """Classes of all frames as numbers: by names one for all, else one for each annotator."""

    def __init__(self, truths: Truths, by: By):
        self._truths, self._by = truths, by
        self._numbers: dict[tuple[str, str], int] = {}
        self._classes = {
            name: {who: self._numbered(who, truth) for who, truth in sides.items()}
            for name, sides in truths.items()
        }

    def pair(self, first: str, second: str) -> Pair:
        """Return how far two people agree."""
        compared = self._compared(first, second)
        if not compared:
            return Pair(first, second, math.nan, math.nan, 0)
        # All recordings as one, so that one mapping serves them all.
        both = Comparison(
            np.concatenate([one.truth for one in compared]),
            np.concatenate([one.found for one in compared]),
            compared[0].fps,
            self._mapping(compared),
            transitions=True,
        )
        # Either of the two is the truth in turn, since borders have a tolerance on one side only.
        borders = [border_score(one).f1 for one in (*compared, *self._compared(second, first))]
        return Pair(first, second, cohen_kappa(both), float(np.mean(borders)), len(compared))

    def stacks(self, first: str) -> dict[str, Ints]:
        """By recording the class of each frame, a row for each annotator, in the first one's."""
        mappings: dict[str, Mapping[int, int]] = {}
        # Everybody's classes are expressed in those of the first person.
        for who in {who for sides in self._truths.values() for who in sides} - {first}:
            compared = self._compared(first, who)
            mappings[who] = self._mapping(compared) if compared else {}
        return {
            name: np.array([_map_classes(row, mappings.get(who, {})) for who, row in sides.items()])
            for name, sides in self._classes.items()
        }

    def _numbered(self, who: str, truth: Truth) -> Ints:
        labelling = truth.labelling()
        keys = [
            ("" if self._by == "names" else who, _normalize_label(label))
            for label in labelling.labels
        ]
        # Numbers are shared by all recordings; by mapping, each person has their own.
        values = [
            UNLABELLED
            if name == TRANSITION
            else self._numbers.setdefault((person, name), len(self._numbers))
            for person, name in keys
        ]
        return np.repeat(np.array(values, np.int64), np.diff(labelling.borders))

    def _compared(self, truth: str, found: str) -> list[Comparison]:
        """One beside the other, on the recordings that both labelled."""
        return [
            Comparison(
                self._classes[name][truth],
                self._classes[name][found],
                sides[truth].fps,
                transitions=True,
                # Borders have spans in the truth only; the second person's are exact.
                intervals=Spans(sides[truth], sides[found].labelling(), sides[found].labelling()),
            )
            for name, sides in self._truths.items()
            if {truth, found} <= sides.keys()
        ]

    def _mapping(self, compared: Sequence[Comparison]) -> Mapping[int, int]:
        if self._by == "mapping":
            return map_clusters(compared)
        return {number: number for number in (UNLABELLED, *self._numbers.values())}


def _make_truth(found: Segmentation) -> Truth:
    n_frames, fps = make_comparison(found)
    truth = make_truth(found, n_frames=n_frames, fps=fps)
    return Truth.from_labelling(truth.labelling().merged())


def _normalize_label(label: str) -> str:
    """Return a label as it is compared."""
    return " ".join(label.split()).casefold()


def _have_names_in_common(labelled: Labelled, truths: Truths) -> bool:
    """Return whether all name whatever they label, and any two have names in common."""
    names: dict[str, set[str]] = {}
    for recording, sides in truths.items():
        for who, truth in sides.items():
            rows = labelled[recording][who].activities
            if any(row.kind == "activity" and not row.label for row in rows):
                return False
            found = {_normalize_label(label) for label in truth.labels} - {TRANSITION}
            names.setdefault(who, set()).update(found)
    pairs = combinations(names.values(), 2)
    return all(len(a & b) >= SHARED * min(len(a), len(b)) for a, b in pairs)


def _map_classes(classes: Ints, mapping: Mapping[int, int]) -> Ints:
    """Return the classes that a mapping knows as it says, the others as they are."""
    # The mapping of each class once, then spread over the frames.
    numbers, where = np.unique(classes, return_inverse=True)
    return np.array([mapping.get(int(n), int(n)) for n in numbers], np.int64)[where]


def _count_annotators(stack: Ints) -> Ints:
    """How many annotators (rows) put each frame (column) into each class: frames x classes."""
    # Rows of the stack are annotators, columns frames; the sum counts annotators.
    classes = np.unique(stack)
    return np.stack([(stack == each).sum(axis=0) for each in classes], axis=1)


def _find_differences(sides: Sequence[Truth], stack: Ints) -> Iterator[Difference]:
    """Where the rows of a stack are not equal, and what each side says there."""
    labels = [side.labelling().per_frame() for side in sides]
    fps, least = sides[0].fps, sides[0].tolerance_s * sides[0].fps
    # Numbers of the different columns: a run of one number says the same throughout.
    _, columns = np.unique(stack, axis=1, return_inverse=True)
    for run in find_runs(columns.ravel()):
        # No longer than the tolerance of borders: a border that is a little off is no difference.
        if run.stop - run.start > least and (stack[:, run.start] != stack[0, run.start]).any():
            names = ("" if (name := each[run.start]) == TRANSITION else name for each in labels)
            yield Difference(run.start / fps, run.stop / fps, tuple(names))


def read_extent(path: Path) -> Extent:
    """Return the extent of the recording in a file."""
    from kineme.formats import read

    recording = read(path)
    return Extent(recording.n_frames, recording.fps, recording.provenance.clock)


def gather_labels(
    sources: Mapping[str, Mapping[Path, LabelSource]],
    extent: Callable[[Path], Extent] = read_extent,
) -> tuple[dict[str, dict[str, Segmentation]], list[str]]:
    """Return the labels of the recordings for which two people or more have some.

    The sources are by annotator and recording, see `kineme.labels.collections.find_labels`; the
    labels by recording and annotator: the names of recordings, or their paths where names come
    again. With them comes a sentence on each that could not be read.
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
    return labelled, failures


def name_annotators(paths: Sequence[Path]) -> list[str]:
    """What tells the files or folders of people apart: their names, with folders where needed.

    Examples
    --------
    >>> name_annotators([Path("labels/anna"), Path("labels/ben.csv")])
    ['anna', 'ben']
    >>> name_annotators([Path("anna/labels.csv"), Path("ben/labels.csv")])
    ['anna/labels', 'ben/labels']
    """
    whole = [path.absolute() for path in paths]
    plain = [path if path.is_dir() else path.with_suffix("") for path in whole]
    # As many folders as it takes to make all names different.
    for parts in range(1, max(len(path.parts) for path in plain) + 1):
        names = ["/".join(path.parts[-parts:]) for path in plain]
        if len(set(names)) == len(names):
            return names
    return [str(path) for path in paths]
