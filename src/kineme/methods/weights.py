"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.261, -2.741, 4.159)
BORDER = (1.742, 4.626, -5.87)
SENSOR_LINK = (0.7553, -0.4396, 2.949)
SENSOR_BORDER = (-1.229, 2.831, 1.985)
COUNT = (-1.724, 1.177, 2.704, 0.4201)
CUT = (0.4344, 1.777, 0.397, -0.1881)
