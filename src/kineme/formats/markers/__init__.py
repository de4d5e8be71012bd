"""Formats of markers and analog channels: C3D, TRC, tables of capture programs."""
