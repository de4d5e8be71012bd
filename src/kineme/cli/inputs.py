"""What is given as FILES: recordings, or folders of them."""

from __future__ import annotations

from pathlib import Path

from kineme.cli.messages import Failures


def recordings_of(given: list[Path], failures: Failures) -> list[Path]:
    """The files, and in place of each folder the recordings in it."""
    found: list[Path] = []
    for path in given:
        with failures.caught(path):
            if path.is_dir():
                from kineme.formats.listing import recordings_in

                found += recordings_in(path)
            else:
                found.append(path)
    return found
