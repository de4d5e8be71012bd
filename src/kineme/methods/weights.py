"""Weights of the statistics that tell how sure something is; see ``confidence.py``.

Written by ``python benchmarks/confidence.py --fit``.
"""

LINK = (0.7799, -2.389, 4.599)
BORDER = (1.856, 4.498, -6.978)
SENSOR_LINK = (0.9088, -0.6227, 2.502)
SENSOR_BORDER = (-1.53, 2.947, 2.45)
COUNT = (-0.9275, 1.424, 1.366, -1.634, 2.641)
CUT = (0.3653, 1.494, 0.6074, -0.06302)
