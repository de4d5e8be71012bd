"""Knowledge base: labelled primitives of any recordings, for label transfer.

A primitive consists of its label, its source, and its matching features, fifteen per second (see
`kineme.features.canonical`). These are features of a canonical body, so people, skeletons and frame
rates may differ.

A knowledge base is stored as one ``.npz``, a zip of plain numpy arrays without pickle:

============ ================ ==================================================
``head``     text             JSON: ``schema`` (``kineme.knowledge/2``), ``kineme``
                              (version that wrote it), ``fps``, ``offsets_s`` and
                              ``unit`` of the features
``features`` float32 (n, 40)  frames of all primitives end to end, unit vectors
``lengths``  int64            frames of each primitive; one entry per primitive, as below
``labels``   text             its name
``sources``  text             file name of the recording
``digests``  text             SHA-256 of the file, with the person if there are several
``start_s``  float64          where it starts in the recording, seconds
``stop_s``   float64          where it stops
============ ================ ==================================================

Readers ignore unknown arrays. A change that old readers would misunderstand gets a new schema
number.

Source: Vögele, Krüger and Klein 2014, section 6.1.
"""

from __future__ import annotations

import json
import zipfile
from collections import Counter
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import check_type, format_count
from kineme._util.files import atomic_write, translate_read_errors
from kineme._util.json import decode_json
from kineme._version import __version__
from kineme.errors import ParameterError, ReadError, WriteError
from kineme.features.canonical import FEATURE_DIMS, MATCHING_FPS, OFFSETS_S, matching_features
from kineme.features.effectors import Names
from kineme.formats.arrays.numpy_files import read_arrays
from kineme.formats.files import load
from kineme.recordings import Motion
from kineme.recordings.motion import check_motion
from kineme.segments.segmentation import Segmentation, check_same_length
from kineme.segments.table import SegmentTable
from kineme.transfer.matching import Primitives

SCHEMA = "kineme.knowledge/2"
KINDS = {
    "features": "f",
    "lengths": "i",
    "labels": "U",
    "sources": "U",
    "digests": "U",
    "start_s": "f",
    "stop_s": "f",
}
TYPES = {"features": np.float32, "lengths": np.int64}
FPS = MATCHING_FPS
SETTINGS = {"fps": FPS, "offsets_s": list(OFFSETS_S), "unit": "directions"}


