"""The papers' own figures and tables on CMU subject 86, made anew.

Trials and their truths (`kineme.reproduction.trials`); the runs of all methods with the settings
that their authors chose per trial, and the published tables (`kineme.reproduction.benchmark`); and
the figures. Scores are those of `kineme.evaluation`. Nothing but the command line
(``kineme evaluate cmu86``) imports this room.
"""

from kineme.reproduction.benchmark import published
from kineme.reproduction.trials import read_trials

__all__ = ["published", "read_trials"]
