"""Movements that are like an example, found in features of any recording."""

from kineme.matching.search import THRESHOLD, Matches, search, two_way_distance

__all__ = ["THRESHOLD", "Matches", "search", "two_way_distance"]
