"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (0.7799, -2.389, 4.599)
BORDER = (1.856, 4.498, -6.978)
SENSOR_LINK = (0.3236, -0.1838, 3.014)
SENSOR_BORDER = (-2.008, 3.293, 2.971)
COUNT = (-0.9275, 1.424, 1.366, -1.634, 2.641)
CUT = (0.3653, 1.494, 0.6074, -0.06302)
