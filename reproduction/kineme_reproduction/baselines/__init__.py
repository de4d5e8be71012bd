"""The methods kineme is compared with, one file each.

They are pure functions on arrays (frames, dims) and return `Segments`.
"""

from kineme_reproduction.baselines.segments import Segments

__all__ = ["Segments"]
