"""The published methods of 2014 and 2017: neighbour graph, growing regions, warping paths."""
