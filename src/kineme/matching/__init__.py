"""Movements that are like an example, found in features of any recording."""

from kineme.matching.embeddings import embedding
from kineme.matching.subsequences import THRESHOLD, Matches, search, two_way_distance

__all__ = ["THRESHOLD", "Matches", "embedding", "search", "two_way_distance"]
