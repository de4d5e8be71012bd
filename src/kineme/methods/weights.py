"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.212, -2.736, 4.24)
BORDER = (1.762, 4.594, -5.919)
SENSOR_LINK = (0.9088, -0.6227, 2.502)
SENSOR_BORDER = (-1.53, 2.947, 2.45)
COUNT = (-1.773, 1.173, 2.737, 0.4256)
CUT = (0.4154, 1.76, 0.4035, -0.1769)
