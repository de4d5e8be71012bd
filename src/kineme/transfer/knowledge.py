"""Labelled primitives of any recordings, ready to be searched.

A primitive is its label, where it comes from, and its features, fifteen times a
second (see `kineme.features.canonical.matching`): those of a body that is the
same for all. People, skeletons and frame rates may therefore differ.

It is kept as one ``.npz``, a zip of plain numpy arrays, no pickle:

============ ================ ==================================================
``head``     text             JSON: ``schema`` (``kineme.knowledge/2``), ``kineme``
                              (version that wrote it), ``fps``, ``offsets_s`` and
                              ``unit`` of the features
``features`` float32 (n, 40)  frames of all primitives end to end, unit vectors
``lengths``  int64            frames of each primitive; the others go with it
``labels``   text             its name
``sources``  text             file name of the recording
``digests``  text             SHA-256 of the file, with the person of several, or empty
``start_s``  float64          where it starts in the recording, seconds
``stop_s``   float64          where it stops
============ ================ ==================================================

Any program with numpy reads it. A reader ignores arrays it does not know; a
change that old readers would misunderstand gets the next number.

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
from kineme.features.canonical.matching import DIMS, MATCHING_FPS, OFFSETS_S, matching_features
from kineme.features.effectors import Names
from kineme.formats.arrays.numpy_files import read_arrays
from kineme.formats.files import load
from kineme.recordings import Motion
from kineme.recordings.motion import check_motion
from kineme.segments.segmentation import Segmentation
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


def _write(
    arrays: dict[str, NDArray[Any]], settings: dict[str, Any], path: str | PathLike[str]
) -> None:
    """Leave a knowledge base's arrays at ``path``; ``settings`` are those of its features."""
    if Path(path).suffix.lower() != ".npz":
        raise WriteError(path, "a knowledge base is a .npz file: name it so")
    head = json.dumps({"schema": SCHEMA, "kineme": __version__, **settings})
    with atomic_write(path) as draft, draft.open("wb") as file:
        np.savez(file, allow_pickle=False, head=np.array(head), **arrays)


def _read(path: str | PathLike[str], settings: dict[str, Any]) -> dict[str, NDArray[Any]]:
    """Return the arrays of the knowledge base at ``path``; ReadError for other settings."""
    if not Path(path).exists():
        raise ReadError(path, "cannot be read: there is no such file")
    content = load(path)
    try:
        found = read_arrays(content)
        head = decode_json(str(found["head"]), path)
    except KeyError as error:
        raise ReadError(path, "is not a knowledge base: it has no head") from error
    except (ReadError, ValueError) as error:
        reason = f": {error.reason}" if isinstance(error, ReadError) else ""
        raise ReadError(path, f"is not a knowledge base, or is damaged{reason}") from error
    _check_head(head, settings, path)
    if missing := [name for name in KINDS if name not in found]:
        raise ReadError(path, f"is not a knowledge base, or is damaged: it has no {missing[0]!r}")
    arrays = {name: found[name] for name in KINDS}
    for name, kind in KINDS.items():
        if arrays[name].dtype.kind != kind:
            raise ReadError(path, f"is damaged: {name} holds {arrays[name].dtype}")
    return arrays | {name: arrays[name].astype(kind) for name, kind in TYPES.items()}


def _check_head(head: Any, settings: dict[str, Any], path: str | PathLike[str]) -> None:
    schema = head.get("schema") if isinstance(head, dict) else head
    if schema != SCHEMA:
        reason = f"is of version {schema!r}, this kineme reads {SCHEMA}: label its recordings again"
        raise ReadError(path, reason)
    for name, value in settings.items():
        if head.get(name) != value:
            reason = f"has features with {name} {head.get(name)}, not {value}: build it again"
            raise ReadError(path, reason)


def holds_knowledge(path: Path) -> bool:
    """Return whether a file is a knowledge base, as far as the directory of its archive tells."""
    if path.suffix.lower() != ".npz":
        return False
    try:
        with zipfile.ZipFile(path) as parts:
            return {"head.npy", "lengths.npy", "labels.npy"} <= set(parts.namelist())
    except (OSError, zipfile.BadZipFile, NotImplementedError, ValueError, LookupError):
        return False


FPS = MATCHING_FPS
SETTINGS = {"fps": FPS, "offsets_s": list(OFFSETS_S), "unit": "directions"}


