"""The nodes of a file at rest, from which a skeleton was made.

A `Skeleton` holds joint offsets in metres with y up. A `Rig` keeps what writers need to restore the
nodes of the file: those above the hips, and the rest rotation and scale of each.
A node's transform in its parent's frame is x -> t + R s x, with one positive scale s.

With W the rotation of a joint's node in the axes of the file, and G that of the joint in the
motion (see `kineme.recordings.skeleton`)::

    G = turn * W * axes
    p = unit * turn @ (position of the node)

So the poses of the nodes can be computed from any motion of the skeleton.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import MotionError
from kineme.recordings.arrays import assign, freeze

Channel = tuple[str, str]
"""Axis and kind of a column of a file, such as ``("z", "rotation")``."""
UNIFORM = 1e-4
"""Largest relative difference of a node's three scales that count as one."""


@dataclass(frozen=True, eq=False)
class Rig:
    """Nodes at rest, in the units and axes of their file; the joints come last.

    Raise MotionError if lengths differ, or a scale is not one positive number. ``binds`` is the
    bind pose of a skin, relative to the node above all joints, if it differs from the rest pose;
    Blender uses it as the rest pose of a glTF. ``channels`` are those of a BVH by joint;
    ``asf`` is the text of an ASF.
    """

    names: tuple[str, ...]  # one per node, as in the file
    parents: tuple[int, ...]  # index of each node's parent, which comes before it; -1 for none
    translations: Floats  # (nodes, 3) in the parent's frame, as rotations and scales are
    rotations: Floats  # (nodes, 4) unit quaternions (w, x, y, z)
    scales: Floats  # (nodes, 3)
    axes: Floats  # (joints, 4) rotations from the axes of each joint to those of its node
    unit: float = 1.0  # metres in one unit of the file
    turn: Floats = field(default_factory=rot.IDENTITY.copy)  # from the file's axes to y up
    numbers: tuple[int, ...] = ()  # index of each node in the file; -1 if it is not in it
    binds: Floats | None = None  # (joints, 4, 4)
    channels: Mapping[str, Sequence[Channel]] = field(default_factory=dict)
    asf: str = ""

    def __post_init__(self) -> None:
        for name in ("translations", "rotations", "scales", "axes", "turn"):
            values = freeze(getattr(self, name), name, row="node", error=MotionError)
            assign(self, **{name: values})
        if self.binds is not None:
            assign(self, binds=freeze(self.binds, "binds", row="joint", error=MotionError))
        n = len(self.names)
        shapes = [(n, 3), (n, 4), (n, 3)]
        if [part.shape for part in (self.translations, self.rotations, self.scales)] != shapes:
            raise MotionError(f"a rig of {n} nodes needs {n} translations, rotations and scales")
        least, most = self.scales.min(axis=1), self.scales.max(axis=1)
        if n and not (least.min() > 0 and (most - least <= UNIFORM * most).all()):
            raise MotionError("the scale of a node at rest is not one positive number")

    @property
    def above(self) -> int:
        """Return the number of nodes above the joints, which come first."""
        return len(self.names) - len(self.axes)

    @property
    def is_plain(self) -> bool:
        """Return whether all nodes are joints without rest rotation or scale, as in BVH.

        Rounding errors are ignored.
        """
        turned = np.abs(self.rotations[:, 1:]).max(initial=0.0)
        scaled = np.abs(self.scales - 1).max(initial=0.0)
        return self.above == 0 and bool(max(turned, scaled) < 1e-9)

    @cached_property
    def world(self) -> tuple[Floats, Floats, Floats]:
        """Return rest positions (nodes, 3), rotations (nodes, 4) and scales (nodes,).

        All are in the world of the file.
        """
        n = len(self.names)
        places, turns, sizes = np.zeros((n, 3)), np.empty((n, 4)), np.empty(n)
        for node in range(n):
            place, turn, size = self.parent_world(node, places, turns, sizes)
            # Compose x -> t + R s x of the node with the transform of its parent.
            places[node] = place + size * rot.rotate(turn, self.translations[node])
            turns[node] = rot.multiply(turn, self.rotations[node])
            sizes[node] = size * self.scales[node].mean()
        return places, turns, sizes

    def parent_world(
        self, node: int, places: Floats, turns: Floats, sizes: Floats
    ) -> tuple[Floats, Floats, float]:
        """Return the world position, rotation and scale of a node's parent, from those of all."""
        if (parent := self.parents[node]) < 0:
            return np.zeros(3), rot.IDENTITY, 1.0
        return places[parent], turns[parent], float(sizes[parent])

    def rest(self) -> tuple[Floats, Floats]:
        """Return rest positions (joints, 3) in metres with y up, and rotations (joints, 4)."""
        places, turns, _ = self.world
        turned = rot.multiply(rot.multiply(self.turn, turns[self.above :]), self.axes)
        return self.unit * rot.rotate(self.turn, places[self.above :]), turned

    def scale(self, factor: float) -> Rig:
        """Return the rig scaled by a factor."""
        binds = None if self.binds is None else np.array(self.binds)
        if binds is not None:
            binds[:, :3, 3] *= factor
        return replace(self, translations=factor * self.translations, binds=binds)

    def join_root(self) -> Rig:
        """Return the rig without the nodes above its root; their transforms move into the root."""
        above, (places, turns, sizes) = self.above, self.world
        if above == 0:
            return self
        size = float(sizes[above - 1])
        moved, turned = np.array(self.translations[above:]), np.array(self.rotations[above:])
        parents = tuple(max(parent - above, -1) for parent in self.parents[above:])
        for joint, parent in enumerate(parents):
            if parent < 0:
                # Roots get their world transform; the scale above moves into `unit`.
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
            binds=None,
        )

    def to_metres(self) -> Rig:
        """Return the rig in metres with y up: the topmost nodes are turned, scales stay.

        A rig that is in metres with y up already is returned unchanged.
        """
        if self.unit == 1.0 and (self.turn == rot.IDENTITY).all():
            return self
        moved, turned = self.unit * self.translations, np.array(self.rotations)
        tops = [node for node, parent in enumerate(self.parents) if parent < 0]
        moved[tops] = rot.rotate(self.turn, moved[tops])
        turned[tops] = rot.multiply(self.turn, turned[tops])
        changed = replace(self, translations=moved, rotations=turned, binds=None)
        return replace(changed, unit=1.0, turn=rot.IDENTITY)


def make_rig(
    names: Sequence[str],
    parents: Sequence[int],
    offsets: Floats,
    frames: Floats | None = None,
    *,
    unit: float = 1.0,
    turn: Floats = rot.IDENTITY,
    channels: Mapping[str, Sequence[Channel]] | None = None,
    asf: str = "",
) -> Rig:
    """Return the rig of joints with a rest pose without rotations.

    ``frames`` (joints, 4) rotate the axes of each node relative to those of the file, like the
    ``axis`` of an ASF; ``turn`` rotates the axes of the file to y up.
    """
    if frames is None:
        frames = np.broadcast_to(rot.IDENTITY, (len(names), 4))
    # Offsets and axes are stored relative to the axes of the parent.
    around = np.array([rot.IDENTITY if p < 0 else frames[p] for p in parents])
    back = rot.conjugate(around)
    return Rig(
        tuple(names),
        tuple(parents),
        translations=rot.rotate(back, offsets),
        rotations=rot.multiply(back, frames),
        scales=np.ones((len(names), 3)),
        axes=rot.multiply(rot.conjugate(frames), rot.conjugate(turn)),
        unit=unit,
        turn=turn,
        channels=channels or {},
        asf=asf,
    )
