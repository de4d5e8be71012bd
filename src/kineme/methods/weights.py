"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (1.448, -3.019, 3.952)
BORDER = (1.672, 4.699, -5.83)
SENSOR_LINK = (2.04, -1.392, 1.849)
SENSOR_BORDER = (1.244, 0, 0)
COUNT = (-1.541, 1.203, 2.679, 0.3961)
CUT = (0.4794, 1.719, 0.5623, -0.1682)
