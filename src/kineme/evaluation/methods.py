"""Any method on any recording: the presets, and the baselines that they are compared with."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from kineme.errors import MotionError, ParameterError
from kineme.methods.baselines import Pieces
from kineme.methods.presets import PRESETS
from kineme.recordings.motion import Motion
from kineme.recordings.signals import Signals
from kineme.segments.segmentation import Segmentation

Floats = NDArray[np.float64]

SIGNALS_FPS = 30.0
"""Rate at which the baselines see signals, which may be sampled far more often than they change."""
UNIFORM_S = 0.5


def method_names() -> tuple[str, ...]:
    """The methods that can be evaluated, the default first.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> method_names()[0]
    'kineme'
    """
    return (*PRESETS, *_BASELINES)


def segment_by(name: str, recording: Motion | Signals, *, n_classes: int) -> Segmentation:
    """The segments that a method finds in a recording.

    Parameters
    ----------
    name : str
        One of `method_names`.
    recording : Motion or Signals
        What is segmented.
    n_classes : int
        The number of classes, told to the methods that have to be (ACA, HACA, GMM).

    Returns
    -------
    Segmentation
        In frames of the recording.

    Raises
    ------
    ParameterError
        There is no such method, or the recording is too short for it.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> len(segment_by("uniform", motion, n_classes=4).activities)
    97
    """
    if name in PRESETS:
        if isinstance(recording, Signals):
            from kineme.segmentation.signals import segment_signals

            return segment_signals(recording, preset=name)
        from kineme.segmentation.segmenter import segment

        return segment(recording, preset=name)
    if name not in _BASELINES:
        raise ParameterError(f"no method {name!r}; there are {', '.join(method_names())}")
    return _by_baseline(name, recording, n_classes)


def _by_baseline(name: str, recording: Motion | Signals, n_classes: int) -> Segmentation:
    features, fps = _seen_by(name, recording)
    pieces = _BASELINES[name](features, fps, n_classes)
    cuts = np.floor(pieces.cuts * (recording.fps / fps) + 0.5).astype(np.int64)
    starts = np.concatenate([[0], cuts])
    stops = np.concatenate([cuts, [recording.n_frames]])
    kept = stops > starts
    return Segmentation.from_columns(
        {
            "level": np.full(kept.sum(), "activity"),
            "kind": np.full(kept.sum(), "activity"),
            "start_frame": starts[kept],
            "stop_frame": stops[kept],
            "cluster": pieces.clusters[kept],
        },
        n_frames=recording.n_frames,
        fps=recording.fps,
        provenance={"method": name},
    )


def _seen_by(name: str, recording: Motion | Signals) -> tuple[Floats, float]:
    """Features and their rate: rotations of joints as published, else what was recorded."""
    if isinstance(recording, Signals):
        from kineme.segmentation.channels import at_rate, standardized

        fps = min(SIGNALS_FPS, recording.fps)
        return standardized(at_rate(recording.values, recording.fps, fps)), fps
    from kineme.methods.baselines.joints import joint_quaternions, log_maps

    n = recording.n_frames
    try:
        rotations = joint_quaternions(recording)
    except MotionError:  # not the joints of CMU's skeleton
        places = recording.positions - recording.positions.mean(axis=1, keepdims=True)
        return places.reshape(n, -1), recording.fps
    as_vectors = name in ("aca", "haca")
    return log_maps(rotations) if as_vectors else rotations.reshape(n, -1), recording.fps


def _aca(features: Floats, _: float, n_classes: int) -> Pieces:
    from kineme.methods.baselines.aca import aca

    return aca(features, n_classes=n_classes)


def _haca(features: Floats, _: float, n_classes: int) -> Pieces:
    from kineme.methods.baselines.haca import haca

    return haca(features, n_classes=n_classes)


def _pca(features: Floats, fps: float, _: int) -> Pieces:
    from kineme.methods.baselines.pca import pca

    return pca(features, fps=fps)


def _ppca(features: Floats, fps: float, _: int) -> Pieces:
    from kineme.methods.baselines.pca import ppca

    return ppca(features, fps=fps)


def _gmm(features: Floats, _: float, n_classes: int) -> Pieces:
    from kineme.methods.baselines.gmm import gmm

    return gmm(features, n_classes=n_classes)


def _uniform(features: Floats, fps: float, _: int) -> Pieces:
    from kineme.methods.baselines.uniform import uniform

    return uniform(len(features), fps=fps, seconds=UNIFORM_S)


_BASELINES: Mapping[str, Callable[[Floats, float, int], Pieces]] = {
    "aca": _aca,
    "haca": _haca,
    "pca": _pca,
    "ppca": _ppca,
    "gmm": _gmm,
    "uniform": _uniform,
}
