"""Skeletons: the joints of a body, their parents and offsets.

A joint lies at the centre of its rotation, and its offset turns with the parent:

    G[j] = G[parent] * R[j]
    p[j] = p[parent] + G[parent] @ offset[j]

An end site is a leaf without a rotation of its own (a fingertip, the top of the head).
"""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from operator import index

from kineme._util.arrays import Floats
from kineme._util.checks import as_texts, format_count
from kineme.errors import MotionError, ParameterError
from kineme.recordings.arrays import assign, freeze
from kineme.recordings.rig import Rig

LIMB = 2
"""Least number of bones below the first joint of a leg: knee to ankle, ankle to toes."""


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A tree of joints, parents before children.

    Parameters
    ----------
    names : sequence of str
        One per joint, unique.
    parents : sequence of int
        The index of each joint's parent, -1 for a root.
    offsets : array_like, shape (joints, 3)
        Vectors from parent to joint at rest, metres.
    end_sites : iterable of int
        Leaves without a rotation of their own.
    rig : Rig, optional
        Nodes of the source file, which writers restore.

    Raises
    ------
    MotionError
        Lengths differ, a name repeats, or a parent does not come before its child.

    Examples
    --------
    >>> arm = Skeleton(("shoulder", "hand"), (-1, 0), [[0, 1.4, 0], [0, -0.6, 0]])
    >>> arm.joint("hand"), arm.children
    (1, ((1,), ()))
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: Floats
    end_sites: frozenset[int] = frozenset()
    rig: Rig | None = None

    def __post_init__(self) -> None:
        try:
            assign(self, names=as_texts(self.names, "names of joints", error=MotionError))
            assign(self, parents=tuple(index(p) for p in self.parents))
            assign(self, end_sites=frozenset(index(joint) for joint in self.end_sites))
        except TypeError:
            raise MotionError(
                "parents and end sites of a skeleton must be lists of joint indices"
            ) from None
        assign(self, offsets=freeze(self.offsets, "offsets", row="joint", error=MotionError))
        n = len(self.names)
        if n == 0:
            raise MotionError("a skeleton needs at least one joint")
        if len(self.parents) != n or self.offsets.shape != (n, 3):
            raise MotionError(
                f"{n} names, {len(self.parents)} parents and offsets of shape "
                f"{self.offsets.shape} do not describe one skeleton"
            )
        if len(self._index) != n:
            # The index holds the last of two equal names, so the first one finds another index.
            twice = next(name for j, name in enumerate(self.names) if self._index[name] != j)
            raise MotionError(f"two joints are called {twice!r}: rename one of them")
        for joint, parent in enumerate(self.parents):
            if not -1 <= parent < joint:
                raise MotionError(
                    f"joint {self.names[joint]!r} (index {joint}) has parent {parent}: "
                    "parents come before their children, and a root has -1"
                )
        leaves = {*range(n)} - {*self.parents}
        if wrong := self.end_sites - leaves:
            raise MotionError(f"end site {min(wrong)} is not a leaf of the skeleton")
        if self.rig is not None and len(self.rig.axes) != n:
            raise MotionError(f"the rig has {len(self.rig.axes)} joints, but the skeleton {n}")

    def __repr__(self) -> str:
        ends = f", {len(self.end_sites)} of them end sites" if self.end_sites else ""
        return f"<Skeleton of {format_count(self.n_joints, 'joint')}{ends}>"

    def joint(self, name: str) -> int:
        """Return the index of the joint with this name.

        Raise ParameterError with similar names if there is none.
        """
        try:
            return self._index[name]
        except (KeyError, TypeError):
            close = get_close_matches(str(name), self.names, n=3) or self.names[:5]
            names = ", ".join(map(repr, close))
            raise ParameterError(f"no joint is called {name!r}; did you mean {names}?") from None

    @property
    def n_joints(self) -> int:
        return len(self.names)

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Return the indices of the children of each joint, in order."""
        lists: list[list[int]] = [[] for _ in self.names]
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                lists[parent].append(joint)
        return tuple(map(tuple, lists))

    def ancestry(self, joint: int) -> list[int]:
        """Return the joints from the root down to ``joint``; none for -1."""
        chain = []
        while joint >= 0:
            chain.append(joint)
            joint = self.parents[joint]
        return chain[::-1]

    @cached_property
    def carrier(self) -> int:
        """Return the joint that moves the whole body: the hips, even if there are bones above them.

        Going down from the root into the largest branch each time, it is the first joint with two
        limbs: children with equally many joints below them, two bones or more deep. Without limbs
        it is the first root.

        Examples
        --------
        >>> legs = ("root", "hips", "knee_l", "foot_l", "toe_l", "knee_r", "foot_r", "toe_r")
        >>> parents = (-1, 0, 1, 2, 3, 1, 5, 6)
        >>> Skeleton(legs, parents, [[0, 0, 0]] * 8).carrier
        1
        """
        below, depth = [1] * self.n_joints, [0] * self.n_joints
        # Children come first here, so the counts of a joint are complete when it is reached.
        for joint in range(self.n_joints - 1, 0, -1):
            if (parent := self.parents[joint]) >= 0:
                below[parent] += below[joint]
                depth[parent] = max(depth[parent], depth[joint] + 1)
        roots = [joint for joint, parent in enumerate(self.parents) if parent < 0]
        joint = max(roots, key=lambda root: below[root])
        while branches := self.children[joint]:
            limbs = [below[each] for each in branches if depth[each] >= LIMB]
            # Two limbs with equally many joints, as two legs have.
            if len(limbs) > len(set(limbs)):
                return joint
            joint = max(branches, key=lambda branch: below[branch])
        return roots[0]

    @cached_property
    def body(self) -> tuple[int, ...]:
        """Return the carrier and all joints below it."""
        if self.parents[self.carrier] < 0:
            return tuple(range(self.n_joints))
        inside = {self.carrier}
        for joint, parent in enumerate(self.parents):  # parents come first
            if parent in inside:
                inside.add(joint)
        return tuple(sorted(inside))

    @cached_property
    def _index(self) -> dict[str, int]:
        return {name: i for i, name in enumerate(self.names)}
