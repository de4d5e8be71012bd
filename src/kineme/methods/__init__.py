"""Segmentation methods on plain arrays (samples × dims), one folder each.

=================== ================================================================
``kineme``          ``kineme``, the default, and ``sensors``, the same for signals
``region_growing``  the published methods of 2014 and 2017
=================== ================================================================

A preset is a method with a name and values of its constants.
`kineme.methods.base` defines the interfaces of presets and of their results.
"""

from kineme.methods.base import (
    Columns,
    Constant,
    Found,
    Leveled,
    Mirror,
    Preset,
    Progress,
    Unit,
    constant,
)
from kineme.methods.presets import DEFAULT, PRESETS, register, resolve_preset

__all__ = [
    "DEFAULT",
    "PRESETS",
    "Columns",
    "Constant",
    "Found",
    "Leveled",
    "Mirror",
    "Preset",
    "Progress",
    "Unit",
    "constant",
    "register",
    "resolve_preset",
]
