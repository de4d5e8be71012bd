"""What is shown of a large recording while it is read: poses evenly apart, without segments."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct

from kineme.errors import KinemeError
from kineme.formats import sketch
from kineme.studio.loading import one_segment
from kineme.studio.storage.sidecars import options_of, read_options, video_message
from kineme.web.messages import MatrixHead, Recording

if TYPE_CHECKING:
    from kineme.studio.reading import ReadingOptions

LARGE = 16_000_000
"""Bytes of a file that takes more than a second to read."""
POSES = 18_000
"""Of a sketch, at most: five a second of an hour."""
OF_SKETCH = 0
"""The revision that a sketch has; tables have others."""


class Sketched(Struct):
    """A recording that is being read, as a page shows it; ``binary`` are its poses."""

    message: Recording
    binary: bytes
    reading: bool = True


def sketched(name: str, path: Path, options: ReadingOptions) -> Sketched | None:
    """What can be shown of a recording before it is read.

    Parameters
    ----------
    name : str
        Its id.
    path : Path
    options : ReadingOptions

    Returns
    -------
    Sketched or None
        None for a file that is soon read, or whose format has no shorter way.
    """
    from kineme.web.display import display_motion
    from kineme.web.page_data import segments_message

    try:
        if path.stat().st_size < LARGE:
            return None
        found = sketch(path, read_options(path, options.file), POSES)
        if found is None:
            return None
        head, binary = display_motion(found.motion, effectors=options.effectors)
    except (OSError, KinemeError):  # reading will say what is wrong
        return None
    table = one_segment("transition", found.n_frames, found.fps)
    message = Recording(
        id=name,
        name=path.name,
        n_frames=found.n_frames,
        fps=found.fps,
        motion=head,
        matrix=MatrixHead(fps=1.0, tile=1, sizes=[], band=None),
        segmentation=segments_message(table),
        levels=[],
        video=video_message(path),
        reading=options_of(path),
        revision=OF_SKETCH,
        can_undo=False,
        can_redo=False,
        saved="",
        finding=True,
        warnings=[],
    )
    return Sketched(message, binary)
