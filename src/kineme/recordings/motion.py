"""Skeleton and Motion: who moves, and how.

Positions are metres, y is up, axes are right-handed; the frame rate is a
float. Rotations are unit quaternions ``(w, x, y, z)``, each from the joint's
own frame to its parent's.

A joint sits where its rotation acts, and its offset is carried by the parent::

    G[j] = G[parent] * R[j]
    p[j] = p[parent] + G[parent] @ offset[j]

An end site is a leaf without rotation of its own (a fingertip, the crown of
the head).

Both classes are values: their arrays are read-only views, and every change
(see `kineme.recordings.operations`) makes a new object.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import cached_property
from operator import index

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import as_floats, as_spans, as_texts, check_type, is_number
from kineme.errors import MotionError, ParameterError
from kineme.recordings.kinematics import (
    forward_kinematics,
    local_translations,
    world_rotations,
)

Floats = NDArray[np.float64]

__all__ = [
    "Motion",
    "Provenance",
    "Skeleton",
    "forward_kinematics",
    "local_translations",
    "world_rotations",
]


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A tree of joints, parents before children.

    Parameters
    ----------
    names : one per joint, unique
    parents : index of each joint's parent, -1 for a root
    offsets : (joints, 3), from parent to joint at rest, metres
    end_sites : indices of the leaves that have no rotation of their own

    Raises
    ------
    MotionError : the parts differ in length, a name repeats, or a parent does
        not come before its child (as in a cycle)
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: Floats
    end_sites: frozenset[int] = frozenset()

    def __post_init__(self) -> None:
        try:
            _set(self, names=as_texts(self.names, "names of joints", error=MotionError))
            _set(self, parents=tuple(index(p) for p in self.parents))
            _set(self, end_sites=frozenset(index(joint) for joint in self.end_sites))
        except TypeError:
            raise MotionError(
                "parents and end sites of a skeleton are lists of joints, by whole numbers"
            ) from None
        _set(self, offsets=_frozen(self.offsets, "offsets"))
        n = len(self.names)
        if n == 0:
            raise MotionError("a skeleton needs at least one joint")
        if len(self.parents) != n or self.offsets.shape != (n, 3):
            raise MotionError(
                f"{n} names, {len(self.parents)} parents and offsets of shape "
                f"{self.offsets.shape} do not describe one skeleton"
            )
        if len(set(self.names)) != n:
            twice = next(name for name in self.names if self.names.count(name) > 1)
            raise MotionError(f"two joints are called {twice!r}: rename one of them")
        for joint, parent in enumerate(self.parents):
            if not -1 <= parent < joint:
                raise MotionError(
                    f"joint {self.names[joint]!r} (index {joint}) has parent {parent}: "
                    "parents come before their children, and a root has -1"
                )
        inner = self.end_sites & ({*self.parents} | {-1} | {*self.end_sites} - {*range(n)})
        if inner:
            raise MotionError(f"end site {min(inner)} is not a leaf of the skeleton")

    def joint(self, name: str) -> int:
        """The index of the joint called ``name``; ParameterError if there is none."""
        try:
            return self._index[name]
        except (KeyError, TypeError):
            close = get_close_matches(str(name), self.names, n=3) or self.names[:5]
            raise ParameterError(
                f"no joint is called {name!r}; did you mean {_listed(close)}?"
            ) from None

    @property
    def n_joints(self) -> int:
        return len(self.names)

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """For each joint the indices of its children, in order."""
        lists: list[list[int]] = [[] for _ in self.names]
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                lists[parent].append(joint)
        return tuple(map(tuple, lists))

    @cached_property
    def _index(self) -> dict[str, int]:
        return {name: i for i, name in enumerate(self.names)}


@dataclass(frozen=True)
class Provenance:
    """Where a motion came from, and everything that had to be inferred.

    ``notes`` are sentences such as "frame rate 120 Hz assumed: AMC files do
    not store one". ``events`` are those marked in the file: the second, from
    its first frame, and the label.
    """

    path: str | None = None
    format: str | None = None
    sha256: str | None = None
    notes: tuple[str, ...] = ()
    events: tuple[tuple[float, str], ...] = ()

    def noted(self, *sentences: str) -> Provenance:
        """The same with sentences added."""
        return replace(self, notes=self.notes + sentences)

    def marked(self, events: Iterable[tuple[float, str]]) -> Provenance:
        """The same with these events in place of its own."""
        return replace(self, events=tuple(events))


@dataclass(frozen=True, eq=False)
class Motion:
    """A skeleton's joint positions over time, and its rotations where known.

    Parameters
    ----------
    skeleton : Skeleton
    positions : (frames, joints, 3), metres, y up
    fps : frames per second
    rotations : (frames, joints, 4) unit quaternions (w, x, y, z), local to the
        parent, or None
    provenance : Provenance
    gaps : frames [start, stop) in which the body was not seen, in time order and
        apart from each other; positions in them only join what is around

    Raises
    ------
    MotionError : shapes disagree, no frames, values that are not finite, or
        gaps out of order
    """

    skeleton: Skeleton
    positions: Floats
    fps: float
    rotations: Floats | None = None
    provenance: Provenance = field(default_factory=Provenance)
    gaps: tuple[tuple[int, int], ...] = ()

    def __post_init__(self) -> None:
        check_type(self.skeleton, Skeleton, "Motion", "then positions and fps", error=MotionError)
        if not (is_number(self.fps) and self.fps > 0):
            raise MotionError(f"the frame rate is {self.fps!r:.60}: it must be a positive number")
        _set(self, positions=_frozen(self.positions, "positions"), fps=float(self.fps))
        joints = self.skeleton.n_joints
        if self.positions.ndim != 3 or self.positions.shape[1:] != (joints, 3):
            raise MotionError(
                f"positions have shape {self.positions.shape}, not (frames, {joints}, 3)"
            )
        if self.n_frames == 0:
            raise MotionError("a motion needs at least one frame")
        _set(self, gaps=as_spans(self.gaps, error=MotionError))
        _check_gaps(self.gaps, self.n_frames)
        if self.rotations is None:
            return
        _set(self, rotations=_frozen(self.rotations, "rotations"))
        if self.rotations.shape != (self.n_frames, joints, 4):
            raise MotionError(
                f"rotations have shape {self.rotations.shape}, not ({self.n_frames}, {joints}, 4)"
            )
        norm = np.einsum("fjc,fjc->fj", self.rotations, self.rotations)
        if np.abs(norm - 1).max() > 1e-6:
            raise MotionError("rotations are not unit quaternions: divide them by their norm")

    @classmethod
    def from_rotations(
        cls,
        skeleton: Skeleton,
        rotations: ArrayLike,
        fps: float,
        root_positions: ArrayLike | None = None,
        *,
        translations: ArrayLike | None = None,
        provenance: Provenance | None = None,
    ) -> Motion:
        """The motion whose positions follow from rotations (see `forward_kinematics`)."""
        positions = forward_kinematics(
            skeleton, rotations, root_positions, translations=translations
        )
        return cls(
            skeleton, positions, fps, np.asarray(rotations, float), provenance or Provenance()
        )

    def __repr__(self) -> str:
        return (
            f"<Motion of {self.n_frames} frames ({self.duration:.1f} s) at {self.fps:g} Hz: "
            f"{self.skeleton.n_joints} joints, {len(self.skeleton.end_sites)} of them end sites>"
        )

    @property
    def n_frames(self) -> int:
        return len(self.positions)

    @property
    def duration(self) -> float:
        """Seconds: frames / fps."""
        return self.n_frames / self.fps

    @property
    def times(self) -> Floats:
        """The second at which each frame was taken, from 0."""
        return np.arange(self.n_frames) / self.fps

    def joint(self, name: str) -> int:
        """The index of the joint called ``name``; ParameterError if there is none."""
        return self.skeleton.joint(name)


def check_motion(motion: object, door: str) -> None:
    """ParameterError where a public function was given no Motion."""
    check_type(motion, Motion, door, "kineme.read(path) gives one")


def _check_gaps(gaps: tuple[tuple[int, int], ...], n_frames: int) -> None:
    before = -1
    for start, stop in gaps:
        if not before < start < stop <= n_frames:
            raise MotionError(
                f"gap {start} to {stop} is not a stretch of {n_frames} frames after the one before"
            )
        before = stop


def _frozen(values: ArrayLike, what: str) -> Floats:
    """A read-only float64 view, C-contiguous and finite."""
    array = np.ascontiguousarray(as_floats(values, what, error=MotionError)).view()
    if not np.isfinite(array).all():
        raise MotionError(f"{what} hold values that are not finite (NaN or infinite)")
    array.flags.writeable = False
    return array


def _set(instance: object, **values: object) -> None:
    """Assign fields of a frozen dataclass while it is being made."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(map(repr, names))
