"""Find foot contacts and other events of a recording, and measure gait from them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import check_type, format_count, join_names, warn
from kineme.cycles.contacts import (
    measure_ground_velocity,
    stands_from_force,
    stands_from_positions,
    swings_from_gyroscope,
)
from kineme.cycles.joints import OTHER_SIDE, find_feet, landmarks
from kineme.cycles.table import Columns
from kineme.errors import ParameterError
from kineme.labels.c3d_events import SAME_S
from kineme.recordings import Motion, Signals
from kineme.recordings.arrays import mark_spans
from kineme.recordings.column_names import COORDINATE
from kineme.recordings.joint_names import GYROSCOPE, SIDES, has_word, mentions
from kineme.segments.segmentation import Segmentation

STRIKE, OFF = "foot strike", "foot off"
LONGEST = 1.8
"""Longest stride relative to the median; longer ones contain a stop or a missed contact."""
STANCE, ASYMMETRY = (40.0, 85.0), 50.0
"""Plausible stance phase in per cent of a stride, and largest asymmetry in per cent."""
RENAME = "Name the markers of heels and toes LHEE, LTOE, RHEE, RTOE and fill their gaps"
"""Remedy if heels or toes are not found."""
NAMED = 20
"""Number of channels that a message names; it counts the others."""
_UNIT = re.compile(r"[\s_]*[\[(][^\])]*[\])]$")


@dataclass(frozen=True, eq=False, repr=False)
class Events:
    """Named events in time order.

    Parameters
    ----------
    times : (n,) array
        Seconds.
    names : (n,) array of str
        Such as ``left foot strike`` and ``right foot off``.
    n_frames : int
        Frames of the recording.
    fps : float
        Frames per second of the recording.
    sources : dict of str to str
        Source of the contacts of each foot.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import foot_events
    >>> from kineme.datasets import Action, synthesize
    >>> walk = synthesize([Action("walk", 4)], fps=60).motion
    >>> len(foot_events(walk).at("left foot strike"))
    3
    """

    times: Floats
    names: NDArray[np.str_]
    n_frames: int
    fps: float
    sources: dict[str, str]

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        names = format_count(len({*self.names}), "name")
        return f"<Events: {format_count(len(self), 'event')} of {names}>"

    def at(self, name: str) -> Floats:
        """Return the times in seconds of all events with a name; empty if there are none.

        Parameters
        ----------
        name : str
            ``left foot contact`` and ``left_foot_strike`` are the same.
        """
        return np.asarray(self.times[self.names == normalize_event_name(name)])

    def columns(self) -> Columns:
        """Return a table: ``time_s``, ``frame`` (fractional) and ``event``."""
        return {"time_s": self.times, "frame": self.times * self.fps, "event": self.names}

    def segmentation(self, name: str | None = None) -> Segmentation:
        """Return the spans between events as activities, each named after its first event.

        Parameters
        ----------
        name : str, optional
            Name of the events that cut; all by default.

        Returns
        -------
        Segmentation
            The part before the first event is a transition, and with ``name`` also the part after
            the last.

        Raises
        ------
        ParameterError
            There are no such events.
        """
        # Names compare elementwise: a mask of the events.
        chosen = (
            np.ones(len(self), bool) if name is None else self.names == normalize_event_name(name)
        )
        frames = np.rint(self.times[chosen] * self.fps).astype(np.int64)
        pairs = zip(frames.tolist(), self.names[chosen].tolist(), strict=True)
        # The last of several events in one frame names the segment; cuts must be distinct.
        starts = {frame: text for frame, text in pairs if 0 <= frame < self.n_frames}
        if not starts:
            known = join_names(sorted(set(self.names.tolist()))) or "none"
            raise ParameterError(f"no event {name or 'in the recording'}; there are: {known}")
        if name is not None:  # what follows the last event is no cycle
            starts[max(starts)] = ""
        # Before the first event there is a transition without a label.
        starts = {0: "", **starts}
        cuts = [*sorted(starts), self.n_frames]
        labels = [starts[frame] for frame in cuts[:-1]]
        return Segmentation.from_columns(
            {
                "level": ["activity"] * len(labels),
                "kind": ["activity" if label else "transition" for label in labels],
                "start_frame": cuts[:-1],
                "stop_frame": cuts[1:],
                "label": labels,
            },
            n_frames=self.n_frames,
            fps=self.fps,
            provenance={"notes": [f"{foot} from {of}" for foot, of in self.sources.items()]},
        )


def normalize_event_name(name: str) -> str:
    """Return the normal form of an event's name: lower case, "strike" for contacts."""
    # Spellings of files differ in spaces, underscores and capitals.
    words = re.sub(r"[\s_]+", " ", name).strip().lower()
    return re.sub(r"\b(foot|heel) (contact|strike)\b|\binitial contact\b", STRIKE, words)


