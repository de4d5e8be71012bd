"""Cycles: measurements of each repetition, mean curves, and events such as foot contacts.

The package is callable like its function `cycles`, since both have the same name.
"""

import sys
from importlib import import_module
from inspect import signature
from types import ModuleType
from typing import Any

from kineme.cycles.channels import Channel, channels_of
from kineme.cycles.comparison import compare_curves, compare_sessions, compare_sides
from kineme.cycles.contacts import (
    stands_from_force,
    stands_from_positions,
    swings_from_gyroscope,
)
from kineme.cycles.events import Events, foot_events, gait, strides
from kineme.cycles.export import write_cycles, write_table
from kineme.cycles.joints import bend, cardan, landmarks, measure_angle
from kineme.cycles.measure import cycles
from kineme.cycles.repetitions import as_repetitions
from kineme.cycles.table import Cycles

__all__ = [
    "Channel",
    "Cycles",
    "Events",
    "as_repetitions",
    "bend",
    "cardan",
    "channels_of",
    "compare_curves",
    "compare_sessions",
    "compare_sides",
    "cycles",
    "foot_events",
    "gait",
    "landmarks",
    "measure_angle",
    "stands_from_force",
    "stands_from_positions",
    "strides",
    "swings_from_gyroscope",
    "write_cycles",
    "write_table",
]


class _CallableModule(ModuleType):
    __call__ = staticmethod(cycles)
    __signature__ = signature(cycles)

    def __reduce__(self) -> tuple[Any, ...]:
        return import_module, (self.__name__,)  # so that processes can be given `kineme.cycles`


sys.modules[__name__].__class__ = _CallableModule
