"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.37, -2.742, 4.117)
BORDER = (1.782, 4.625, -5.38)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.604, 1.107, 2.716, 0.4453)
CUT = (0.6809, 1.856, 0.6217, -0.2749)