def foot_events(
    recording: Motion | Signals, *, left: str | None = None, right: str | None = None
) -> Events:
    """Return the times of ``left foot strike``, ``left foot off``, and the same for the right.

    Contacts marked in the file replace those found within 0.2 s.

    Parameters
    ----------
    recording : Motion or Signals
        A body with heel and toe or ankle, or signals of sensors at the feet.
    left, right : str, optional
        For signals: pattern of the channels of a foot, with ``*`` as a wildcard: the three axes of
        its gyroscope, or the vertical force under it. By default found by names such as
        ``lf_gyr_x``.

    Raises
    ------
    ParameterError
        No foot was found.

    Examples
    --------
    >>> from kineme.cycles import foot_events
    >>> from kineme.datasets import Action, synthesize
    >>> events = foot_events(synthesize([Action("walk", 4)], fps=60).motion)
    >>> events.sources
    {'left': 'LeftFoot and LeftToeBase', 'right': 'RightFoot and RightToeBase'}
    """
    check_type(recording, (Motion, Signals), "foot_events", "kineme.read(path) gives a recording")
    times: list[float] = []
    names: list[str] = []
    sources: dict[str, str] = {}
    n_marks = dict.fromkeys(SIDES, 0)
    is_body = isinstance(recording, Motion)
    for side, pattern in zip(SIDES, (left, right), strict=True):
        if is_body and pattern is not None:
            raise ParameterError(
                "left= and right= name channels of signals, but this is a body: leave them out"
            )
        foot = find_foot(recording, side, pattern)
        if not foot:
            continue
        sources[side] = (" and " if is_body else ", ").join(foot)
        for event, seconds in _find_contacts(recording, foot).items():
            name = f"{side} {event}"
            marks = find_marks(recording, name).tolist()
            apart = [at for at in seconds if all(abs(at - mark) >= SAME_S for mark in marks)]
            times += marks + apart
            names += [name] * len(marks + apart)
            n_marks[side] += len(marks)
    if not sources and is_body:
        raise ParameterError(
            f"no foot found: no heel or ankle has a usual name. {RENAME}, or use force plates "
            "(for a C3D --columns '*' --left Fz1 --right Fz2)"
        )
    if not sources:
        raise ParameterError(
            "no foot found: name each foot's gyroscope or force channels, as in left='lf_gyr_*' "
            "(--left 'lf_gyr_*')"
        )
    if isinstance(recording, Motion) and recording.rotations is None:
        _warn_missing_points(recording, sources)
    sources |= {
        side: f"{source}, {n_marks[side]} of them marked in the file"
        for side, source in sources.items()
        if n_marks[side]
    }
    # The stable sort keeps the left foot first at equal times.
    order = np.argsort(times, kind="stable")
    return Events(
        np.array(times, np.float64)[order],
        np.array(names, np.str_)[order],
        recording.n_frames,
        recording.fps,
        sources,
    )


def find_marks(recording: Motion | Signals, name: str) -> Floats:
    """Return the times in seconds of the events of the file with a name in its normal form.

    Events outside the recording, as in a file that was cropped, are left out.
    """
    end = recording.n_frames / recording.fps
    events = recording.provenance.events
    marks = {at for at, text in events if normalize_event_name(text) == name and 0 <= at <= end}
    return np.array(sorted(marks), np.float64)


def _warn_missing_points(motion: Motion, sources: Mapping[str, str]) -> None:
    """Warn if a foot has no heel or no toe; ``sources`` are the joints used, by side."""
    joints, parents = landmarks(motion), motion.skeleton.parents

    def has_heel(side: str) -> bool:
        toe, ankle = joints.get(f"{side}_toe"), joints.get(f"{side}_ankle")
        # In a skeleton the toe is a child of the ankle, which serves as the heel.
        is_bone = toe is not None and ankle is not None and parents[toe] == ankle
        return is_bone or f"{side}_heel" in joints

    missing = [f"{side} heel" for side in sources if not has_heel(side)]
    missing += [f"{side} toe" for side in sources if f"{side}_toe" not in joints]
    if missing:
        warn(
            f"{join_names(missing)} not found: contacts are from {', '.join(sources.values())}, "
            f"and stances may be 0.1 s too short. {RENAME}."
        )


