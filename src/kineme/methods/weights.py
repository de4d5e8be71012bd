"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.532, -3.113, 3.893)
BORDER = (1.72, 4.72, -6.066)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.535, 1.235, 2.41, 0.3952)
CUT = (0.5662, 1.81, 0.5637, -0.2348)
