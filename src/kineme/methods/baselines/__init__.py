"""The methods kineme is compared with, one file each.

They are pure functions on arrays (frames, dims) and return `Pieces`.
"""

from kineme.methods.baselines.pieces import Pieces

__all__ = ["Pieces"]
