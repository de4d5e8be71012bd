"""Angles do not depend on where things are, how large they are or which way they face."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from kineme._util import rotations as rot
from kineme.cycles import bend, cardan, measure_angle
from kineme.cycles.angles import measure_turn

points = arrays(np.float64, (4, 3), elements=st.floats(-2, 2).map(lambda x: round(x, 3)))
turns = arrays(np.float64, (1, 3), elements=st.floats(-3, 3))


@given(points, points, points, turns, st.floats(0.1, 10))
def test_a_bend_stays_however_the_limb_is_turned_moved_and_scaled(a, b, c, turn, size) -> None:
    q = rot.from_euler(turn, "xyz")
    once = bend(a, b, c)
    again = bend(*(size * rot.rotate(q, each) + 0.3 for each in (a, b, c)))
    apart = (np.linalg.norm(a - b, axis=1) > 1e-3) & (np.linalg.norm(c - b, axis=1) > 1e-3)
    np.testing.assert_allclose(once[apart], again[apart], atol=1e-3)


def test_a_straight_limb_is_not_bent_and_one_without_length_is_unknown() -> None:
    a, b, c = (np.array([[0.0, y, 0.0]]) for y in (2, 1, 0))
    assert bend(a, b, c).tolist() == [0]
    assert np.isnan(bend(a, a, c)).all()


@given(points, points, points)
def test_there_and_back_about_an_axis_is_nothing(axis, first, second) -> None:
    there, back = measure_turn(axis, first, second), measure_turn(axis, second, first)
    total = (there + back + 180) % 360 - 180
    np.testing.assert_allclose(total, 0, atol=1e-6)


@given(points, points)
def test_the_angle_between_two_is_that_between_the_other_two(first, second) -> None:
    np.testing.assert_allclose(
        measure_angle(first, second), measure_angle(second, first), atol=1e-9
    )


@given(arrays(np.float64, (5, 3), elements=st.floats(-np.pi, np.pi)))
def test_cardan_angles_make_the_rotation_again(angles) -> None:
    q = rot.from_euler(angles, "xzy")
    again = rot.from_euler(np.radians(cardan(q)), "xzy")
    np.testing.assert_allclose(np.abs((q * again).sum(axis=1)), 1, atol=1e-9)
