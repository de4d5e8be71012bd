"""Skeleton and Motion: who moves, and how.

Positions are metres, y is up, axes are right-handed; the frame rate is a
float. Rotations are unit quaternions ``(w, x, y, z)``, each from the joint's
own frame to its parent's.

A joint sits where its rotation acts, and its offset is carried by the parent::

    G[j] = G[parent] * R[j]
    p[j] = p[parent] + G[parent] @ offset[j]

An end site is a leaf without rotation of its own (a fingertip, the crown of
the head).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import MotionError, ParameterError

Floats = NDArray[np.float64]


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


@dataclass(frozen=True)
class Provenance:
    """Where a motion came from, and everything that had to be inferred.

    ``notes`` are sentences such as "frame rate 120 Hz assumed: AMC files do
    not store one".
    """

    path: str | None = None
    format: str | None = None
    sha256: str | None = None
    notes: tuple[str, ...] = ()


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

    Raises
    ------
    MotionError : shapes disagree, no frames, or values that are not finite
    """

    skeleton: Skeleton
    positions: Floats
    fps: float
    rotations: Floats | None = None
    provenance: Provenance = field(default_factory=Provenance)
