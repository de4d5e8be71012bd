"""Write a contact sheet and a motion matching database beside clips."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from kineme.clips.motion_matching import SUFFIXES, Database
from kineme.clips.options import ClipOptions
from kineme.clips.shaping import ShapedClip
from kineme.errors import WriteError
from kineme.recordings import Motion
from kineme.segments.table import Segment

PICTURES = (".png", ".pdf", ".svg")
SHOWN = 24
"""Number of frames of a clip used for its strip."""


class Companions:
    """Collects data for a contact sheet and a database while clips are made.

    `write` writes those that were requested.
    """

    def __init__(self, options: ClipOptions) -> None:
        self.sheet, self.matching = options.get("sheet"), options.get("motion_matching")
        # Check before any work is done.
        for path, suffixes in ((self.sheet, PICTURES), (self.matching, SUFFIXES)):
            if path is not None:
                check_target(Path(path), suffixes)
        self.strips: list[tuple[str, Motion, int]] = []
        self.database = Database()

    def collect(
        self,
        motion: Motion,
        rows: Sequence[Segment],
        clips: Iterable[ShapedClip],
        get_name: Callable[[ShapedClip], str],
    ) -> Iterator[ShapedClip]:
        """Yield the clips of a recording unchanged, and collect data from each."""
        ranges = []
        for clip in clips:
            name = get_name(clip)
            if self.sheet is not None:
                title = "   ".join(filter(None, [name, ", ".join(clip.tags)]))
                self.strips.append((title, _thin_frames(clip.motion), clip.segment.cluster))
            ranges.append((name, rows[clip.index], clip.tags))
            yield clip
        if self.matching is not None:
            self.database.add(motion, ranges)

    def write(self) -> None:
        """Write the database and the sheet, if requested."""
        if self.matching is not None:
            self.database.write(self.matching)
        if self.sheet is not None:
            from kineme.plot.sheets import Strip, write_sheet  # matplotlib takes long to import

            write_sheet([Strip(*each) for each in self.strips], self.sheet)


def check_target(path: Path, suffixes: Sequence[str]) -> None:
    """Raise WriteError if a file has none of these suffixes, or its folder is missing."""
    if path.suffix.lower() not in suffixes:
        raise WriteError(path, f"the suffix must be one of {', '.join(suffixes)}")
    if not path.parent.is_dir():
        raise WriteError(path, f"there is no folder {path.parent}")


def _thin_frames(motion: Motion) -> Motion:
    """Return a motion with at most `SHOWN` evenly spaced frames."""
    at = np.linspace(0, motion.n_frames - 1, min(SHOWN, motion.n_frames)).round().astype(int)
    return replace(motion, positions=motion.positions[at], rotations=None, gaps=())
