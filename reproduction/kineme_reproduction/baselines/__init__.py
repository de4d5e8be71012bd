"""Methods that kineme is compared with.

They are pure functions on arrays (frames, dims) and return `Segments`.
"""

from kineme_reproduction.baselines.segments import Segments

__all__ = ["Segments"]
