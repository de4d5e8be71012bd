"""Presets of the package that need no number of actions."""

OWN = ("kineme", "voegele2014", "krueger2017")
