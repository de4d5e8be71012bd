"""Any method on any recording, told what it has to be told.

ACA, HACA and GMM have to be told the number of classes, as in all published comparisons; others
find it.
"""

from __future__ import annotations

from typing import Any

from kineme.errors import ParameterError
from kineme.methods.presets import PRESETS
from kineme.recordings.motion import Motion
from kineme.recordings.signals import Signals
from kineme.segments.segmentation import Segmentation

TOLD = "n_classes"
"""The constant of presets that have to be told the number of classes."""


def segment_by(
    name: str, recording: Motion | Signals, *, n_classes: int, **constants: Any
) -> Segmentation:
    """The segments that a method finds in a recording.

    Parameters
    ----------
    name : str
        Of a preset, see `kineme.PRESETS`.
    recording : Motion or Signals
        What is segmented.
    n_classes : int
        The true number of classes, for methods that have to be told.
    **constants
        Of the preset to change.

    Returns
    -------
    Segmentation
        In frames of the recording.

    Raises
    ------
    ParameterError
        There is no such preset, or the recording is too short for it.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> len(segment_by("uniform", motion, n_classes=4).activities)
    97
    """
    from kineme.segmentation.segmenter import segment

    check_method(name)
    if getattr(PRESETS[name], TOLD, 0) is None:
        constants = {TOLD: n_classes, **constants}
    return segment(recording, preset=name, **constants)


def check_method(name: str) -> None:
    """Refuse what is no method.

    Parameters
    ----------
    name : str

    Raises
    ------
    ParameterError
        The message lists those there are.
    """
    if name not in PRESETS:
        raise ParameterError(f"no method {name!r}; there are {', '.join(PRESETS)}")
