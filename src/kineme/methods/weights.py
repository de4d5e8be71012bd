"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (0.9304, -2.83, 4.507)
BORDER = (1.945, 4.24, -7.182)
SENSOR_LINK = (0.3236, -0.1838, 3.014)
SENSOR_BORDER = (-2.008, 3.293, 2.971)
COUNT = (-1.929, 1.317, 2.857, 0.4028)
CUT = (0.4646, 1.765, 0.5628, -0.1851)
