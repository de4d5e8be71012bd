"""Paths of the recording that is included in the package.

A synthetic figure walks, squats, circles its arms, jumps, runs and kicks. Its true segments are in
a second file. ``tests/helpers/make_bundled.py`` creates both.
"""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).parent / "recordings"


def bundled_recording() -> Path:
    """Return the path of the bundled BVH file: 48 s of exercises at 60 Hz.

    Examples
    --------
    >>> import kineme
    >>> kineme.read(kineme.bundled_recording()).n_frames
    2898
    """
    return _FOLDER / "exercises.bvh"


def bundled_truth() -> Path:
    """Return the path of the bundled recording's true segments, for `kineme.read_segments`.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> kineme.read_segments(bundled_truth(), fps=60).activities[0].label
    'walk'
    """
    return _FOLDER / "exercises.json"
