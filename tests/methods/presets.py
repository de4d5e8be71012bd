"""Presets that do not need the number of actions."""

from __future__ import annotations

from kineme.methods import PRESETS

OWN = ("kineme", "voegele2014", "krueger2017")
ALL = tuple(PRESETS)
