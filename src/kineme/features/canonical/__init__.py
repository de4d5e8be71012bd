"""Features of a body that is the same for all: in them, movements of different people match."""

from kineme.features.canonical.matching import MATCHING_FPS, matching_features

__all__ = ["MATCHING_FPS", "matching_features"]
