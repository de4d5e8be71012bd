"""One cycle of an action: angles of the figure at a few phases, joined by monotone cubics.

Phases are shares of the cycle. A limb's angle without a side holds for both; in a gait the
right side follows half a cycle later. Angles not given are those of standing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from kineme._util.arrays import Floats
from kineme.datasets.figure import ANGLES, LIMBS, SIDES

STANDING = dict.fromkeys(ANGLES, 0.0) | {
    f"{side} {limb}": angle
    for side in SIDES
    for limb, angle in (("spread", 3.0), ("raise", 9.0), ("elbow", 14.0), ("roll", 15.0))
}

_SIDEWAYS = frozenset({"list", "yaw", "lean", "twist", "look"})


@dataclass(frozen=True)
class Cycle:
    """One repetition of an action.

    Parameters
    ----------
    seconds : float
        How long it takes at speed 1.
    at : sequence of float
        Phases, shares of the cycle from 0 to 1.
    angles : mapping of str to sequence of float
        Degrees at these phases, by name; an angle whose last value is not its first goes on
        turning from cycle to cycle.
    gait : bool, optional
        The right side follows half a cycle later.
    flights : tuple of (float, float), optional
        (from, to) shares of the cycle spent in the air, at amplitude 1.
    travels : bool, optional
        The figure walks on and may turn.
    """

    seconds: float
    at: Sequence[float]
    angles: Mapping[str, Sequence[float]]
    gait: bool = False
    flights: tuple[tuple[float, float], ...] = ()
    travels: bool = False

    @property
    def one_sided(self) -> bool:
        """Left and right do different things, and not in turn."""
        return not self.gait and any(name.startswith(SIDES) for name in self.angles)

    def angles_at(self, phase: Floats, amplitude: Floats) -> dict[str, Floats]:
        """Return every angle of the figure at the phases (cycles from 0), scaled about standing."""
        found = {name: np.full(len(phase), angle) for name, angle in STANDING.items()}
        for name, values in self.angles.items():
            curve = _cyclic(self.at, values)
            for full_name in _full_names(name):
                # Half a cycle earlier in the curve is half a cycle later in time.
                late = 0.5 if self.gait and full_name.startswith("right") else 0.0
                angle = curve(phase - late)
                # An angle that goes on turning is not scaled, or it would lose whole turns.
                turns = values[0] != values[-1]
                rest = STANDING[full_name]
                found[full_name] = angle if turns else rest + amplitude * (angle - rest)
        return found


def mirror_posture(angles: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return the same posture with left and right exchanged."""
    found = {}
    for name, values in angles.items():
        side, _, limb = name.rpartition(" ")
        if side:
            found[f"{'right' if side == 'left' else 'left'} {limb}"] = values
        else:
            found[name] = -values if name in _SIDEWAYS else values
    return found


def _full_names(name: str) -> list[str]:
    return [f"{side} {name}" for side in SIDES] if name in LIMBS else [name]


def _cyclic(at: Sequence[float], values: Sequence[float]) -> Callable[[Floats], Floats]:
    """Return the cyclic curve through values at the given shares of a cycle."""
    # What the angle gains in a cycle, such as 360 degrees of an arm circle.
    gain = values[-1] - values[0]
    phases, heights = np.asarray(at, float), np.asarray(values, float)
    # A cycle more on either side, so that the curve is smooth across the border of cycles.
    curve = PchipInterpolator(
        np.concatenate([phases[:-1] - 1, phases, phases[1:] + 1]),
        np.concatenate([heights[:-1] - gain, heights, heights[1:] + gain]),
    )

    def at_phase(phase: Floats) -> Floats:
        cycle = np.floor(phase)
        return np.asarray(curve(phase - cycle) + cycle * gain)

    return at_phase
