"""Recordings: the motion of a body, or signals, as read from a file and segmented."""

from kineme.recordings.motion import Motion
from kineme.recordings.provenance import Note, Provenance
from kineme.recordings.recording import Recording
from kineme.recordings.signals import Signals
from kineme.recordings.skeleton import Skeleton

__all__ = ["Motion", "Note", "Provenance", "Recording", "Signals", "Skeleton"]
