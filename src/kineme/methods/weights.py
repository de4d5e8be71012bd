"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.37, -2.742, 4.117)
BORDER = (1.782, 4.623, -5.379)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.604, 1.107, 2.717, 0.4454)
CUT = (0.682, 1.844, 0.6135, -0.2712)