@dataclass(frozen=True, eq=False)
class KnowledgeBase:
    """Labelled primitives, whose samples are stored one after another in ``features``.

    It is usually created by `from_recording`, `merged` or `load`.

    Parameters
    ----------
    features : (samples, 40) array of float32
        As returned by `transfer_features`.
    lengths : (primitives,) array of int
        Number of samples of each primitive.
    labels : (primitives,) array of str
        Label of each.
    sources : (primitives,) array of str
        File name of the recording of each.
    digests : (primitives,) array of str
        SHA-256 of this file, or empty.
    start_s, stop_s : (primitives,) array of float
        Start and stop in the recording, seconds.

    Raises
    ------
    ParameterError
        Columns of different length, an empty label, or values that are not finite.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> motion = kineme.read(bundled_recording())
    >>> truth = kineme.read_segments(bundled_truth(), fps=motion.fps, n_frames=motion.n_frames)
    >>> kineme.KnowledgeBase.from_recording(motion, truth).counts()["squat"]
    4
    """

    features: NDArray[np.float32]
    lengths: NDArray[np.int64]
    labels: NDArray[np.str_]
    sources: NDArray[np.str_]
    digests: NDArray[np.str_]
    start_s: NDArray[np.float64]
    stop_s: NDArray[np.float64]

    def __post_init__(self) -> None:
        if self.features.ndim != 2 or self.features.shape[1] != FEATURE_DIMS:
            raise ParameterError(
                f"features must be frames x {FEATURE_DIMS}, not {self.features.shape}"
            )
        for name, column in self.columns().items():
            if column.shape != self.labels.shape or column.ndim != 1:
                raise ParameterError(f"{name} and labels must be of the same length")
        if len(self) and self.lengths.min() < 1:
            raise ParameterError(f"lengths must be at least 1 frame, not {self.lengths.min()}")
        if self.lengths.sum() != len(self.features):
            raise ParameterError(
                f"lengths add up to {self.lengths.sum()} frames, but there are {len(self.features)}"
            )
        if not all(self.labels.tolist()):
            raise ParameterError("every primitive needs a label")
        if not np.isfinite(self.features).all():
            raise ParameterError("features must be finite")

    @classmethod
    def from_recording(
        cls, motion: Motion, segments: Segmentation, *, effectors: Names | None = None
    ) -> Self:
        """Create a knowledge base of the labelled primitives of a recording.

        Parameters
        ----------
        motion : Motion
        segments : Segmentation
            Segments of this recording. A primitive without a label takes that of its
            activity. Without primitives, labelled activities are used. Transitions are
            left out.
        effectors : joints, optional
            Joints to use as head, hands and feet if their names are not recognised.

        Raises
        ------
        EndEffectorError
            Head, hands or feet were not found.
        ParameterError
            The segments belong to a recording of another length, or none is labelled.
        """
        check_motion(motion, "from_recording")
        check_type(segments, Segmentation, "from_recording", "kineme.segment(motion) gives one")
        check_same_length(segments, motion.n_frames)
        rows = _select_labelled(segments)
        features = matching_features(motion, effectors=effectors)
        source = motion.provenance
        path, digest = source.path, source.sha256
        # Several people in one file are distinct sources.
        if digest and len(source.people) > 1:
            digest = f"{digest} {source.person}"
        return cls(
            *join_features(rows, segments.fps, features),
            rows.label,
            np.full(len(rows), Path(path).name if path else ""),
            np.full(len(rows), digest or ""),
            rows.start_s,
            rows.stop_s,
        )

    @classmethod
    def merged(cls, *bases: KnowledgeBase) -> Self:
        """Merge knowledge bases; of a recording in several of them, the last one is used.

        Raises
        ------
        ParameterError
            No knowledge base is given.
        """
        if not bases:
            raise ParameterError("nothing to merge: give at least one knowledge base")
        # Drop primitives whose recording is also in a later knowledge base.
        kept = []
        for number, base in enumerate(bases):
            later = {d for other in bases[number + 1 :] for d in set(other.digests.tolist()) if d}
            kept.append(base.select(~np.isin(base.digests, list(later))))
        columns = [{"features": base.features, **base.columns()} for base in kept]
        return cls(
            **{name: np.concatenate([each[name] for each in columns]) for name in columns[0]}
        )

    def __add__(self, other: KnowledgeBase) -> Self:
        return self.merged(self, other)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Load a knowledge base from a file written by `save`.

        Raises
        ------
        ReadError
            The file is missing, damaged, not a knowledge base, or of another version.
        """
        with translate_read_errors(path):
            return cls(**_read(path))

    def save(self, path: str | PathLike[str]) -> None:
        """Write the knowledge base to one ``.npz`` file; on failure an existing file is kept.

        Raises
        ------
        WriteError
            The suffix is not ``.npz``, or the file cannot be written.
        """
        if Path(path).suffix.lower() != ".npz":
            raise WriteError(path, "a knowledge base must be a .npz file: change the suffix")
        head = np.array(json.dumps({"schema": SCHEMA, "kineme": __version__, **SETTINGS}))
        arrays = {"features": self.features, **self.columns()}
        with atomic_write(path) as draft, draft.open("wb") as file:
            np.savez(file, allow_pickle=False, head=head, **arrays)

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return the columns with one entry per primitive, by name."""
        return {name: getattr(self, name) for name in KINDS if name != "features"}

    def select(self, mask: NDArray[np.bool_]) -> Self:
        """Return the primitives for which the mask is True."""
        columns = {name: column[mask] for name, column in self.columns().items()}
        return replace(self, features=self.features[np.repeat(mask, self.lengths)], **columns)

    def counts(self) -> dict[str, int]:
        """Return the number of primitives of each label."""
        return dict(sorted(Counter(self.labels.tolist()).items()))

    def primitives(self) -> Primitives:
        """Return the primitives for matching; adjacent ones with the same label form a run."""
        # A run continues if neighbours are adjacent and equal in these columns.
        follows = self.start_s[1:] == self.stop_s[:-1]
        for column in (self.labels, self.sources, self.digests):
            follows &= column[1:] == column[:-1]
        runs = np.concatenate([[0], np.cumsum(~follows)])[: len(self)]
        return Primitives(self.features, self.lengths, runs)

    def __len__(self) -> int:
        return len(self.labels)

    def __repr__(self) -> str:
        labels = ", ".join(f"{label} {count}" for label, count in self.counts().items())
        return f"<KnowledgeBase of {format_count(len(self), 'primitive')}: {labels}>"


