"""Slow, literal versions of kernels and formulas, to test the fast ones against."""

from naive.baselines import *  # noqa: F403
from naive.evaluation import *  # noqa: F403
from naive.graph import *  # noqa: F403
from naive.recordings import *  # noqa: F403
from naive.regions import *  # noqa: F403
from naive.repetitions import *  # noqa: F403
