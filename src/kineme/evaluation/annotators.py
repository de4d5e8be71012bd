"""Measure the agreement of several people about the same recordings, corrected for chance.

Every frame counts, at the rate at which results are compared (`kineme.evaluation.evaluate`). Frames
without a label are a class of their own, as is usual for units of time (Bakeman, Quera and Gnisci,
Observer agreement for timed-event sequential data, 2009).

Classes are names, ignoring case. If people use different names, or none, the classes of the second
person are mapped one to one to those of the first, so that most frames of all recordings agree
(`map_clusters`). For more than two people, all are mapped to the first.

Over a folder, kappas count the frames of all recordings that both (or all) people labelled. Border
F1 is the mean over recordings, with each of the two people as truth in turn.
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
from kineme.evaluation.measures import border_score, cohen_kappa
from kineme.evaluation.score import to_finite, to_plain
from kineme.evaluation.truth import (
    TRANSITION,
    UNLABELLED,
    Truth,
    choose_comparison_rate,
    make_truth,
)
from kineme.labels.collections import Extent, LabelSource
from kineme.segments.segmentation import Segmentation

By = Literal["names", "mapping"]

MIN_SHARED_NAMES = 0.5
"""Share of the names of the person with fewer names that the other must also use, for classes to be
compared by name."""

Labelled = Mapping[str, Mapping[str, Segmentation]]
"""Segmentations by recording and annotator, in display order."""
Truths = Mapping[str, Mapping[str, Truth]]
"""Truths by recording and annotator, at the rate of comparison."""


class Pair(NamedTuple):
    """Agreement of two people on the recordings that both labelled; nan without any."""

    first: str
    second: str
    cohen_kappa: float
    border_f1: float
    recordings: int


class Difference(NamedTuple):
    """A span in seconds in which people disagree, and the label of each; empty if unlabelled."""

    start_s: float
    stop_s: float
    labels: tuple[str, ...]


@dataclass(frozen=True)
class RecordingAgreement:
    """Agreement of the people who labelled a recording, and their differences.

    Differences shorter than the tolerance of borders are left out.
    """

    recording: str
    annotators: tuple[str, ...]
    fleiss_kappa: float
    differences: tuple[Difference, ...]


@dataclass(frozen=True)
class AnnotatorAgreement:
    """Agreement of several people about some recordings.

    Parameters
    ----------
    annotators : tuple of str
        Their names.
    by : {"names", "mapping"}
        Whether classes are compared by name, or by the best one-to-one mapping.
    fleiss_kappa : float
        Kappa of all people, on the recordings that all labelled; nan without any.
    pairs : tuple of Pair
        Agreement of each two people.
    recordings : tuple of RecordingAgreement
        Recordings that at least two people labelled.

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
        """Return one record for each pair, one for all people, and one for each recording."""
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
        """Return everything as one JSON object; undefined kappas are null."""
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
    """Return Fleiss' kappa: the agreement of several people, corrected for chance.

    κ = (P - Pe) / (1 - Pe). P is the mean over subjects of the share of pairs of people who agree,
    (Σ_j n_ij² - n) / (n (n - 1)). Pe is Σ_j p_j², where p_j is the share of class j in all
    assignments. Source: Fleiss, Measuring nominal scale agreement among many raters, 1971,
    equations 1 to 7. For two people it equals Scott's pi, which is close to Cohen's kappa.

    Parameters
    ----------
    counts : array_like of int, (subjects, classes)
        Number of people who assigned a subject (for example a frame) to a class. All subjects must
        have the same number of people, at least two.

    Returns
    -------
    float
        1 is equal, 0 is chance, below 0 is worse. It is 1 with a single class, and nan without
        subjects.

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
        raise ParameterError("every subject needs the same number of annotators, at least two")
    # Share of ordered pairs of people who agree, averaged over subjects.
    agreed = float(np.mean((np.square(table).sum(axis=1) - n) / (n * (n - 1))))
    # Expected agreement: squared shares of the classes in all assignments.
    by_chance = float(np.square(table.sum(axis=0) / table.sum()).sum())
    return (agreed - by_chance) / (1 - by_chance) if by_chance < 1 else 1.0


def annotator_agreement(labelled: Labelled) -> AnnotatorAgreement:
    """Measure the agreement of people who labelled the same recordings.

    Parameters
    ----------
    labelled : mapping of str to mapping of str to Segmentation
        For each recording, the segmentations by annotator, all with the same number of frames.
        Their activities are compared.

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
    # `dict.fromkeys` removes duplicates and keeps the order.
    people = tuple(dict.fromkeys(who for sides in labelled.values() for who in sides))
    truths = {
        name: {who: _make_truth(found) for who, found in sides.items()}
        for name, sides in several.items()
    }
    by: By = "names" if _have_names_in_common(several, truths) else "mapping"
    classes = _ClassNumbers(truths, by)
    pairs = tuple(classes.compare_pair(first, second) for first, second in combinations(people, 2))
    stacks = classes.stack_classes(people[0])
    # Recordings that all people labelled.
    complete = [stacks[name] for name, sides in truths.items() if len(sides) == len(people)]
    overall = (
        fleiss_kappa(_count_annotators(np.concatenate(complete, axis=1))) if complete else math.nan
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
    return AnnotatorAgreement(people, by, overall, pairs, recordings)


class _ClassNumbers:
    """Classes of all frames as numbers, shared by all people if they are compared by name."""

    def __init__(self, truths: Truths, by: By):
        self._truths, self._by = truths, by
        self._numbers: dict[tuple[str, str], int] = {}
        self._classes = {
            name: {who: self._number_classes(who, truth) for who, truth in sides.items()}
            for name, sides in truths.items()
        }

    def compare_pair(self, first: str, second: str) -> Pair:
        """Measure the agreement of two people."""
        compared = self._compare(first, second)
        if not compared:
            return Pair(first, second, cohen_kappa=math.nan, border_f1=math.nan, recordings=0)
        # All recordings as one, with a common mapping.
        both = Comparison(
            np.concatenate([one.truth for one in compared]),
            np.concatenate([one.found for one in compared]),
            compared[0].fps,
            self._make_mapping(compared),
            transitions=True,
        )
        # Each is the truth in turn, as only borders of the truth have a tolerance.
        borders = [border_score(one).f1 for one in (*compared, *self._compare(second, first))]
        return Pair(first, second, cohen_kappa(both), float(np.mean(borders)), len(compared))

    def stack_classes(self, first: str) -> dict[str, Ints]:
        """Return the classes (annotators, frames) of each recording, as classes of ``first``."""
        mappings: dict[str, Mapping[int, int]] = {}
        for who in {who for sides in self._truths.values() for who in sides} - {first}:
            compared = self._compare(first, who)
            mappings[who] = self._make_mapping(compared) if compared else {}
        return {
            name: np.array([_map_classes(row, mappings.get(who, {})) for who, row in sides.items()])
            for name, sides in self._classes.items()
        }

    def _number_classes(self, who: str, truth: Truth) -> Ints:
        """Return the number of the class of each frame."""
        labelling = truth.labelling()
        keys = [
            ("" if self._by == "names" else who, _normalize_label(label))
            for label in labelling.labels
        ]
        # Numbers are shared by all recordings; with a mapping, people have separate ones.
        values = [
            UNLABELLED
            if name == TRANSITION
            else self._numbers.setdefault((person, name), len(self._numbers))
            for person, name in keys
        ]
        return np.repeat(np.array(values, np.int64), np.diff(labelling.borders))

    def _compare(self, truth: str, found: str) -> list[Comparison]:
        """Compare two people on each recording that both labelled."""
        return [
            Comparison(
                self._classes[name][truth],
                self._classes[name][found],
                sides[truth].fps,
                transitions=True,
                # Only borders of the truth are spans; those of the second person are exact.
                intervals=Spans(sides[truth], sides[found].labelling(), sides[found].labelling()),
            )
            for name, sides in self._truths.items()
            if {truth, found} <= sides.keys()
        ]

    def _make_mapping(self, compared: Sequence[Comparison]) -> Mapping[int, int]:
        if self._by == "mapping":
            return map_clusters(compared)
        return {number: number for number in (UNLABELLED, *self._numbers.values())}


def _make_truth(found: Segmentation) -> Truth:
    n_frames, fps = choose_comparison_rate(found.n_frames, found.fps)
    truth = make_truth(found, n_frames=n_frames, fps=fps)
    return Truth.from_labelling(truth.labelling().merged())


def _normalize_label(label: str) -> str:
    """Normalise white space and case of a label."""
    return " ".join(label.split()).casefold()


def _have_names_in_common(labelled: Labelled, truths: Truths) -> bool:
    """Return whether people name all activities, and any two share enough names."""
    names: dict[str, set[str]] = {}
    for recording, sides in truths.items():
        for who, truth in sides.items():
            rows = labelled[recording][who].activities
            if any(row.kind == "activity" and not row.label for row in rows):
                return False
            found = {_normalize_label(label) for label in truth.labels} - {TRANSITION}
            names.setdefault(who, set()).update(found)
    pairs = combinations(names.values(), 2)
    return all(len(a & b) >= MIN_SHARED_NAMES * min(len(a), len(b)) for a, b in pairs)


def _map_classes(classes: Ints, mapping: Mapping[int, int]) -> Ints:
    """Map classes; classes that the mapping does not contain stay the same."""
    # Map each distinct class once, then expand to frames.
    numbers, inverse = np.unique(classes, return_inverse=True)
    return np.array([mapping.get(int(n), int(n)) for n in numbers], np.int64)[inverse]


def _count_annotators(stack: Ints) -> Ints:
    """Count the annotators that assigned each frame to each class, (frames, classes)."""
    # Rows of the stack are annotators, so the sum over rows counts them.
    classes = np.unique(stack)
    return np.stack([(stack == each).sum(axis=0) for each in classes], axis=1)


def _find_differences(sides: Sequence[Truth], stack: Ints) -> Iterator[Difference]:
    """Yield the spans in which the rows of a stack differ, with the label of each side."""
    labels = [side.labelling().per_frame() for side in sides]
    fps, least = sides[0].fps, sides[0].tolerance_s * sides[0].fps
    # Number the distinct columns: a run of one number has constant labels.
    _, columns = np.unique(stack, axis=1, return_inverse=True)
    for run in find_runs(columns.ravel()):
        # Shorter differences are only small shifts of a border.
        if run.stop - run.start > least and (stack[:, run.start] != stack[0, run.start]).any():
            names = ("" if (name := each[run.start]) == TRANSITION else name for each in labels)
            yield Difference(run.start / fps, run.stop / fps, tuple(names))


def read_extent(path: Path) -> Extent:
    """Read the extent of the recording in a file."""
    from kineme.formats import read

    recording = read(path)
    return Extent(recording.n_frames, recording.fps, recording.provenance.clock)


def gather_labels(
    sources: Mapping[str, Mapping[Path, LabelSource]],
    extent: Callable[[Path], Extent] = read_extent,
) -> tuple[dict[str, dict[str, Segmentation]], list[str]]:
    """Read the labels of the recordings that at least two people labelled.

    ``sources`` are by annotator and recording, see `kineme.labels.collections.find_labels`. Return
    the labels by recording and annotator, and one sentence for each failure. Recordings are
    identified by name, or by path if names are not unique.
    """
    paths = list(dict.fromkeys(path for by_path in sources.values() for path in by_path))
    names = [path.name for path in paths]
    labelled: dict[str, dict[str, Segmentation]] = {}
    failures: list[str] = []
    # A failure is reported and does not affect the other recordings and people.
    for path in sorted(paths):
        found = {who: by_path[path] for who, by_path in sources.items() if path in by_path}
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
                    failures.append(f"{name}, {who}: {source.path} has no labels for it")
                    del sides[who]
    return labelled, failures


def name_annotators(paths: Sequence[Path]) -> list[str]:
    """Return distinct names for the files or folders of people, with parent folders if needed.

    Examples
    --------
    >>> name_annotators([Path("labels/anna"), Path("labels/ben.csv")])
    ['anna', 'ben']
    >>> name_annotators([Path("anna/labels.csv"), Path("ben/labels.csv")])
    ['anna/labels', 'ben/labels']
    """
    absolute = [path.absolute() for path in paths]
    stems = [path if path.is_dir() else path.with_suffix("") for path in absolute]
    # Add parent folders until all names differ.
    for parts in range(1, max(len(path.parts) for path in stems) + 1):
        names = ["/".join(path.parts[-parts:]) for path in stems]
        if len(set(names)) == len(names):
            return names
    return [str(path) for path in paths]
