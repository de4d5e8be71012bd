"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (2.04, -2.921, 3.337)
BORDER = (1.571, 5.456, -7.402)
SENSOR_LINK = (1.113, -1.265, 1.985)
SENSOR_BORDER = (-1.62, 3.038, 2.314)
COUNT = (-2.079, 2.216, 1.794, -2.508, 3.581)
CUT = (0.4686, 1.483, 1.23, 0.1777)
