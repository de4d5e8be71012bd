"""What a method sees of channels: the working rate, standard deviations, stacked features.

What a channel measures, and in which unit, plays no part: each is divided by
its standard deviation. Distances of features are divided by
√(window · channels), so that a radius R means the same whatever the number of
channels: the generalised radius r = R √(window · channels) of Krüger et al. 2017.

The published methods' lengths, metres of a body, become standard deviations
(see their presets). The method ``kineme`` takes its unit from the recording
itself: the distance at which its samples recur, of which noise and irregularity
are part.
"""

from __future__ import annotations

import numpy as np

from kineme._arrays import Floats
from kineme.features import offsets_in_frames, stack
from kineme.features.channels import at_rate, standardized
from kineme.features.emg import emg_envelope
from kineme.methods.base import Preset
from kineme.recordings import Signals
from kineme.segmentation.joints import by_distances, joints_among
from kineme.segmentation.spans import RecordedSpan
from kineme.segmentation.views import View

# Names of channels in a note.
NAMED = 8


def view_of_signals(
    signals: Signals,
    preset: Preset,
    *,
    emg: bool = False,
    standardize: bool = True,
    unit: float | None = None,
) -> View:
    """Return the features of signals between their gaps, at the working rate of the preset.

    Parameters
    ----------
    signals : Signals
    preset : Preset
        For signals, see `kineme.methods.resolve_preset`.
    emg : bool
        Take the envelopes of muscle signals first.
    standardize : bool
        Divide each channel by its standard deviation.
    unit : float, optional
        What one unit of the preset's lengths is in these channels; by default the preset
        finds out.
    """
    values = emg_envelope(signals.values, signals.fps) if emg else signals.values
    rows, spans = [], []
    for start, stop in signals.spans():
        row = at_rate(
            values[start:stop], signals.fps, preset.working_fps, smoothing=preset.smoothing
        )
        rows.append(row)
        spans.append(RecordedSpan(start, stop, len(row)))
    notes = _notes(signals, values, emg=emg, standardize=standardize)
    descriptive = standardize and not emg  # what channels are may be told by their names and values
    points = joints_among(signals) if preset.accepts_joints and descriptive else None
    if points is not None:
        rows = by_distances(rows, points, preset.working_fps)
        notes.append(f"{len(points)} points with bones: seen by how far they are from each other")
    features = _stacked(rows, preset, standardize=standardize)
    if unit is None:
        unit = preset.signal_unit(features)
    named = "standard deviations" if standardize else "units of the channels"
    if unit != 1:
        features = features / unit
        notes.append(f"lengths are in units of {unit:.3g} {named}")
    elif preset.unit != "any":
        notes.append(f"lengths are in {named}")
    ends = np.cumsum([span.n_samples for span in spans])[:-1]
    split = np.split(features, ends)
    return View(split, spans, notes, joints=points is not None)


def _stacked(rows: list[Floats], preset: Preset, *, standardize: bool) -> Floats:
    """Features of all spans; their distances are root mean squares over window and channels."""
    ends = np.cumsum([len(row) for row in rows])[:-1]
    joined = np.concatenate(rows)
    scaled = standardized(joined) if standardize else joined
    offsets = offsets_in_frames(preset.offsets, preset.working_fps)
    stacked = np.concatenate([stack(row, offsets) for row in np.split(scaled, ends)])
    return np.asarray(stacked / np.sqrt(stacked.shape[1]), np.float64)


def _notes(signals: Signals, values: Floats, *, emg: bool, standardize: bool) -> list[str]:
    shown = ", ".join(signals.names[:NAMED]) + (", …" if signals.n_channels > NAMED else "")
    scaled = "each divided by its standard deviation" if standardize else "as they are"
    notes = [f"channels: {shown}, {scaled}"]
    steady = values.min(axis=0) == values.max(axis=0)
    if steady.any() and standardize:
        names = [name for name, still in zip(signals.names, steady, strict=True) if still]
        notes.append(f"never change and carry no weight: {', '.join(names)}")
    if emg:
        notes.append("muscle signals: rectified and low-passed")
    return notes
