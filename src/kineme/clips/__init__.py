"""Recordings cut into clips: a file per segment, loops that close, a manifest."""
