"""The methods of the benchmark under one form: a trial in, a segmentation out.

Most presets see the motion alone. ACA, HACA and GMM are told the true number of classes, as in
all published comparisons, and ACA and HACA the lengths of segments that their authors chose per
trial (Zhou et al., their program).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any

from kineme.evaluation.labelling import TRANSITION
from kineme.evaluation.methods import check_method, segment_by
from kineme.methods.base import Preset
from kineme.methods.presets import PRESETS
from kineme.reproduction.trials import Trial
from kineme.segments.segmentation import Segmentation

Method = Callable[[Trial], Segmentation]

OF_TRIALS: Mapping[tuple[str, str], Mapping[str, Any]] = {
    ("aca", "86_11"): {"shortest": 21, "longest": 36, "centres": 15},
    ("haca", "86_11"): {"fine_lengths": (7, 9), "coarse_lengths": (3, 4), "centres": 15},
}
"""Constants by method and trial: trial 11 is fast, so its segments are shorter."""


def method(name: str) -> Method:
    """The method of this name.

    Parameters
    ----------
    name : str
        Of a preset.

    Returns
    -------
    callable
        From a `Trial` to a `Segmentation`.

    Raises
    ------
    ParameterError
        There is none; the message lists those there are.

    Examples
    --------
    >>> callable(method("haca"))
    True
    """
    check_method(name)
    return partial(_by_name, name)


def preset_method(preset: Preset) -> Method:
    """Segmentation by a preset, be it a published or a changed one.

    Parameters
    ----------
    preset : Preset

    Returns
    -------
    callable
        From a `Trial` to a `Segmentation`.
    """
    return partial(_by_preset, preset)


def _by_name(name: str, trial: Trial) -> Segmentation:
    n_classes = len(set(trial.truth.labels) - {TRANSITION})
    own = OF_TRIALS.get((name, trial.name), {})
    return segment_by(name, trial.motion, n_classes=n_classes, **own)


def _by_preset(preset: Preset, trial: Trial) -> Segmentation:
    from kineme.segmentation.segmenter import segment

    return segment(trial.motion, preset=preset)


METHODS: Mapping[str, Method] = MappingProxyType({name: method(name) for name in PRESETS})
