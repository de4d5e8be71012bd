"""The papers' own figures and tables on CMU subject 86, made anew.

Trials and annotations (`kineme.reproduction.trials`), published tables, the runs of all methods
with the settings that their authors chose per trial, and the figures. Scores are those of
`kineme.evaluation`. Nothing but the command line (``kineme evaluate cmu86``) imports this room.
"""

from kineme.reproduction.annotations import read_trials
from kineme.reproduction.published import published

__all__ = ["published", "read_trials"]
