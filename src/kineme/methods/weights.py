"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (2.0, -6.0, 3.0)
BORDER = (1.0, 4.0, -4.0)
SENSOR_LINK = (1.0, -1.0, 1.0)
SENSOR_BORDER = (1.0, 0.0, 0.0)
COUNT = (-3.0, 2.0, 1.0, 1.0, 3.0)
CUT = (0.0, 1.0, -1.0, 0.5)