@dataclass(frozen=True, eq=False)
class KnowledgeBase:
    """Labelled primitives; primitive p is the next ``lengths[p]`` samples of ``features``.

    Usually made by `from_recording`, `merged` or `load`.

    Parameters
    ----------
    features : (samples, 40) array of float32
        As `transfer_features` gives them.
    lengths : (primitives,) array of int
        Samples of each primitive.
    labels : (primitives,) array of str
        Name of each.
    sources : (primitives,) array of str
        File name of the recording that each comes from.
    digests : (primitives,) array of str
        SHA-256 of that file, empty where there is none.
    start_s, stop_s : (primitives,) array of float
        Where in the recording, seconds.

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
        if self.features.ndim != 2 or self.features.shape[1] != DIMS:
            raise ParameterError(f"features must be frames x {DIMS}, not {self.features.shape}")
        for name, column in self.columns().items():
            if column.shape != self.labels.shape or column.ndim != 1:
                raise ParameterError(f"{name} and labels must be of the same length")
        if len(self) and self.lengths.min() < 1:
            raise ParameterError("a primitive has at least 1 frame")
        if self.lengths.sum() != len(self.features):
            raise ParameterError(
                f"lengths add up to {self.lengths.sum()} frames, there are {len(self.features)}"
            )
        if not all(self.labels.tolist()):
            raise ParameterError("every primitive needs a label")
        if not np.isfinite(self.features).all():
            raise ParameterError("features must be finite")

    @classmethod
    def from_recording(
        cls, motion: Motion, segments: Segmentation, *, effectors: Names | None = None
    ) -> Self:
        """Return the labelled primitives of a recording.

        Parameters
        ----------
        motion : Motion
        segments : Segmentation
            Of this recording. A primitive without a label takes that of its activity;
            where there are no primitives, labelled activities are taken for such.
            Transitions are left out.
        effectors : joints, optional
            To take for head, hands and feet where names do not tell.

        Returns
        -------
        KnowledgeBase

        Raises
        ------
        EndEffectorError
            Head, hands or feet were not found.
        ParameterError
            The segments are of a recording of another length, or none is labelled.
        """
        check_motion(motion, "from_recording")
        check_type(segments, Segmentation, "from_recording", "kineme.segment(motion) gives one")
        if segments.n_frames != motion.n_frames:
            raise ParameterError(
                f"the segments are of {segments.n_frames} frames, the motion has {motion.n_frames}"
            )
        rows = _select_labelled(segments)
        features = matching_features(motion, effectors=effectors)
        starts, stops = find_working_frames(rows, segments.fps, len(features))
        source = motion.provenance
        path, digest = source.path, source.sha256
        if digest and len(source.people) > 1:
            digest = f"{digest} {source.person}"
        return cls(
            np.concatenate([features[a:b] for a, b in zip(starts, stops, strict=True)]),
            stops - starts,
            rows.label,
            np.full(len(rows), Path(path).name if path else ""),
            np.full(len(rows), digest or ""),
            rows.start_s,
            rows.stop_s,
        )

    @classmethod
    def merged(cls, *bases: KnowledgeBase) -> Self:
        """Return all primitives of all; of a recording that several hold, those of the last.

        Raises
        ------
        ParameterError
            None is given.
        """
        if not bases:
            raise ParameterError("nothing to merge: give at least one knowledge base")
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
        """Return the knowledge base in a file that `save` wrote.

        Raises
        ------
        ReadError
            Missing, damaged, no knowledge base, or of another version.
        """
        with translate_read_errors(path):
            return cls(**_read(path, SETTINGS))

    def save(self, path: str | PathLike[str]) -> None:
        """Write all of it to one ``.npz`` file, or leave what is there as it was.

        Raises
        ------
        WriteError
            Another suffix, or the file cannot be written.
        """
        _write({"features": self.features, **self.columns()}, SETTINGS, path)

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return what is known of each primitive, by name, without the features."""
        names = ("lengths", "labels", "sources", "digests", "start_s", "stop_s")
        return {name: getattr(self, name) for name in names}

    def select(self, mask: NDArray[np.bool_]) -> Self:
        """Return the primitives where the mask is true."""
        columns = {name: column[mask] for name, column in self.columns().items()}
        return replace(self, features=self.features[np.repeat(mask, self.lengths)], **columns)

    def counts(self) -> dict[str, int]:
        """Return how many primitives bear each label."""
        return dict(sorted(Counter(self.labels.tolist()).items()))

    def primitives(self) -> Primitives:
        """Return the primitives to search; those that touch under one label are one run."""
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
    """Return the rows to learn from, with their labels."""
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


def find_working_frames(
    rows: SegmentTable, fps: float, n_features: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First frame and end of each row in the features; at least one frame each."""
    starts = np.minimum(np.rint(rows.start_frame * (FPS / fps)).astype(np.int64), n_features - 1)
    stops = np.minimum(np.rint(rows.stop_frame * (FPS / fps)).astype(np.int64), n_features)
    return starts, np.maximum(stops, starts + 1)
