"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.442, -2.809, 4.026)
BORDER = (1.831, 4.644, -6.009)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.589, 1.173, 2.456, 0.4323)
CUT = (0.5942, 1.798, 0.6214, -0.2309)
