"""Texts for a terminal: names of files, joints and labels may hold codes that would steer it."""

from __future__ import annotations

import re

_STEERS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""Controls but tab and line feed, and what turns the direction of text."""


def harmless(text: str) -> str:
    """A text whose control characters, which could steer a terminal, are spelled out.

    Examples
    --------
    >>> harmless("a" + chr(7) + "b") == "a" + chr(92) + "x07b"
    True
    """
    return _STEERS.sub(lambda found: found[0].encode("unicode_escape").decode(), text)