def find_foot(recording: Motion | Signals, side: str, pattern: str | None = None) -> list[str]:
    """Return the joints or channels used to find the contacts of a foot; empty if none.

    Channels are those matching the pattern, else the three axes of a gyroscope at the foot, else
    at the shank.
    """
    if isinstance(recording, Motion):
        return [recording.skeleton.names[joint] for joint in find_feet(recording).get(side, ())]
    names = recording.names
    if pattern is not None:
        chosen = [name for name in names if fnmatchcase(name, pattern)]
        if len(chosen) not in (1, 3):
            raise ParameterError(
                f"{side}={pattern!r} names {format_count(len(chosen), 'channel')} of "
                f"{join_names(names, NAMED)}: name three axes of a gyroscope or one force"
            )
        return chosen
    for place in ("*_foot_sensor", "*_shank_sensor"):
        # An axis of a gyroscope, as ``lf_gyr_x``.
        chosen = [
            name
            for name in names
            if COORDINATE.fullmatch(_UNIT.sub("", name))
            and has_word(name, GYROSCOPE)
            and mentions(name, place, side=side)
        ]
        if len(chosen) == 3:
            return chosen
    return []


def mark_stance(recording: Motion | Signals, foot: Sequence[str]) -> Floats:
    """Return 100 for each frame in which a foot stands, 0 in which it swings.

    ``foot`` holds its joints or channels, from `find_foot`.
    """
    spans, are_stands = _find_contact_spans(recording, foot)
    frames = np.rint(spans * recording.fps).astype(np.intp).tolist()
    return np.where(mark_spans(frames, recording.n_frames) == are_stands, 100.0, 0.0)


def _find_contact_spans(recording: Motion | Signals, foot: Sequence[str]) -> tuple[Floats, bool]:
    """Return spans (spans, 2) in seconds, and whether these are stands (True) or swings."""
    if isinstance(recording, Motion):
        joints = [recording.skeleton.joint(name) for name in foot]
        return stands_from_positions(
            [*recording.positions.swapaxes(0, 1)[joints]], recording.fps
        ), True
    values = recording.values[:, [recording.names.index(name) for name in foot]]
    # One channel is a force, three are the axes of a gyroscope.
    if len(foot) == 1:
        return stands_from_force(values, recording.fps), True
    swings = [
        # Each span between gaps on its own; its times are counted from its start.
        swings_from_gyroscope(values[start:stop], recording.fps) + start / recording.fps
        for start, stop in recording.spans()
    ]
    # The empty array keeps the shape (0, 2) if there is no span.
    return np.concatenate([np.empty((0, 2)), *swings]), False


def _find_contacts(recording: Motion | Signals, foot: Sequence[str]) -> dict[str, list[float]]:
    """Return the times in seconds of strikes and offs of a foot."""
    spans, are_stands = _find_contact_spans(recording, foot)
    starts, stops = spans.T.tolist()
    if not are_stands:
        return {OFF: starts, STRIKE: stops}
    # At an end of the recording or a gap the contact itself was not recorded.
    return {
        event: [at for at in times if _is_recorded(at * recording.fps, recording)]
        for event, times in ((STRIKE, starts), (OFF, stops))
    }


def _is_recorded(frame: float, recording: Motion | Signals) -> bool:
    gaps = recording.gaps
    return 0 < frame < recording.n_frames and not any(a <= frame <= b for a, b in gaps)


def gait(events: Events, recording: Motion | Signals | None = None) -> Columns:
    """Return gait parameters: times of strides, stances, swings and steps, and asymmetry.

    Parameters
    ----------
    events : Events
        Contacts of one foot or both.
    recording : Motion or Signals, optional
        If it is a body, length and speed of strides are measured, too.

    Returns
    -------
    dict of str to array
        Columns: ``measure``, and for each foot ``left_n``, ``left_mean``, ``left_sd``;
        ``asymmetry_percent``: left minus right relative to the mean of both. Strides much longer
        than the median are left out. Values are nan if there are too few strides.

    Examples
    --------
    >>> from kineme.cycles import foot_events, gait
    >>> from kineme.datasets import Action, synthesize
    >>> table = gait(foot_events(synthesize([Action("walk", 6)], fps=60).motion))
    >>> table["measure"].tolist()
    ['stride_s', 'stance_s', 'swing_s', 'stance_percent', 'step_s', 'cadence_per_min']
    """
    table = strides(events, recording)
    # The first three columns are the foot and the times.
    measures = [*table][3:] if len(table["foot"]) else []
    columns: dict[str, list[Any]] = {"measure": measures}
    for side in SIDES:
        of_side = [table[name][table["foot"] == side] for name in measures]
        values = [each[np.isfinite(each)] for each in of_side]
        columns[f"{side}_n"] = [len(each) for each in values]
        columns[f"{side}_mean"] = [each.mean() if len(each) else np.nan for each in values]
        # The sample deviation (n - 1) needs two values.
        columns[f"{side}_sd"] = [each.std(ddof=1) if len(each) > 1 else np.nan for each in values]
    left, right = (np.array(columns[f"{side}_mean"], np.float64) for side in SIDES)
    means = {name: np.array(column) for name, column in columns.items()}
    # Per cent of the mean of both feet.
    means["asymmetry_percent"] = 100 * (left - right) / ((left + right) / 2)
    _warn_implausible(means)
    return means


