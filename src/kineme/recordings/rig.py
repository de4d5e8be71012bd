"""Rig that a skeleton came from: the nodes of its file as they are at rest.

A `Skeleton` says where joints are in metres with y up. A `Rig` keeps what a writer needs to put
the file's own nodes back: those above the hips, and the rotation and scale that each has at rest.
A node's transform in its parent's frame is x -> t + R s x, with one positive scale s.

With W the rotation of a joint's node in the axes of the file, and G that of the joint in the
motion (see `kineme.recordings.skeleton`)::

    G = turn * W * axes
    p = unit * turn @ (position of the node)

So poses of the nodes follow from any motion of the skeleton, whatever was done to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import MotionError
from kineme.recordings.arrays import assign, freeze

UNIFORM = 1e-4
"""Share by which a node's scales along its three axes may differ and count as one."""


@dataclass(frozen=True, eq=False)
class Rig:
    """Nodes at rest, in the units and axes of their file; the last ones are the joints.

    Parameters
    ----------
    names : tuple of str
        One per node, as in the file.
    parents : tuple of int
        The index of each node's parent, which comes before it; -1 for none.
    translations, rotations, scales : array_like, shape (nodes, 3), (nodes, 4), (nodes, 3)
        In the parent's frame; rotations are unit quaternions (w, x, y, z).
    axes : array_like, shape (joints, 4)
        The rotation from the axes of each joint to those of its node.
    unit : float
        Metres in one unit of the file.
    turn : array_like, shape (4,)
        The rotation from the file's axes to those with y up.
    numbers : tuple of int
        What the file itself counts each node by; -1 for one that is not in it.

    Raises
    ------
    MotionError
        Parts differ in length, or a scale is not one positive number.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    translations: Floats
    rotations: Floats
    scales: Floats
    axes: Floats
    unit: float = 1.0
    turn: Floats = field(default_factory=rot.IDENTITY.copy)
    numbers: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        for name in ("translations", "rotations", "scales", "axes", "turn"):
            values = freeze(getattr(self, name), name, row="node", error=MotionError)
            assign(self, **{name: values})
        n = len(self.names)
        shapes = [(n, 3), (n, 4), (n, 3)]
        if [part.shape for part in (self.translations, self.rotations, self.scales)] != shapes:
            raise MotionError(f"a rig of {n} nodes has {n} translations, rotations and scales")
        least, most = self.scales.min(axis=1), self.scales.max(axis=1)
        if n and not (least.min() > 0 and (most - least <= UNIFORM * most).all()):
            raise MotionError("the scale of a node at rest is not one positive number")

    @property
    def above(self) -> int:
        """Return how many nodes carry the joints, and come before them."""
        return len(self.names) - len(self.axes)

    @property
    def is_plain(self) -> bool:
        """Whether nodes are joints alone that have neither rotation nor scale at rest, as a BVH's.

        Rounding counts as none.
        """
        turned = np.abs(self.rotations[:, 1:]).max(initial=0.0)
        scaled = np.abs(self.scales - 1).max(initial=0.0)
        return self.above == 0 and bool(max(turned, scaled) < 1e-9)

    @cached_property
    def world(self) -> tuple[Floats, Floats, Floats]:
        """Return position (nodes, 3), rotation (nodes, 4) and scale (nodes,) in the file's world.

        Of the pose at rest.
        """
        n = len(self.names)
        places, turns, sizes = np.zeros((n, 3)), np.empty((n, 4)), np.empty(n)
        for node in range(n):
            place, turn, size = self.parent_world(node, places, turns, sizes)
            places[node] = place + size * rot.rotate(turn, self.translations[node])
            turns[node] = rot.multiply(turn, self.rotations[node])
            sizes[node] = size * self.scales[node].mean()
        return places, turns, sizes

    def parent_world(
        self, node: int, places: Floats, turns: Floats, sizes: Floats
    ) -> tuple[Floats, Floats, float]:
        if (parent := self.parents[node]) < 0:
            return np.zeros(3), rot.IDENTITY, 1.0
        return places[parent], turns[parent], float(sizes[parent])

    def rest(self) -> tuple[Floats, Floats]:
        """Return positions (joints, 3), metres with y up, and rotations of the joints at rest."""
        places, turns, _ = self.world
        turned = rot.multiply(rot.multiply(self.turn, turns[self.above :]), self.axes)
        return self.unit * rot.rotate(self.turn, places[self.above :]), turned

    def scale(self, factor: float) -> Rig:
        """Return the rig of a body ``factor`` times as large."""
        return replace(self, translations=factor * self.translations)

    def join_root(self) -> Rig:
        """Return the rig without the nodes above its root, whose transforms are made part of it."""
        above, (places, turns, sizes) = self.above, self.world
        if above == 0:
            return self
        size = float(sizes[above - 1])
        moved, turned = np.array(self.translations[above:]), np.array(self.rotations[above:])
        parents = tuple(max(parent - above, -1) for parent in self.parents[above:])
        for joint, parent in enumerate(parents):
            if parent < 0:
                moved[joint], turned[joint] = places[above + joint] / size, turns[above + joint]
        return replace(
            self,
            names=self.names[above:],
            parents=parents,
            translations=moved,
            rotations=turned,
            scales=self.scales[above:],
            unit=self.unit * size,
            numbers=self.numbers[above:],
        )

    def to_metres(self) -> Rig:
        """Return the same rig in metres with y up: topmost nodes are turned, and no scale changes.

        A rig that is so already is returned as it is, to the last bit.
        """
        if self.unit == 1.0 and (self.turn == rot.IDENTITY).all():
            return self
        moved, turned = self.unit * self.translations, np.array(self.rotations)
        tops = [node for node, parent in enumerate(self.parents) if parent < 0]
        moved[tops] = rot.rotate(self.turn, moved[tops])
        turned[tops] = rot.multiply(self.turn, turned[tops])
        return replace(self, translations=moved, rotations=turned, unit=1.0, turn=rot.IDENTITY)


def make_rig(
    names: Sequence[str],
    parents: Sequence[int],
    offsets: Floats,
    frames: Floats | None = None,
    *,
    unit: float = 1.0,
    turn: Floats = rot.IDENTITY,
) -> Rig:
    """Return the rig of joints whose rest pose is without rotations.

    ``frames`` (joints, 4) turn the axes of each node against those of the file, as the ``axis`` of
    an ASF does; ``turn`` those of the file to axes with y up, to which the joints are turned, too.
    """
    if frames is None:
        frames = np.broadcast_to(rot.IDENTITY, (len(names), 4))
    # The frame of each joint's parent, in which its offset and its own frame are counted.
    around = np.array([rot.IDENTITY if p < 0 else frames[p] for p in parents])
    back = rot.conjugate(around)
    return Rig(
        tuple(names),
        tuple(parents),
        rot.rotate(back, offsets),
        rot.multiply(back, frames),
        np.ones((len(names), 3)),
        rot.multiply(rot.conjugate(frames), rot.conjugate(turn)),
        unit,
        turn,
    )
