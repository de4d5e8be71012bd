"""Slow, literal versions of the formulas: the oracle of every fast path."""

from naive.baselines import *  # noqa: F403
from naive.evaluation import *  # noqa: F403
from naive.graph import *  # noqa: F403
from naive.recordings import *  # noqa: F403
from naive.regions import *  # noqa: F403
from naive.repetitions import *  # noqa: F403
