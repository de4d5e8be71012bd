"""From a file's own units and axes to metres with y up.

Formats without a unit or an up axis are judged by the body they describe:
its height from toes to crown tells the unit, the way from feet to head the
vertical. Whatever is inferred is returned as a sentence for the provenance.
"""

from __future__ import annotations

INCH = 0.0254

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": INCH, "cmu": INCH / 0.45}
"""Metres in one unit; "cmu" is 1/0.45 inch, the unit of the CMU database."""

AXES = ("x", "y", "z", "-x", "-y", "-z")


def metres(unit: str | float) -> float:
    """The metres in one ``unit``, a name in `UNITS` or already a length."""
    return UNITS[unit] if isinstance(unit, str) else float(unit)
