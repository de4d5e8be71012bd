"""What other packages add: objects that they name as entry points of a group."""

from __future__ import annotations

import warnings
from importlib.metadata import entry_points
from typing import Any

from kineme.errors import KinemeWarning


def plugins(group: str) -> list[Any]:
    """The objects that installed packages name in a group; one that does not load is warned of.

    Parameters
    ----------
    group : str
        ``kineme.presets``, ``kineme.formats``, ``kineme.label_formats`` or ``kineme.scores``.
    """
    found = []
    for entry in entry_points(group=group):
        try:
            found.append(entry.load())
        except Exception as error:  # noqa: BLE001 (whatever another package raises)
            reason = f"{entry.value} of {group} cannot be loaded: {error}"
            warnings.warn(reason, KinemeWarning, stacklevel=2)
    return found
