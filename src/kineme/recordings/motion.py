"""Motion of a body: the positions of its joints over time.

Positions are metres, y is up, axes are right-handed; the frame rate is a
float. Rotations are unit quaternions ``(w, x, y, z)``, each from the joint's
own frame to its parent's; see `kineme.recordings.skeleton` for the conventions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme._util.checks import check_type, format_count
from kineme.errors import MotionError
from kineme.recordings.arrays import as_rate, assign, freeze
from kineme.recordings.kinematics import forward_kinematics
from kineme.recordings.notebook import draw_poses
from kineme.recordings.provenance import Provenance
from kineme.recordings.recording import Recording, Spans, as_gaps
from kineme.recordings.skeleton import Skeleton

FARTHEST = 1e9
"""Largest distance from the origin in metres; ten times the largest map coordinates."""


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Recording):
    """Joint positions of a skeleton over time, and rotations if known.

    Parameters
    ----------
    skeleton : Skeleton
        The joints and their parents.
    positions : array_like, shape (frames, joints, 3)
        Metres, y up.
    fps : float
        Frames per second.
    rotations : array_like, shape (frames, joints, 4), optional
        Unit quaternions (w, x, y, z), local to the parent.
    provenance : Provenance
        Source of the recording, and what was inferred from it.
    gaps : sequence of (int, int)
        Frames [start, stop) in which the body was not recorded, in time order, neither touching
        nor overlapping; positions in them are interpolated.

    Raises
    ------
    MotionError
        Shapes do not match, no frames, values that are not finite, or gaps out of order.

    Examples
    --------
    >>> arm = Skeleton(("shoulder", "hand"), (-1, 0), [[0, 0, 0], [0.6, 0, 0]])
    >>> motion = Motion(arm, [[[0, 1.4, 0], [0.6, 1.4, 0]]] * 90, 30)
    >>> motion
    <Motion of 90 frames (3.0 s) at 30 Hz: 2 joints>
    >>> motion.seconds(1, 2)
    <Motion of 30 frames (1.0 s) at 30 Hz: 2 joints>
    """

    skeleton: Skeleton
    positions: Floats
    fps: float
    rotations: Floats | None = None
    provenance: Provenance = field(default_factory=Provenance)
    gaps: Spans = ()

    def __post_init__(self) -> None:
        check_type(self.skeleton, Skeleton, "Motion", "then positions and fps", error=MotionError)
        assign(self, fps=as_rate(self.fps, error=MotionError))
        assign(self, positions=freeze(self.positions, "positions", error=MotionError))
        # The maximum and minimum need no copy, unlike absolute values.
        reach = max(float(self.positions.max(initial=0.0)), -float(self.positions.min(initial=0.0)))
        if reach > FARTHEST:
            raise MotionError(
                f"positions reach {reach:.3g} m, too far for a body: give unit= or correct "
                "the values"
            )
        joints = self.skeleton.n_joints
        if self.positions.ndim != 3 or self.positions.shape[1:] != (joints, 3):
            raise MotionError(
                f"positions have shape {self.positions.shape}, not (frames, {joints}, 3)"
            )
        if self.n_frames == 0:
            raise MotionError("a motion needs at least one frame")
        assign(self, gaps=as_gaps(self.gaps, self.n_frames, error=MotionError))
        if self.rotations is None:
            return
        assign(self, rotations=freeze(self.rotations, "rotations", error=MotionError))
        if self.rotations.shape != (self.n_frames, joints, 4):
            raise MotionError(
                f"rotations have shape {self.rotations.shape}, not ({self.n_frames}, {joints}, 4)"
            )
        # Squared lengths: an array of them needs no square root to be compared with 1.
        norm = np.einsum("fjc,fjc->fj", self.rotations, self.rotations)
        if max(norm.max() - 1, 1 - norm.min()) > 1e-6:
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
        """Return the motion with positions computed from rotations; see `forward_kinematics`."""
        positions = forward_kinematics(
            skeleton, rotations, root_positions, translations=translations
        )
        return cls(
            skeleton, positions, fps, np.asarray(rotations, float), provenance or Provenance()
        )

    def __repr__(self) -> str:
        ends = len(self.skeleton.end_sites)
        return (
            f"<Motion of {format_count(self.n_frames, 'frame')} ({self.duration:.1f} s) at "
            f"{self.fps:g} Hz: {format_count(self.skeleton.n_joints, 'joint')}"
            f"{f', {ends} of them end sites' if ends else ''}>"
        )

    @property
    def n_frames(self) -> int:
        return len(self.positions)

    def joint(self, name: str) -> int:
        """Return the index of the joint called ``name``; raise ParameterError if there is none."""
        return self.skeleton.joint(name)

    def _sliced(self, start: int, stop: int, gaps: Spans, provenance: Provenance) -> Motion:
        positions = self.positions[start:stop]
        rotations = None if self.rotations is None else self.rotations[start:stop]
        return replace(
            self, positions=positions, rotations=rotations, gaps=gaps, provenance=provenance
        )

    def _facts(self) -> list[tuple[str, str]]:
        names: Sequence[str] = self.skeleton.names
        shown = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
        turns = "positions only" if self.rotations is None else "positions and rotations"
        return [("joints", f"{len(names)}: {shown}"), ("holds", turns)]

    def _picture(self) -> str:
        return draw_poses(self.skeleton, self.positions)


def check_motion(motion: object, caller: str) -> None:
    """Raise ParameterError if the argument of a public function is not a Motion."""
    is_other = isinstance(motion, Recording)
    advice = "channels have no joints" if is_other else "kineme.read(path) gives one"
    check_type(motion, Motion, caller, advice)