def _warn_implausible(gait: Columns) -> None:
    """Warn of values that are implausible for walking, which suggest missed contacts."""
    remarks, unequal = [], []
    for i, measure in enumerate(gait["measure"].tolist()):
        if measure == "stance_percent":
            remarks += [
                f"the {side} foot is on the ground for {mean:.0f} % of a stride"
                for side in SIDES
                if (mean := gait[f"{side}_mean"][i]) < STANCE[0] or mean > STANCE[1]
            ]
        if (asymmetry := abs(gait["asymmetry_percent"][i])) > ASYMMETRY:
            unequal.append(f"{measure} differs by {asymmetry:.0f} % between the feet")
    remarks += unequal[:1]
    if remarks:
        warn(
            f"implausible for walking: {', '.join(remarks)}. Check the recording's unit and which "
            "points or channels the feet were found from."
        )


def strides(events: Events, recording: Motion | Signals | None = None) -> Columns:
    """Return the parameters of each stride of each foot; `gait` returns their means.

    Parameters
    ----------
    events : Events
    recording : Motion or Signals, optional
        As for `gait`.

    Returns
    -------
    dict of str to array
        Columns: ``foot``, ``start_s``, ``stop_s``, and the measures, nan if unknown.

    Examples
    --------
    >>> from kineme.cycles import foot_events, strides
    >>> from kineme.datasets import Action, synthesize
    >>> table = strides(foot_events(synthesize([Action("walk", 4)], fps=60).motion))
    >>> [*table]
    ['foot', 'start_s', 'stop_s', 'stride_s', 'stance_s', 'swing_s', 'stance_percent', ...]
    """
    check_type(events, Events, "strides", "foot_events(recording) gives them")
    left, right = (_measure_strides(events, side, recording) for side in SIDES)
    # The side of a foot without a path, as in a body with one foot, lacks the measures of paths.
    return {
        name: np.concatenate(
            [side.get(name, np.full(len(side["foot"]), np.nan)) for side in (left, right)]
        )
        for name in {**left, **right}
    }


def _measure_strides(events: Events, side: str, recording: Motion | Signals | None) -> Columns:
    """Return the measures of each stride of one foot, from strike to strike.

    A measure is nan if an event that it needs was missed.
    """
    strikes, offs = events.at(f"{side} {STRIKE}"), events.at(f"{side} {OFF}")
    others = events.at(f"{OTHER_SIDE[side]} {STRIKE}")
    pairs = np.column_stack([strikes[:-1], strikes[1:]])
    lengths = np.diff(pairs, axis=1)[:, 0]
    # The median of an empty array would warn.
    if len(pairs):
        pairs = pairs[lengths <= LONGEST * np.median(lengths)]
    rows = []
    for start, stop in pairs.tolist():
        # Without exactly one foot off between two strikes an event was missed: the result is nan.
        between = offs[(offs > start) & (offs < stop)]
        step = others[(others > start) & (others < stop)]
        off = between[0] if len(between) == 1 else np.nan
        rows.append((start, off, stop, stop - step[0] if len(step) == 1 else np.nan))
    # The reshape keeps four columns if there are no strides.
    start, off, stop, step = np.array(rows, np.float64).reshape(-1, 4).T
    stride = stop - start
    found = {
        "foot": np.full(len(rows), side),
        "start_s": start,
        "stop_s": stop,
        "stride_s": stride,
        "stance_s": off - start,
        "swing_s": stop - off,
        "stance_percent": 100 * (off - start) / stride,
        "step_s": step,
        # Two steps per stride, 60 seconds per minute.
        "cadence_per_min": 120 / stride,
    }
    if isinstance(recording, Motion) and (foot := find_feet(recording).get(side)):
        frames = np.clip(np.rint(np.stack([start, stop]) * recording.fps), 0,
                         recording.n_frames - 1).astype(np.intp)  # fmt: skip
        # (2, strides, 3): the foot at both strikes.
        ends = recording.positions[frames, foot[0]]
        paths = [recording.positions[:, joint] for joint in foot]
        ground = measure_ground_velocity(paths, recording.fps)
        # On a treadmill the belt carried the foot back meanwhile.
        walked = (ends[1] - ends[0]) - stride[:, None] * ground
        # Axes 0 and 2 are horizontal.
        found["stride_m"] = np.linalg.norm(walked[:, [0, 2]], axis=1)
        found["speed_m_per_s"] = found["stride_m"] / stride
    return found
