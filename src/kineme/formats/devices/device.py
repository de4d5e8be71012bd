"""Define what a device's module declares."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from kineme.formats.delimited import DelimitedText
from kineme.formats.files import FileContent


@dataclass(frozen=True)
class Device:
    """How one device or its program writes tables.

    Parameters
    ----------
    name : str
        As people call it.
    recognises : callable
        From the lines of a file to whether this device wrote them.
    find : callable
        From the file to the table in it.
    """

    name: str
    recognises: Callable[[Sequence[str]], bool]
    find: Callable[[FileContent], DelimitedText]
