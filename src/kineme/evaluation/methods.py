"""The methods of the benchmark under one form: a trial in, a segmentation out.

Presets see the motion alone. ACA, HACA and GMM are told the true number of
classes, as in all published comparisons, and ACA and HACA the lengths of
pieces that their authors chose per trial (Zhou et al., their program).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any

from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.evaluation.labelling import TRANSITION
from kineme.evaluation.trials import Floats, Trial
from kineme.methods.base import Preset
from kineme.methods.baselines import Pieces
from kineme.methods.presets import PRESETS
from kineme.segments.segmentation import Segmentation

Method = Callable[[Trial], Segmentation]

UNIFORM_S = 0.5

# Trial 11 is fast: its authors gave it shorter pieces and fewer centres.
SHORT_PIECES = "86_11"


def method(name: str) -> Method:
    """The method of this name.

    Raises
    ------
    ParameterError : there is none; the message lists those there are
    """
    if name not in METHODS:
        raise ParameterError(f"no method {name!r}; there are {', '.join(METHODS)}")
    return METHODS[name]


def preset_method(preset: Preset) -> Method:
    """Segmentation by a preset, be it a published or a changed one."""
    return partial(_by_preset, preset)


def as_segmentation(pieces: Pieces, trial: Trial, name: str) -> Segmentation:
    """The pieces of a baseline, found at the rate of the recording, as activities."""
    n = len(pieces.clusters)
    return Segmentation.from_columns(
        {
            "level": ["activity"] * n,
            "kind": ["activity"] * n,
            "start_frame": pieces.starts,
            "stop_frame": pieces.stops,
            "cluster": pieces.clusters,
        },
        n_frames=trial.motion.n_frames,
        fps=trial.motion.fps,
        provenance={"kineme": __version__, "method": name, "trial": trial.name},
    )


def _by_preset(preset: Preset, trial: Trial) -> Segmentation:
    from kineme.segmentation.segmenter import segment

    return segment(trial.motion, preset=preset)


def _baseline(name: str, trial: Trial) -> Segmentation:
    return as_segmentation(_PIECES[name](trial), trial, name)


def _aca(trial: Trial) -> Pieces:
    from kineme.methods.baselines.aca import aca

    short: dict[str, Any] = {"shortest": 21, "longest": 36, "centres": 15}
    options = short if trial.name == SHORT_PIECES else {}
    return aca(_log_maps(trial), n_classes=_n_classes(trial), **options)


def _haca(trial: Trial) -> Pieces:
    from kineme.methods.baselines.haca import haca

    short: dict[str, Any] = {"fine_lengths": (7, 9), "coarse_lengths": (3, 4), "centres": 15}
    options = short if trial.name == SHORT_PIECES else {}
    return haca(_log_maps(trial), n_classes=_n_classes(trial), **options)


def _pca(trial: Trial) -> Pieces:
    from kineme.methods.baselines.pca import pca

    return pca(_quaternions(trial), fps=trial.motion.fps)


def _ppca(trial: Trial) -> Pieces:
    from kineme.methods.baselines.pca import ppca

    return ppca(_quaternions(trial), fps=trial.motion.fps)


def _gmm(trial: Trial) -> Pieces:
    from kineme.methods.baselines.gmm import gmm

    return gmm(_quaternions(trial), n_classes=_n_classes(trial))


def _uniform(trial: Trial) -> Pieces:
    from kineme.methods.baselines.uniform import uniform

    return uniform(trial.motion.n_frames, fps=trial.motion.fps, seconds=UNIFORM_S)


def _log_maps(trial: Trial) -> Floats:
    from kineme.features.rotations import joint_quaternions, log_maps

    return log_maps(joint_quaternions(trial.motion))


def _quaternions(trial: Trial) -> Floats:
    from kineme.features.rotations import joint_quaternions

    return joint_quaternions(trial.motion).reshape(trial.motion.n_frames, -1)


def _n_classes(trial: Trial) -> int:
    return len(set(trial.truth.labels) - {TRANSITION})


_PIECES: Mapping[str, Callable[[Trial], Pieces]] = {
    "aca": _aca,
    "haca": _haca,
    "pca": _pca,
    "ppca": _ppca,
    "gmm": _gmm,
    "uniform": _uniform,
}

METHODS: Mapping[str, Method] = MappingProxyType(
    {name: preset_method(preset) for name, preset in PRESETS.items()}
    | {name: partial(_baseline, name) for name in _PIECES}
)
