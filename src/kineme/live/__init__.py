"""Streams: segment recordings while they are made.

`sources` yields rows, `intake` resamples them to frames, `stream` segments the recent past at
regular intervals (by `looking`), and `finals` holds what is older than the delay. `journal` writes
rows to disk, `outputs` sends events to other programs.
"""

from kineme.live.events import ActivityEnded, ActivityStarted, Event, Gap, Notice, Repetition
from kineme.live.stream import Stream

__all__ = ["ActivityEnded", "ActivityStarted", "Event", "Gap", "Notice", "Repetition", "Stream"]
