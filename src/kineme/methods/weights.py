"""Weights of the statistics by which it is told how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (0.0, 0.0, 0.0, 0.0)
BORDER = (0.0, 0.0, 0.0, 0.0)
SENSOR_LINK = (0.0, 0.0, 0.0, 0.0)
SENSOR_BORDER = (0.0, 0.0, 0.0, 0.0)
COUNT = (0.0, 0.0, 0.0, 0.0)
CUT = (0.0, 0.0, 0.0, 0.0)
