"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.369, -2.742, 4.117)
BORDER = (1.777, 4.638, -5.373)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.616, 1.132, 2.706, 0.4463)
CUT = (0.6187, 1.816, 0.6201, -0.2356)
