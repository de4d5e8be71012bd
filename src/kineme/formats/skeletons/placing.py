"""Build a motion in metres with y up from a skeleton's own rotations, units and axes.

An hour of a whole body is a gigabyte, so results are written once to their final arrays, in blocks
of frames that fit into the processor's cache.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.formats.files import FileContent
from kineme.formats.units import (
    PLAUSIBLE_HEIGHTS,
    estimate_height,
    infer_unit,
    infer_up,
    iterate_blocks,
    make_up_rotation,
    to_metres,
)
from kineme.recordings import Motion, Provenance, Skeleton
from kineme.recordings.kinematics import forward_kinematics
from kineme.recordings.rig import Channel, make_rig

Node = TypeVar("Node", bound=Hashable)

BYTES_PER_JOINT = 2 * 8 * (4 + 3)
"""Bytes of a joint in a frame: rotation and position, twice."""

RIGID = 5e-7
"""Metres by which a bone may differ from its offset and still count as rigid.

Single-precision animations differ this much from the rest pose of their file. Along twenty bones it
adds up to 0.01 mm.
"""


def require_frame_memory(content: FileContent, joints: int, frames: int) -> None:
    """Raise ReadError if a file of this size cannot hold so many frames."""
    content.require_memory(BYTES_PER_JOINT * joints * frames, f"{joints} joints in {frames} frames")


def order_depth_first(
    tops: Iterable[Node], children: Callable[[Node], Sequence[Node]]
) -> Iterator[tuple[Node, int]]:
    """Yield each node once, siblings in order, with the index of its parent in this order or -1."""
    # Reversed, since the stack pops the last one first.
    waiting = [(node, -1) for node in reversed([*tops])]
    visited: set[Node] = set()
    while waiting:
        node, parent = waiting.pop()
        if node not in visited:  # damaged files may have cycles
            waiting += [(child, len(visited)) for child in reversed(children(node))]
            visited.add(node)
            yield node, parent


def build_motion(
    skeleton: Skeleton,
    rotations: Floats,
    slides: Mapping[int, Floats],
    fps: float,
    *,
    unit: str | float | None,
    up: str | None,
    provenance: Provenance,
    frames: Floats | None = None,
    channels: Mapping[str, Sequence[Channel]] | None = None,
    asf: str = "",
) -> Motion:
    """Return the motion in metres with y up, from rotations in a file's own units and axes.

    Rotations (frames, joints, 4) are changed in place and used in the motion. ``slides`` are
    translations (frames, 3) of joints relative to their parents that replace the offsets. A unit
    or up axis of None is inferred. ``frames``, ``channels`` and ``asf`` are those of
    `make_rig`; they are used if the skeleton has no rig.
    """
    means = skeleton.offsets.copy()
    for joint, translations in slides.items():
        means[joint] = translations.mean(axis=0)
    if unit is None:
        unit, note = infer_unit(skeleton, means)
        provenance = provenance.noted(note)
    else:
        height = estimate_height(skeleton, means) * to_metres(unit)
        if not PLAUSIBLE_HEIGHTS[0] <= height <= PLAUSIBLE_HEIGHTS[1]:
            provenance = provenance.noted(
                f"with unit {unit} the skeleton is about {height:.4g} m tall: check the unit"
            )
    scale, offsets = to_metres(unit), skeleton.offsets
    skeleton = replace(skeleton, offsets=scale * offsets)
    positions = _compute_positions(skeleton, rotations, slides, scale)
    if up is None:
        up = infer_up(skeleton, positions)
        if up != "y":
            provenance = provenance.noted(
                f"turned upright: head and feet lie along {up}, so that axis is read as up"
            )
    if up != "y":
        turn = make_up_rotation(up)
        skeleton = replace(skeleton, offsets=rot.rotate(turn, skeleton.offsets))
        for span in iterate_blocks(len(rotations)):
            # Conjugation turns the axes of both the world and the joints.
            rotations[span] = rot.multiply(rot.multiply(turn, rotations[span]), rot.conjugate(turn))
            positions[span] = rot.rotate(turn, positions[span])
    if skeleton.rig is None:
        rig = make_rig(
            skeleton.names,
            skeleton.parents,
            offsets,
            frames,
            unit=scale,
            turn=make_up_rotation(up),
            channels=channels,
            asf=asf,
        )
        skeleton = replace(skeleton, rig=rig)
    return Motion(skeleton, positions, fps, rotations, provenance)


def _compute_positions(
    skeleton: Skeleton, rotations: Floats, slides: Mapping[int, Floats], scale: float
) -> Floats:
    """Return the positions (frames, joints, 3) in metres."""
    positions = np.empty((*rotations.shape[:2], 3))
    for span in iterate_blocks(len(rotations)):
        n = span.stop - span.start
        shift = np.repeat(skeleton.offsets[:, :, None], n, axis=2)  # a row per joint and axis
        for joint, translations in slides.items():
            shift[joint] = scale * translations[span].T
        positions[span] = forward_kinematics(
            skeleton, rotations[span], translations=shift.transpose(2, 0, 1)
        )
    return positions
