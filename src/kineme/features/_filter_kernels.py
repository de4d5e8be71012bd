"""Compiled loop of the filters: a cascade of second-order sections over all channels.

It replaces `scipy.signal.sosfiltfilt`, which takes over a second to import.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS


@njit("void(float64[:, ::1], float64[:, ::1])", **OPTIONS)
def filter_sections(values, sections):
    """Filter (frames, channels) in place by sections (sections, 5): b0, b1, b2, a1, a2.

    The initial state of each section is that after a constant input of the first frame.
    """
    frames, channels = values.shape
    near, far = np.empty(channels), np.empty(channels)  # the state, direct form II transposed
    for s in range(len(sections)):
        b0, b1, b2, a1, a2 = sections[s]
        # Gain for a constant input, from which the steady state follows.
        gain = (b0 + b1 + b2) / (1 + a1 + a2)
        for c in range(channels):
            near[c] = (gain - b0) * values[0, c]
            far[c] = (b2 - a2 * gain) * values[0, c]
        for t in range(frames):
            for c in range(channels):
                x = values[t, c]
                y = b0 * x + near[c]
                near[c] = b1 * x - a1 * y + far[c]
                far[c] = b2 * x - a2 * y
                values[t, c] = y
