"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.499, -2.617, 3.808)
BORDER = (1.853, 4.484, -5.247)
SENSOR_LINK = (0.6209, -0.7353, 2.853)
SENSOR_BORDER = (-1.433, 2.311, 2.398)
COUNT = (-1.915, 1.51, 1.045, -1.564, 3.797)
CUT = (0.4001, 1.612, 0.5396, -0.1209)
