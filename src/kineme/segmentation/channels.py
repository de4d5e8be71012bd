"""Channels made comparable: the working rate, standard deviations, search vectors.

What a channel measures, and in which unit, plays no part: each is divided by
its standard deviation. Distances of search vectors are divided by
√(window · channels), so that a radius R means the same whatever the number of
channels: the generalised radius r = R √(window · channels) of Krüger et al. 2017.

The published methods' lengths are metres of a body. A pose channel of a body
varies by about 13 cm (the mean over subject 86 of the CMU database), so that a
radius of 19 cm over 15 channels, 4.9 cm for each, becomes 0.38 standard
deviations. The method ``kineme`` takes its unit from the recording itself: the
distance at which its moments recur, of which noise and irregularity are part.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import check_rates
from kineme.features import offsets_in_frames, stack
from kineme.methods.presets import ActionPreset, Preset, RegionPreset, resolve_preset
from kineme.recordings.signals import Signals
from kineme.segmentation.parts import Part

Floats = NDArray[np.float64]

SMOOTHING = 0.1
"""Seconds over which channels are averaged; ``kineme`` compares moments so far apart."""

POSE_CHANNELS, POSE_DEVIATION = 15, 0.13
"""Numbers in a pose, and the metres by which each of them varies."""

RECURS_AT = 0.2
"""The distance, in the unit of ``kineme``'s scales, at which the median moment recurs: a
quarter beyond the largest scale, so that about half of the moments count as recurring well."""

NEAREST = 0.02
"""Standard deviations: what recurs nearer than this recurs exactly, as in made-up signals."""

DEFAULTS: Mapping[str, Mapping[str, Any]] = {"kineme": {"any_pace": False}}
"""Constants that presets given by name have for signals. Few channels at one moment tell little,
so pace counts: what is the same at another is another action, as running is to a sensor that walks.
"""

_LENGTHS = ("radius", "growth_radius", "zero_cost")
_TINY, _HUGE = 1e-9, 1e9


def at_rate(values: ArrayLike, fps: float, new: float, *, smoothing: float = SMOOTHING) -> Floats:
    """The channels at the times 0, 1/new, 2/new, … up to their last frame.

    Each value is the mean over ``smoothing`` seconds around its time, over a
    frame of the old or new rate where that is longer: nothing folds back from
    above the new rate, and a lower rate is interpolated in a line. At the ends
    the mean is over what is there.

    Parameters
    ----------
    values : (frames, channels)
    fps : their rate
    new : the rate wanted
    smoothing : seconds

    Raises
    ------
    ParameterError : the rate wanted is beyond all measure
    """
    check_rates(fps, new)
    held = np.asarray(values, np.float64)
    middle: Floats = held.mean(axis=0)  # sums of what is left lose no digits to a large offset
    sums = np.concatenate([np.zeros((1, held.shape[1])), np.cumsum(held - middle, axis=0)])
    n = int((len(held) - 1) * new / fps + 1e-9) + 1
    times = np.arange(n) / new
    half = max(smoothing, 1 / fps, 1 / new) / 2
    starts = np.clip((times - half) * fps + 0.5, 0, len(held))
    stops = np.clip((times + half) * fps + 0.5, 0, len(held))
    means = (_at(sums, stops) - _at(sums, starts)) / (stops - starts)[:, None]
    return np.asarray(means + middle, np.float64)


def standardized(values: ArrayLike) -> Floats:
    """The channels with mean 0 and standard deviation 1; those that never change are 0."""
    centred = np.asarray(values, np.float64)
    centred = centred - centred.mean(axis=0)
    largest = np.abs(centred).max(axis=0)
    steady = largest <= 1e-12 * np.abs(values).max(axis=0)
    scaled: Floats = centred / np.where(steady, 1.0, largest)  # squares of tiny numbers vanish
    scaled /= np.where(steady, 1.0, scaled.std(axis=0))
    scaled[:, steady] = 0.0
    return scaled


def search_vectors(
    signals: Signals, preset: Preset, *, smoothing: float = SMOOTHING
) -> tuple[Floats, list[Part]]:
    """Search vectors (frames, dims) at the working rate, and the stretches they are of.

    Their distances are root mean squares over window and channels, in standard deviations.
    """
    working = preset.working_fps
    parts, rows = [], []
    for start, stop in signals.stretches():
        row = at_rate(signals.values[start:stop], signals.fps, working, smoothing=smoothing)
        rows.append(row)
        parts.append(Part(start, stop, len(row)))
    scaled = standardized(np.concatenate(rows))
    ends = np.cumsum([part.n_working for part in parts])[:-1]
    offsets = offsets_in_frames(preset.offsets, working)
    stacked = np.concatenate([stack(part, offsets) for part in np.split(scaled, ends)])
    return stacked / np.sqrt(stacked.shape[1]), parts


def signal_preset(preset: str | Preset, **overrides: Any) -> Preset:
    """The preset with its lengths as standard deviations; overrides are taken as such.

    Metres become standard deviations once: what comes out can be passed on to
    `segment_signals` and `Segmenter` as it is. A preset given by name starts from
    `DEFAULTS`, one given as an object keeps what it says.

    Raises
    ------
    ParameterError : no such preset or constant, or a value it cannot take
    """
    if isinstance(preset, str):
        overrides = {**DEFAULTS.get(preset, {}), **overrides}
    chosen = resolve_preset(preset)
    if isinstance(chosen, RegionPreset) and chosen.unit == "metres":
        per_channel = np.sqrt(POSE_CHANNELS * len(chosen.offsets)) * POSE_DEVIATION
        lengths = {name: getattr(chosen, name) for name in _LENGTHS}
        scaled = {name: v / per_channel for name, v in lengths.items() if v is not None}
        chosen = replace(chosen, unit="standard deviations", **scaled)
    return resolve_preset(chosen, **overrides)


def recurrence_unit(features: Floats, preset: ActionPreset) -> float:
    """The length in which the median moment of the recording recurs at `RECURS_AT`.

    1 where nothing is long enough to recur.
    """
    from kineme.methods.recurrence.recurrence import recurrence  # compiled code, loaded where used

    scales = recurrence(
        features,
        step=preset.step,
        width=max(1, preset.moments(preset.window)),
        phase=preset.moments(preset.phase),
        rank=preset.moments(preset.recurrence_time),
        low=_TINY,
        high=_HUGE,
        softness=preset.softness,
    ).scales
    known = scales[scales < _HUGE / 2]
    return max(float(np.median(known)), NEAREST) / RECURS_AT if len(known) else 1.0


def _at(sums: Floats, at: Floats) -> Floats:
    """Running sums at fractional frames."""
    before = np.minimum(at.astype(np.intp), len(sums) - 2)
    share = (at - before)[:, None]
    between: Floats = (1 - share) * sums[before] + share * sums[before + 1]
    return between
