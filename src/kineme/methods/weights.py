"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.344, -2.695, 4.083)
BORDER = (1.774, 4.492, -5.268)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.62, 1.136, 2.669, 0.466)
CUT = (0.5931, 1.778, 0.6227, -0.21)