def _select_labelled(segments: Segmentation) -> SegmentTable:
    """Return the labelled rows of a segmentation: primitives, or else activities."""
    # Primitives inherit the label of their activity.
    rows = segments.primitives
    if len(rows):
        inherited = segments.activities.label[rows.activity]
        rows = rows.with_columns(label=np.where(rows.label == "", inherited, rows.label))
    else:
        rows = segments.activities
    rows = rows.select((rows.label != "") & (rows.kind != "transition"))
    if not len(rows):
        raise ParameterError("no activity has a label: there is nothing to learn")
    return rows


def join_features(
    rows: SegmentTable, fps: float, features: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Return the features of all rows end to end, and the number of samples of each, at least one.

    Features have their own rate, to which spans of frames are converted.
    """
    n = len(features)
    starts = np.minimum(np.rint(rows.start_frame * (FPS / fps)).astype(np.int64), n - 1)
    stops = np.minimum(np.rint(rows.stop_frame * (FPS / fps)).astype(np.int64), n)
    stops = np.maximum(stops, starts + 1)
    parts = [features[a:b] for a, b in zip(starts, stops, strict=True)]
    return np.concatenate(parts), stops - starts


def _read(path: str | PathLike[str]) -> dict[str, NDArray[Any]]:
    """Read the arrays of the knowledge base at ``path``; raise ReadError for other settings."""
    if not Path(path).exists():
        raise ReadError(path, "cannot be read: there is no such file")
    content = load(path)
    try:
        stored = read_arrays(content)
        head = decode_json(str(stored["head"]), path)
    except KeyError as error:
        raise ReadError(path, "is not a knowledge base: it has no head") from error
    except (ReadError, ValueError) as error:
        reason = f": {error.reason}" if isinstance(error, ReadError) else ""
        raise ReadError(path, f"is not a knowledge base, or is damaged{reason}") from error
    _check_head(head, path)
    if missing := [name for name in KINDS if name not in stored]:
        raise ReadError(path, f"is not a knowledge base, or is damaged: it has no {missing[0]!r}")
    arrays = {name: stored[name] for name in KINDS}
    for name, kind in KINDS.items():
        if arrays[name].dtype.kind != kind:
            raise ReadError(path, f"is damaged: {name} holds {arrays[name].dtype}")
    return arrays | {name: arrays[name].astype(kind) for name, kind in TYPES.items()}


def _check_head(head: Any, path: str | PathLike[str]) -> None:
    """Raise ReadError if the format or the features are not those of this version."""
    stated = head if isinstance(head, dict) else {"schema": head}
    for name, value in {"schema": SCHEMA, **SETTINGS}.items():
        if stated.get(name) != value:
            reason = f"has {name} {stated.get(name)!r}, not {value!r}: build it again"
            raise ReadError(path, reason)


def holds_knowledge(path: Path) -> bool:
    """Return whether a file is a knowledge base, judged by the file names in its archive."""
    if path.suffix.lower() != ".npz":
        return False
    try:
        with zipfile.ZipFile(path) as parts:
            return {"head.npy", "lengths.npy", "labels.npy"} <= set(parts.namelist())
    except (OSError, zipfile.BadZipFile, NotImplementedError, ValueError, LookupError):
        return False
