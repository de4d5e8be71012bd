"""Example data: synthetic recordings with known truth, and a bundled recording."""

from kineme.datasets.bundled import bundled_recording, bundled_truth
from kineme.datasets.figure import ACTIONS
from kineme.datasets.synthetic import Action, SyntheticRecording, random_recording, synthesize

__all__ = [
    "ACTIONS",
    "Action",
    "SyntheticRecording",
    "bundled_recording",
    "bundled_truth",
    "random_recording",
    "synthesize",
]
