"""What other installed packages add to kineme: the objects in an entry point group."""

from __future__ import annotations

import warnings
from typing import Any

from kineme.errors import KinemeWarning


def plugins(group: str) -> list[Any]:
    """The objects that other packages registered in a group, in the order of their names.

    A package whose object cannot be loaded costs itself only: a `KinemeWarning` names it.

    Parameters
    ----------
    group : str
        Name of the entry point group, such as ``kineme.label_formats``.

    Returns
    -------
    list
        One object per entry point.
    """
    from importlib.metadata import entry_points  # slow to load: not before it is asked for

    found = []
    for point in sorted(entry_points(group=group), key=lambda point: point.name):
        try:
            found.append(point.load())
        except Exception as error:  # noqa: BLE001 (whatever a stranger's module raises)
            reason = f"{type(error).__name__}: {error}"
            warnings.warn(
                f"{point.name!r} of {group} is left out, it cannot be loaded: {reason}",
                KinemeWarning,
                stacklevel=2,
            )
    return found
