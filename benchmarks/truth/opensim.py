"""Are joint angles from markers those of OpenSim's inverse kinematics?

    python -m benchmarks opensim [--record] [--picture docs/images/opensim.png]

``formats/subject01_walk.trc``, of OpenSim's example models, and the angles that OpenSim found from
its markers, ``subject01_walk_IK.mot``. They are not of one definition. OpenSim has a model whose
knees and hips turn in a plane, and a zero of its own; its knees are bent at negative angles, its
trunk leans back at positive ones. Ours are between limbs: hips against the trunk. So OpenSim's are
put together to mean the same, and told are the offset (a difference of zeros), what is left
without it, the root of the mean square of the whole difference, and the correlation.
"""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import kineme
from _figures import add_option, record
from _options import command_line, needed
from kineme._colors import PALETTE
from kineme.cycles import channels_of
from kineme.recordings import Signals

MOST = 4.0
"""Degrees that may be left without the offset."""
ANGLES = {
    "knee_l": {"knee_angle_l": -1},
    "knee_r": {"knee_angle_r": -1},
    "hip_l": {"hip_flexion_l": 1, "lumbar_extension": -1},
    "hip_r": {"hip_flexion_r": 1, "lumbar_extension": -1},
    "ankle_l": {"ankle_angle_l": 1},
    "ankle_r": {"ankle_angle_r": 1},
    "trunk_lean": {"pelvis_tilt": -1, "lumbar_extension": -1},
}
"""Of each angle of ours, which of OpenSim's mean the same, and their signs."""


def theirs(angles: Signals, signs: dict[str, int]) -> np.ndarray:
    return sum(sign * angles.values[:, angles.names.index(name)] for name, sign in signs.items())


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("--picture", type=Path, metavar="PATH")
    add_option(parser)
    picture = parser.parse_args().picture
    motion, angles = (
        kineme.read(needed(f"formats/subject01_walk{name}")) for name in (".trc", "_IK.mot")
    )
    kept, pairs = True, {}
    for channel in channels_of(motion, ANGLES):
        own, other = channel.values(), theirs(angles, ANGLES[channel.name])
        apart = own - other
        offset, rest = float(apart.mean()), float(apart.std())
        whole = float(np.sqrt(np.mean(apart**2)))
        same = float(np.corrcoef(own, other)[0, 1])
        print(f"{channel.name:10} offset {offset:+5.1f}°, without it {rest:3.1f}°, with it "
              f"{whole:4.1f}° (rms); r {same:.3f}")  # fmt: skip
        for name, value, digits in (("offset", offset, 1), ("rest", rest, 1), ("rms", whole, 1),
                                    ("r", same, 2)):  # fmt: skip
            record(f"opensim.{channel.name}.{name}", round(value, digits),
                   unit="" if name == "r" else "°")  # fmt: skip
        kept &= rest <= MOST
        pairs[channel.name] = own, other
    if picture is not None:
        draw(pairs, motion.fps, picture)
    print(f"promised: within {MOST:g}° without the offset: {'kept' if kept else 'NOT KEPT'}")
    return 0 if kept else 1


def draw(pairs: dict[str, tuple[np.ndarray, np.ndarray]], fps: float, path: Path) -> None:
    """The right side's angles and the trunk over time, ours and OpenSim's."""
    figure = Figure(figsize=(9, 4.6), layout="constrained")
    chosen = ("knee_r", "hip_r", "ankle_r", "trunk_lean")
    for name, ax in zip(chosen, figure.subplots(2, 2, sharex=True).flat, strict=True):
        own, other = pairs[name]
        seconds = np.arange(len(own)) / fps
        ax.plot(seconds, own, color=PALETTE[0], label="kineme")
        ax.plot(seconds, other, color=PALETTE[1], linestyle="--", label="OpenSim")
        ax.set_title(name, loc="left", fontsize=10)
        ax.set_ylabel("°")
        ax.set_xlim(0, seconds[-1])
        ax.spines[["top", "right"]].set_visible(False)
    for ax in figure.axes[2:]:
        ax.set_xlabel("seconds")
    figure.axes[0].legend(frameon=False)
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
