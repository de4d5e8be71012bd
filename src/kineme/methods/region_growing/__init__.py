"""The published methods of 2014 and 2017: neighbour graph, growing regions, warping paths."""

Step = tuple[int, int]
"""Rows and columns that a warping step goes ahead."""
BASIC_STEPS: tuple[Step, ...] = ((1, 1), (1, 0), (0, 1))
