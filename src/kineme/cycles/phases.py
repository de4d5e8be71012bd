"""Places in a cycle, in per cent of it: its end is the start of the next, so 99 and 1 are near.

Means are those of directions on a circle [1]_, and differences go the shorter way round.

References
----------
.. [1] K. V. Mardia, P. E. Jupp, "Directional Statistics", 2000, section 2.2.
"""

from __future__ import annotations

import numpy as np

from kineme._util.arrays import Floats

PHASES = ("min_at", "max_at")
"""Of the statistics of a channel, those that are places in a cycle."""

CYCLE = 100.0


def is_phase(measure: str) -> bool:
    """Return whether a measure, as ``knee_l.max_at``, is a place in a cycle."""
    return measure.rpartition(".")[2] in PHASES


def mean_phase(phases: Floats) -> float:
    """Return the mean direction, from 0 to 100; nan of none.

    Examples
    --------
    >>> round(mean_phase(np.array([98.0, 4.0])), 6), round(mean_phase(np.array([40.0, 50.0])), 6)
    (1.0, 45.0)
    """
    if not len(phases):
        return np.nan
    # Unit vectors on a circle that is one cycle long.
    directions = np.exp(2j * np.pi * phases / CYCLE)
    return float(np.angle(directions.sum()) / (2 * np.pi) * CYCLE % CYCLE)


def phase_differences(differences: Floats) -> Floats:
    """Differences of places in a cycle, from -50 to 50.

    Examples
    --------
    >>> phase_differences(np.array([96.0, -3.0, 50.0])).tolist()
    [-4.0, -3.0, -50.0]
    """
    # Shifted by half a cycle, so that the modulo leaves -50 to 50 instead of 0 to 100.
    return np.asarray((differences + CYCLE / 2) % CYCLE - CYCLE / 2)
