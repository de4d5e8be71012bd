"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (0.9304, -2.83, 4.507)
BORDER = (1.945, 4.24, -7.182)
SENSOR_LINK = (0.9088, -0.6227, 2.502)
SENSOR_BORDER = (-1.53, 2.947, 2.45)
COUNT = (-1.907, 1.312, 2.838, 0.402)
CUT = (0.4668, 1.765, 0.5628, -0.186)
