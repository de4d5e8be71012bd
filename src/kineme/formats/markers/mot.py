"""MOT and STO: OpenSim's tables of joint angles, forces or other channels.

They tell no positions without the model that they belong to, so they are no
motion here. They are recognised in order to say what to do instead: their
channels can be segmented as plain signals.
"""

from __future__ import annotations

from kineme.formats.files import Source
from kineme.formats.registry import Format, ReadOptions
from kineme.recordings.motion import Motion


def read_mot(source: Source, options: ReadOptions) -> Motion:  # noqa: ARG001
    """Nothing: a ReadError that says which channels are there and what to do with them."""
    below = source.text.lower().partition("endheader")[2].split("\n", 2)
    names = below[1].split() if len(below) > 1 else []
    channels = ", ".join(names[1:5]) + (", ..." if len(names) > 5 else "")
    raise source.error(
        f"holds channels of an OpenSim model ({channels or 'none named'}), which are no positions "
        "without that model: segment them as plain signals (kineme.read_signals; kineme segment "
        "does so by itself), or give the TRC of its markers, or a table of positions from "
        "OpenSim's Analyze tool as a CSV with columns JOINT_x, JOINT_y, JOINT_z and time"
    )


FORMAT = Format("MOT/STO", (".mot", ".sto"), lambda head: b"\nendheader" in head.lower(), read_mot)
