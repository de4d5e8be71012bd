"""Movements that are like an example, found in features of any recording."""

from kineme.matching.subsequences import THRESHOLD, Matches, search, two_way_distance
from kineme.matching.whole_segments import embedding

__all__ = ["THRESHOLD", "Matches", "embedding", "search", "two_way_distance"]
