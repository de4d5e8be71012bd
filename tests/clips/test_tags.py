"""Where a clip goes as seen from where the body looks, and whether it turns, starts and stops."""

from __future__ import annotations

import numpy as np
import pytest

import kineme
from kineme.clips.root_motion import measure_travel
from kineme.recordings import Motion
from kineme.recordings.operations import cut, turn
from kineme.recordings.posing import add_root

SIDES = {"left": "right", "right": "left", "turn left": "turn right", "turn right": "turn left"}


def find_tags(motion: Motion) -> tuple[str, ...]:
    travel = measure_travel(motion)
    return () if travel is None else travel.tags(0, motion.n_frames)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("dataset-1_walk_proud_001", "forwards"),
        ("dataset-1_walk-back_normal_001", "backwards"),
        ("dataset-1_walk-left_tired_001", "left"),
        ("dataset-1_walk-right_normal_001", "right"),
        ("dataset-2_wave-right-hand_normal_001", "in place"),
        ("dataset-2_walk-turn-left_normal_001", "turn left"),
        ("dataset-2_walk-turn-right_active_001", "turn right"),
    ],
)
def test_walks_go_where_their_names_say_however_they_are_turned(data_dir, name, expected) -> None:
    motion = kineme.read(data_dir / "rigs" / "bandai_namco" / f"{name}.bvh")
    found = find_tags(motion)
    assert expected in found
    assert find_tags(turn(motion, 2.0)) == find_tags(add_root(motion)) == found
    mirrored = {SIDES.get(tag, tag) for tag in found}
    assert {*find_tags(kineme.mirror(motion))} == mirrored


def test_starts_and_stops_are_those_of_bodies_that_travel(motion: Motion) -> None:
    squats, walk = cut(motion, 330, 750), cut(motion, 0, 320)
    assert find_tags(squats) == ("in place",)
    # The walk from a stand, and to one: frames before the first and after the last are still.
    still = np.repeat(walk.positions[:1], 60, axis=0)
    begun = Motion(walk.skeleton, np.concatenate([still, walk.positions]), walk.fps)
    assert find_tags(begun) == ("forwards", "start")
    ended = Motion(walk.skeleton, begun.positions[::-1], walk.fps)
    assert "stop" in find_tags(ended)
