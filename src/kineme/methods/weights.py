"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.37, -2.782, 4.126)
BORDER = (1.835, 4.639, -6.006)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.612, 1.18, 2.487, 0.4308)
CUT = (0.6015, 1.809, 0.6248, -0.2363)
