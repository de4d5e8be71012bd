"""Cycles that begin at an event, instead of at equal phase.

Which repetitions there are stays as the segmentation has them. Of each, the event nearest to the
usual phase is its start, and that of the repetition after it its stop. A cycle whose event is
missing stays in the table and says so.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import as_floats
from kineme.cycles.borders import vertex
from kineme.cycles.channels import channels_of
from kineme.cycles.events import OFF, STRIKE, foot_events, plain_name
from kineme.cycles.runs import Repetition, movement
from kineme.errors import ParameterError
from kineme.labels.c3d_events import SAME_S
from kineme.recordings import Motion, Signals

_EXTREME = re.compile(r"(?P<channel>.+?)[ _]+(?P<which>max|min)")
_CROSSING = re.compile(r"(?P<channel>.+?)\s*(?P<sign>[<>])\s*(?P<level>[-+]?[\d.]+(?:e[-+]?\d+)?)")


def anchor_repetitions(
    found: Sequence[Repetition],
    recordings: Sequence[Motion | Signals],
    groups: Sequence[Mapping[int | str, Hashable]],
    anchor: str | Sequence[float],
    beside: Sequence[Signals] = (),
) -> list[Repetition]:
    """Return the repetitions from event to event.

    Parameters
    ----------
    found : sequence of Repetition
    recordings : sequence of Motion or Signals
    groups : sequence of mapping
        Of each recording the group of each `movement`, which has one usual phase.
    anchor : str or sequence of float
        ``knee_r max``, ``knee_r > 40`` (``<``: where it falls below), an event of the file, or a
        foot contact as ``left foot strike``; or the seconds of events of the one recording.
    beside : sequence of Signals
        Whose channels may be anchors as well.

    Raises
    ------
    ParameterError
        There is no such channel or event.
    """
    text = anchor if isinstance(anchor, str) else ""
    extreme = _EXTREME.fullmatch(text.strip())
    members: dict[Hashable, list[int]] = {}
    for i, each in enumerate(found):
        # Repetitions without a group are summarised by their cluster or label itself.
        what = movement(each.segment)
        members.setdefault(groups[each.recording].get(what, what), []).append(i)
    starts = np.full(len(found), np.nan)
    if extreme is not None:
        curves = [_curve(each, extreme["channel"], beside) for each in recordings]
        sign = 1.0 if extreme["which"] == "max" else -1.0
        for rows in members.values():
            starts[rows] = _extremes([found[i] for i in rows], curves, sign)
    else:
        times = [_times(each, anchor, beside) for each in recordings]
        for rows in members.values():
            starts[rows] = _nearest([found[i] for i in rows], times)
    return _from_start_to_start(found, starts)


Curve = tuple[Floats, float]


def _curve(recording: Motion | Signals, name: str, beside: Sequence[Signals]) -> Curve:
    channels = channels_of(recording, [name], beside=beside)
    if len(channels) > 1:
        raise ParameterError(f"an anchor is one channel, and {name!r} names {len(channels)}")
    return channels[0].values(), channels[0].fps


def _extremes(found: Sequence[Repetition], curves: Sequence[Curve], sign: float) -> Floats:
    """When a channel is largest in each repetition, about the phase at which it usually is."""
    # Without 100 %, which is 0 % of the next cycle.
    share = np.linspace(0, 1, 101)[:-1]
    sampled = []
    for each in found:
        values, fps = curves[each.recording]
        at = (each.start + share * (each.stop - each.start)) * fps
        # Negative for a minimum, so that the largest value is searched in both cases.
        sampled.append(np.interp(at, np.arange(len(values)), sign * values))
    usual = np.array(sampled)
    complete = np.isfinite(usual).all(axis=1)
    # A repetition with a gap must not hide the usual phase of the others.
    if not complete.any():
        return np.full(len(found), np.nan)
    phase = share[int(usual[complete].mean(axis=0).argmax())]
    times = np.full(len(found), np.nan)
    for i, each in enumerate(found):
        values, fps = curves[each.recording]
        first, last = _window(each, phase)
        # Whole frames within the window, limited to the recording.
        frames = np.arange(max(0, int(np.ceil(first * fps))), min(len(values), int(last * fps) + 1))
        if len(frames) and np.isfinite(values[frames]).all():
            frame = int(frames[(sign * values[frames]).argmax()])
            # An end of the recording has no neighbour for the parabola, which finds a minimum.
            inner = 0 < frame < len(values) - 1
            shift = vertex(*(-sign * values[frame - 1 : frame + 2])) if inner else 0.0
            times[i] = (frame + shift) / fps
    return times


def _window(each: Repetition, phase: float) -> tuple[float, float]:
    """Seconds within half a cycle of a phase of a repetition."""
    length = each.stop - each.start
    return each.start + (phase - 0.5) * length, each.start + (phase + 0.5) * length


def _times(
    recording: Motion | Signals, anchor: str | Sequence[float], beside: Sequence[Signals]
) -> Floats:
    """Return the seconds of the events of a recording that an anchor names."""
    if not isinstance(anchor, str):
        return np.sort(as_floats(anchor, "anchor").ravel())
    crossing = _CROSSING.fullmatch(anchor.strip())
    if crossing is not None:
        values, fps = _curve(recording, crossing["channel"], beside)
        return _crossings(values, float(crossing["level"]), rises=crossing["sign"] == ">") / fps
    name = plain_name(anchor)
    marked = np.array(
        [at for at, text in recording.provenance.events if plain_name(text) == name], np.float64
    )
    if name.endswith((STRIKE, OFF)):
        # Contacts found from the movement fill in what the file did not mark.
        return _correct(_contacts(recording, name, needed=len(marked) == 0), marked)
    if len(marked):
        return np.sort(marked)
    names = sorted({text for _, text in recording.provenance.events})
    raise ParameterError(
        f"no event {anchor!r}; there are {', '.join([*names, 'left foot strike, and so on'])}; "
        "of a channel give its largest value or a threshold, as in 'knee_r max', 'knee_r > 40'"
    )


def _contacts(recording: Motion | Signals, name: str, *, needed: bool) -> Floats:
    """Return the foot contacts found, none where there is no foot and none is needed."""
    try:
        return foot_events(recording).at(name)
    except ParameterError:
        if needed:
            raise
        return np.empty(0)


def _correct(found: Floats, marked: Floats) -> Floats:
    """Return marked events, and those found that none marked is near.

    A laboratory often marks the contacts on its force plates only.
    """
    # (found,): distance to the nearest marked event; infinite where none is marked.
    apart = np.abs(found[:, None] - marked).min(axis=1, initial=np.inf)
    return np.sort(np.concatenate([found[apart >= SAME_S], marked]))


def _crossings(values: Floats, level: float, *, rises: bool) -> Floats:
    """Frames, between two of them, at which values come to a level from below, or from above."""
    sign = 1.0 if rises else -1.0
    over = sign * (values - level)
    # Comparisons with nan are False: no crossing is found next to a gap.
    frames = np.flatnonzero((over[:-1] <= 0) & (over[1:] > 0))
    # Where the straight line between both frames crosses the level.
    return frames + over[frames] / (over[frames] - over[frames + 1])


def _nearest(found: Sequence[Repetition], times: Sequence[Floats]) -> Floats:
    """Return of each repetition the event nearest to the usual phase; nan without one near it."""
    turns = []
    for each in found:
        events = times[each.recording]
        inside = events[(events >= each.start) & (events < each.stop)]
        # Events as unit vectors at their phase, so that 1 % and 99 % are near each other.
        turns += (np.exp(2j * np.pi * (inside - each.start) / (each.stop - each.start))).tolist()
    if not turns:
        return np.full(len(found), np.nan)
    # Circular mean of the phases, as a share of the cycle.
    phase = float(np.angle(np.sum(turns)) / (2 * np.pi) % 1)
    chosen = np.full(len(found), np.nan)
    for i, each in enumerate(found):
        first, last = _window(each, phase)
        events = times[each.recording]
        inside = events[(events >= first) & (events < last)]
        if len(inside):
            # The middle of the window is the usual phase.
            chosen[i] = inside[np.abs(inside - (first + last) / 2).argmin()]
    return chosen


def _from_start_to_start(found: Sequence[Repetition], starts: Floats) -> list[Repetition]:
    """Return each repetition from its event to that of the one after it in its run."""
    anchored_ones = []
    for i, each in enumerate(found):
        goes_on = each.place in ("first", "inner")
        # Repetitions are in the order of time, so the next one of the run is the next in the list.
        stop = starts[i + 1] if goes_on else np.nan
        start = starts[i]
        missing = "no event" if np.isnan(start) else "no event ends it" if np.isnan(stop) else ""
        # Events in the wrong order; False where one of them is nan.
        if stop <= start:
            start, stop, missing = np.nan, np.nan, "no event"
        anchored_ones.append(
            replace(
                each,
                start=float(start),
                stop=float(stop),
                start_deviation=np.nan,
                stop_deviation=np.nan,
                pause=0.0,
                complete=True,
                missing=missing,
            )
        )
    return anchored_ones
