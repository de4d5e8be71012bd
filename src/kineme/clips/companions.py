"""What is written beside clips: a contact sheet, and a database for motion matching."""

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
"""Frames of a clip that its strip is drawn from."""


class Companions:
    """Collect what a contact sheet and a database need while clips are made.

    `write` then writes those that were asked for.
    """

    def __init__(self, given: ClipOptions) -> None:
        self.sheet, self.matching = given.get("sheet"), given.get("motion_matching")
        # Before any work is done, so that nothing is left half written.
        for path, suffixes in ((self.sheet, PICTURES), (self.matching, SUFFIXES)):
            if path is not None:
                check_target(Path(path), suffixes)
        self.strips: list[tuple[str, Motion, int]] = []
        self.database = Database()

    def follow(
        self,
        motion: Motion,
        rows: Sequence[Segment],
        made: Iterable[ShapedClip],
        name_of: Callable[[ShapedClip], str],
    ) -> Iterator[ShapedClip]:
        """Yield the clips of a recording unchanged, and collect what is needed of each."""
        ranges = []
        for clip in made:
            name = name_of(clip)
            if self.sheet is not None:
                title = "   ".join(filter(None, [name, ", ".join(clip.tags)]))
                self.strips.append((title, _thin_frames(clip.motion), clip.segment.cluster))
            ranges.append((name, rows[clip.index], clip.tags))
            yield clip
        if self.matching is not None:
            self.database.add(motion, ranges)

    def write(self) -> None:
        """Write the database and the sheet, if they were asked for."""
        if self.matching is not None:
            self.database.write(self.matching)
        if self.sheet is not None:
            from kineme.plot.sheets import Strip, write_sheet  # matplotlib takes long to import

            write_sheet([Strip(*each) for each in self.strips], self.sheet)


def check_target(path: Path, suffixes: Sequence[str]) -> None:
    """WriteError where a file has none of these suffixes, or no folder to lie in."""
    if path.suffix.lower() not in suffixes:
        raise WriteError(path, f"the suffix must be one of {', '.join(suffixes)}")
    if not path.parent.is_dir():
        raise WriteError(path, f"there is no folder {path.parent}")


def _thin_frames(motion: Motion) -> Motion:
    """Return few frames of a motion, evenly apart."""
    at = np.linspace(0, motion.n_frames - 1, min(SHOWN, motion.n_frames)).round().astype(int)
    return replace(motion, positions=motion.positions[at], rotations=None, gaps=())
