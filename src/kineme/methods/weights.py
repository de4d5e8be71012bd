"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.367, -2.74, 4.12)
BORDER = (1.723, 4.714, -5.283)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.431, 1.071, 2.542, 0.455)
CUT = (0.9113, 1.692, 1.128, -0.2612)
