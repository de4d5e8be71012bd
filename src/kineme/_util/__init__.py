"""Helpers that any room may import; none of them knows what a recording is."""
