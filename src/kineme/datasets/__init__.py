"""Example data: synthetic recordings with known truth, and a bundled recording."""

from kineme.datasets.actions import ACTIONS
from kineme.datasets.bundled import bundled_recording, bundled_truth
from kineme.datasets.synthetic import SyntheticRecording, random_recording, synthesize
from kineme.datasets.timeline import Action

__all__ = [
    "ACTIONS",
    "Action",
    "SyntheticRecording",
    "bundled_recording",
    "bundled_truth",
    "random_recording",
    "synthesize",
]
