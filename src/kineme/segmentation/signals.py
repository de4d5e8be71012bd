"""From signals to their segments, in one call."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from kineme._checks import check_type, is_number
from kineme.errors import ParameterError
from kineme.features.emg import emg_envelope
from kineme.methods.presets import DEFAULT, ActionPreset, Preset
from kineme.methods.stages import Progress
from kineme.recordings.signals import Signals
from kineme.segmentation.channels import (
    SMOOTHING,
    recurrence_unit,
    search_vectors,
    signal_preset,
)
from kineme.segmentation.from_features import segment_features
from kineme.segments.segmentation import Segmentation

if TYPE_CHECKING:
    from kineme.methods.recurrence.analysis import ActionAnalysis
    from kineme.methods.region_growing.analysis import Analysis


def segment_signals(
    signals: Signals,
    *,
    preset: str | Preset = DEFAULT,
    emg: bool = False,
    smoothing: float = SMOOTHING,
    progress: Progress | None = None,
    **overrides: Any,
) -> Segmentation:
    """Activities, transitions and repetitions of signals, as one table in their own frames.

    Parameters
    ----------
    signals : Signals
    preset : ``kineme``, ``voegele2014`` or ``krueger2017``, or a preset; lengths in metres
        become standard deviations, see :mod:`kineme.segmentation.channels`
    emg : take the envelopes of muscle signals, see :func:`emg_envelope`
    smoothing : seconds over which channels are averaged; 0 for none
    progress : called with the name of each stage before it runs
    **overrides : constants of the preset to change; ``radius`` is the generalised radius R
        in standard deviations

    Raises
    ------
    ParameterError : no such preset or constant, a value it cannot take, or mirroring, for
        which signals have no left and right
    """
    chosen = signal_preset(preset, **overrides)
    return segment_signals_and_analysis(
        signals, chosen, emg=emg, smoothing=smoothing, progress=progress
    )[0]


def segment_signals_and_analysis(
    signals: Signals,
    preset: str | Preset,
    *,
    emg: bool = False,
    smoothing: float = SMOOTHING,
    progress: Progress | None = None,
) -> tuple[Segmentation, Analysis | ActionAnalysis]:
    """The segments, and what each stage found on the way to them (for pictures).

    The preset may be one that `signal_preset` made, or any that it takes.
    """
    check_type(
        signals,
        Signals,
        "segment_signals",
        "kineme.read_signals(path) gives them; arrays go to Segmenter",
    )
    preset = signal_preset(preset)
    if not (is_number(smoothing) and smoothing >= 0):
        raise ParameterError(f"smoothing is {smoothing!r}: give seconds, from 0")
    if progress is not None:
        progress("features")
    start = time.perf_counter()
    if emg:
        envelopes = emg_envelope(signals.values, signals.fps)
        signals = replace(signals, values=envelopes)
    features, parts = search_vectors(signals, preset, smoothing=smoothing)
    notes = [*signals.provenance.notes, *_notes(signals, emg=emg)]
    if isinstance(preset, ActionPreset):
        unit = recurrence_unit(features, preset)
        features = features / unit
        notes.append(f"lengths are in units of {unit:.3g} standard deviations")
    else:
        notes.append("lengths are in standard deviations")
    source = signals.provenance
    return segment_features(
        features,
        preset,
        n_frames=signals.n_frames,
        fps=signals.fps,
        parts=parts,
        source={"path": source.path, "format": source.format, "sha256": source.sha256},
        notes=notes,
        timings={"features": time.perf_counter() - start},
        progress=progress,
    )


def _notes(signals: Signals, *, emg: bool) -> list[str]:
    shown = ", ".join(signals.names[:8]) + (", …" if signals.n_channels > 8 else "")
    notes = [f"channels: {shown}, each divided by its standard deviation"]
    steady = signals.values.min(axis=0) == signals.values.max(axis=0)
    if steady.any():
        names = [name for name, s in zip(signals.names, steady, strict=True) if s]
        notes.append(f"never change and carry no weight: {', '.join(names)}")
    if emg:
        notes.append("muscle signals: rectified and low-passed")
    return notes
