"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.195, -2.65, 4.132)
BORDER = (1.73, 4.669, -5.663)
SENSOR_LINK = (1.113, -1.265, 1.985)
SENSOR_BORDER = (-1.62, 3.038, 2.314)
COUNT = (-2.179, 1.531, 1.237, -1.594, 4.014)
CUT = (0.3622, 1.632, 0.5857, -0.1181)
