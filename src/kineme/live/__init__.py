"""Streams: recordings segmented while they are made.

Rows become frames in `intake`, the recent past is segmented again and again in `stream`, and what
is older than the delay becomes final in `finals`. `journal` keeps the rows on the disk, and
`sources` brings them from elsewhere.
"""

from kineme.live.events import ActivityEnded, ActivityStarted, Event, Gap, Notice, Repetition
from kineme.live.stream import Stream

__all__ = ["ActivityEnded", "ActivityStarted", "Event", "Gap", "Notice", "Repetition", "Stream"]
