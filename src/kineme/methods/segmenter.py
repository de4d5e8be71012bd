"""From a recording to its segments, in one call: features, a method, and back to its frames.

Methods count samples of their working rate, results frames of the recording;
they meet here.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.checks import as_features, check_flag, is_number
from kineme._version import __version__
from kineme.errors import KinemeWarning, ParameterError
from kineme.features.effectors import Names
from kineme.methods.base import Columns, Found, Leveled, Mirror, Preset
from kineme.methods.prepare import Prepared, RecordedSpan, prepare_motion, prepare_signals
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.methods.stages import Progress, time_stages
from kineme.recordings import Motion, Signals
from kineme.recordings.samples import as_signals
from kineme.segments.hierarchy import DEFAULT_DETAIL, Hierarchy, check_detail
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import segment_table

FEW_CHANNELS = 20
"""So many channels are no sign of a transposed table, however short it is."""


def segment(
    recording: Motion | Signals | Any,
    *,
    fps: float | None = None,
    times: ArrayLike | None = None,
    preset: str | Preset = DEFAULT,
    effectors: Names | None = None,
    detail: float = DEFAULT_DETAIL,
    emg: bool = False,
    features: ArrayLike | None = None,
    feature_fps: float | None = None,
    unit: float | None = None,
    standardize: bool | None = None,
    progress: Progress | None = None,
    **constants: Any,
) -> Segmentation:
    """Activities, transitions and primitives of a recording, as one table.

    Frames and seconds are those of the recording given, whatever the rate at
    which the preset looks at it. A gap of the recording is a transition; what
    lies around it is analysed together.

    Parameters
    ----------
    recording : Motion or Signals, or rows of numbers
        At least one frame. What is too short or never repeats is one segment. Arrays, data frames
        and objects of xarray are taken as `kineme.as_signals` takes them.
    fps : float, optional
        Of rows of numbers, how many are a second.
    times : (rows,) array_like, optional
        Of rows of numbers, when each was taken.
    preset : str or Preset
        ``kineme``, or another of `kineme.PRESETS`.
    effectors : joints, optional
        Of a motion, to take for head, hands and feet where names do not tell. Where these are
        not found either, the distances between points are looked at instead of a body.
    detail : float
        Above 1 for more, shorter segments, below for fewer, longer ones. The result keeps the
        other details: see `Segmentation.at_detail`.
    emg : bool
        Of signals: take the envelopes of muscle signals, see `kineme.features.emg_envelope`.
    features : (rows, dims) array, optional
        To look at in place of the recording's own, such as an embedding of each frame. They
        are stacked and taken to the working rate as channels are, and averaged over time only
        if `smoothing` says so.
    feature_fps : float, optional
        Rows of `features` per second; that of the recording by default.
    unit : float, optional
        The length in signals or features that counts as one unit of the preset's lengths; by
        default the preset finds it in the recording.
    standardize : bool, optional
        Whether each channel is divided by its standard deviation: those of signals are by
        default, features are not.
    progress : callable, optional
        Called with the name of each stage before it runs.
    **constants
        Constants of the preset to change, such as ``min_action=2.0``.

    Returns
    -------
    Segmentation

    Raises
    ------
    MotionError
        The joints named are not those of a body, or there is a single point.
    ParameterError
        No such preset or constant, a value it cannot take, no recording, or mirroring where
        nothing tells left from right.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> kineme.segment(motion).repetitions()
    {0: 9, 1: 4, ...}
    """
    known = isinstance(recording, Motion | Signals)
    if known and (fps is not None or times is not None):
        raise ParameterError("fps and times are of rows of numbers: a recording has its own")
    if not known and not isinstance(recording, str | PathLike):
        recording = as_signals(recording, fps=fps, times=times)
    options = SegmentOptions(
        preset=preset,
        constants=constants,
        effectors=effectors,
        detail=detail,
        emg=emg,
        features=features,
        feature_fps=feature_fps,
        unit=unit,
        standardize=standardize,
    )
    return segment_with_options(recording, options, progress=progress)[0]


def segment_and_found(
    recording: Motion | Signals, *, progress: Progress | None = None, **options: Any
) -> tuple[Segmentation, Found]:
    """Return the segments, and what the method found on the way to them (for pictures).

    Parameters
    ----------
    recording : Motion or Signals
        At least one frame.
    progress : callable, optional
        Called with the name of each stage before it runs.
    **options
        As `segment` takes them, constants of the preset among them.

    Returns
    -------
    segmentation : Segmentation
    found : Found

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> segments, found = kineme.segment_and_found(motion)
    >>> segments == kineme.segment(motion)
    True
    """
    return segment_with_options(recording, SegmentOptions.of(**options), progress=progress)


def segment_with_options(
    recording: Motion | Signals,
    options: SegmentOptions,
    *,
    progress: Progress | None = None,
    details: tuple[float, ...] | None = None,
) -> tuple[Segmentation, Found]:
    """Return the same for options that are together already.

    Parameters
    ----------
    recording : Motion or Signals
        At least one frame.
    options : SegmentOptions
        How it is segmented.
    progress : callable, optional
        Called with the name of each stage before it runs.
    details : tuple of float, optional
        Of the hierarchy, if others than the method offers.

    Returns
    -------
    segmentation : Segmentation
    found : Found
    """
    start = time.perf_counter()
    if not isinstance(recording, Motion | Signals):
        raise ParameterError(
            f"segment takes a Motion or Signals, not {type(recording).__name__}: "
            f"kineme.read(path) and kineme.as_signals(array) give one"
        )
    if progress is not None:
        progress("features")
    given = options.features
    seen = recording if given is None else wrap_features(recording, given, options.feature_fps)
    chosen = options.resolved(signals=isinstance(seen, Signals))
    rate = seen.fps
    if isinstance(seen, Signals):
        seen = replace(seen, fps=chosen.rate_of(seen.values, seen.fps))
    pace = seen.fps / rate  # seconds that count as one
    chosen = chosen.at_most(seen.fps)
    if isinstance(seen, Signals):
        n_frames, n_channels = seen.values.shape
        if n_channels > max(n_frames, FEW_CHANNELS):
            warnings.warn(
                f"there are more channels ({n_channels}) than samples ({n_frames}); if the table "
                "has a row for each channel, transpose it",
                KinemeWarning,
                stacklevel=2,
            )
        scaled = given is None if options.standardize is None else options.standardize
        view = prepare_signals(seen, chosen, emg=options.emg, standardize=scaled, unit=options.unit)
    elif chosen.unit == "standard deviations":
        raise ParameterError(
            f"{chosen.name} is in standard deviations, for signals: a motion takes one in metres "
            f"or body sizes"
        )
    else:
        view = prepare_motion(seen, chosen, options.effectors)
    if given is not None:
        view = rescale_spans(view, recording, rate)
    if pace != 1:
        view = replace(view, notes=[*view.notes, f"{pace:.4g} s count as a second"])
    timings = {"features": time.perf_counter() - start}
    facts = {"joints": True} if view.joints else {}
    found = chosen.analyze(
        np.concatenate(view.features), mirror=view.mirror, progress=progress, **facts
    )
    segmentation = _make_segmentation(recording, chosen, view, found, timings, pace, details)
    if options.detail != DEFAULT_DETAIL:
        segmentation = segmentation.at_detail(options.detail)
    return segmentation, found


def analyze(
    features: ArrayLike,
    preset: str | Preset = DEFAULT,
    *,
    mirror: Mirror | None = None,
    progress: Progress | None = None,
    **constants: Any,
) -> Found:
    """Return what each stage of a method finds in a sequence of features.

    Parameters
    ----------
    features : (samples, dims) array
        At the working rate, in the unit that the preset's lengths are in.
    preset : str or Preset
    mirror : callable, optional
        Exchanges left and right in such features, for presets that mirror;
        `kineme.mirror_features` for those of motions.
    progress : callable, optional
        Called with the name of each stage before it runs.
    **constants
        Constants of the preset to change.

    Returns
    -------
    Found
        Its class tells the method.

    Raises
    ------
    ParameterError
        No such preset, features of another shape, empty or not finite, or a preset that
        mirrors what has no left and right.

    Examples
    --------
    >>> import kineme, numpy as np
    >>> angle = np.linspace(0, 16 * np.pi, 480)
    >>> found = kineme.analyze(np.column_stack([np.sin(angle), np.cos(angle)]))
    >>> found.columns()["level"].tolist().count("primitive")
    8
    """
    chosen = resolve_preset(preset, **constants)
    return chosen.analyze(as_features(features), mirror=mirror, progress=progress)


def _make_segmentation(
    recording: Motion | Signals,
    preset: Preset,
    view: Prepared,
    found: Found,
    timings: dict[str, float],
    pace: float,
    details: tuple[float, ...] | None,
) -> Segmentation:
    """Return what was found, in frames of the recording, with where it came from."""
    n_frames, fps = recording.n_frames, recording.fps

    def placed(columns: Columns) -> Columns:
        near = AT_GAP * preset.working_fps
        frames = fps * pace / preset.working_fps
        return convert_to_frames(columns, view.spans, n_frames, frames, near=near)

    samples = found.columns()
    columns = placed(samples)
    seconds = {**timings, **found.timings}
    source = recording.provenance
    provenance: dict[str, Any] = {
        "kineme": __version__,
        "preset": preset.name,
        "method": preset.method,
        "parameters": {"unit": preset.unit, **preset.parameters()},
        "input": source.input,
        "notes": [*map(str, source.notes), *view.notes, *found.doubts(columns, fps)],
    }
    if gaps := find_gaps(view.spans, n_frames):
        provenance["gaps"] = [list(gap) for gap in gaps]
    if source.clock is not None:
        provenance["clock"] = source.clock.to_json()
    table, hierarchy = segment_table(columns, fps), None
    if isinstance(found, Leveled):
        with time_stages(seconds, None)("levels"):
            tables = {DEFAULT_DETAIL: table}
            for detail, level in found.levels(samples, details).items():
                tables[detail] = segment_table(placed(level), fps)
            hierarchy = Hierarchy.of(tables)
    if source.rows is not None:
        finest = table if hierarchy is None else hierarchy.tables[-1]
        borders = np.unique(np.append(finest.start_frame, [0, n_frames]))
        # the first row that is nearer to a border's frame, or a later one, than to the one before
        rows = np.searchsorted(source.rows, (borders - 0.5) / fps)
        provenance["rows"] = {"frames": borders.tolist(), "rows": rows.tolist()}
    return Segmentation(table, int(n_frames), float(fps), provenance, seconds, hierarchy)


@dataclass(frozen=True, kw_only=True, eq=False)
class SegmentOptions:
    """How a recording is segmented: the keywords of `kineme.segment`, which says what each means.

    Constants of the preset stand in ``constants`` by their names.

    Raises
    ------
    ParameterError
        A value that an option does not take. Constants are checked once the preset is known.

    Examples
    --------
    >>> SegmentOptions(constants={"min_action": 2.0}).resolved().min_action
    2.0
    """

    preset: str | Preset = DEFAULT
    constants: Mapping[str, Any] = field(default_factory=dict)
    effectors: Names | None = None
    detail: float = DEFAULT_DETAIL
    emg: bool = False
    features: ArrayLike | None = None
    feature_fps: float | None = None
    unit: float | None = None
    standardize: bool | None = None

    def __post_init__(self) -> None:
        given: Any = self.constants
        if not (isinstance(given, Mapping) and all(isinstance(name, str) for name in given)):
            raise ParameterError(f"constants must be values by their names, not {given!r:.60}")
        check_detail(self.detail)
        check_flag(self.emg, "emg")
        if self.standardize is not None:
            check_flag(self.standardize, "standardize")
        for name, value in (("unit", self.unit), ("feature_fps", self.feature_fps)):
            if value is not None and not (is_number(value) and value > 0):
                raise ParameterError(f"{name} must be a number above 0, not {value!r:.60}")

    @classmethod
    def of(cls, **keywords: Any) -> SegmentOptions:
        """Options as `kineme.segment` takes them: what is none of the others is a constant.

        Examples
        --------
        >>> SegmentOptions.of(emg=True, min_action=2.0).constants
        {'min_action': 2.0}
        """
        options = {each.name for each in fields(cls)} - {"constants"}
        constants = {name: value for name, value in keywords.items() if name not in options}
        given = {name: value for name, value in keywords.items() if name in options}
        return cls(constants=constants, **given)

    def resolved(self, *, signals: bool = False) -> Preset:
        """Return the preset with its constants, for a motion or for signals.

        Features of another making are averaged over time only where `smoothing` says so.

        Raises
        ------
        ParameterError
            There is no such preset or constant, or it cannot take the value.
        """
        constants = dict(self.constants)
        if self.features is not None:
            constants.setdefault("smoothing", 0.0)
        return resolve_preset(self.preset, signals=signals, **constants)


def wrap_features(recording: Motion | Signals, features: ArrayLike, fps: float | None) -> Signals:
    """Features from outside as channels, with the gaps of the recording at their rate."""
    rows = as_features(features)
    rate = recording.fps if fps is None else fps
    expected = recording.n_frames * rate / recording.fps
    if abs(len(rows) - expected) > 1 + rate / recording.fps:
        raise ParameterError(
            f"features have {len(rows)} rows, the recording lasts {recording.duration:.2f} s: "
            f"{expected:.0f} rows at {rate:g} a second; give feature_fps"
        )
    share = rate / recording.fps
    gaps = [
        (start, stop)
        for start, stop in (
            (int(a * share), min(int(np.ceil(b * share)), len(rows))) for a, b in recording.gaps
        )
        if start < stop
    ]
    return Signals(rows, rate, gaps=gaps)


def rescale_spans(view: Prepared, recording: Motion | Signals, fps: float) -> Prepared:
    """Return the view with its spans, so far in rows at `fps`, in frames of the recording."""
    per_row, n = recording.fps / fps, recording.n_frames
    spans = [
        replace(span, start=round(span.start * per_row), stop=min(round(span.stop * per_row), n))
        for span in view.spans
    ]
    if not recording.gaps or recording.gaps[-1][1] < n:
        spans[-1] = replace(spans[-1], stop=n)
    return replace(view, spans=spans)


Spans = Sequence[tuple[int, int]]

AT_GAP = 0.2
"""Seconds from a gap within which a border is at the gap: as much as is no gap yet."""


def convert_to_frames(
    columns: Columns,
    spans: Sequence[RecordedSpan],
    n_frames: int,
    ratio: float,
    *,
    near: float = 0.0,
) -> Columns:
    """Return the columns in frames, cut at the ends of the spans, gaps filled with transitions.

    Rows that vanish at the rate of the recording are left out.

    Parameters
    ----------
    columns : dict of str to array
        Of a segment table, ``start_frame`` and ``stop_frame`` in samples.
    spans : sequence of RecordedSpan
        In time order.
    n_frames : int
        Of the recording.
    ratio : float
        Frames in one sample.
    near : float
        Borders so many samples from a gap at most are moved to the gap.
    """
    rows: list[NDArray[np.intp]] = []
    starts: list[NDArray[np.int64]] = []
    stops: list[NDArray[np.int64]] = []
    first = 0
    for k, span in enumerate(spans):
        last = first + span.n_samples
        begin = np.maximum(columns["start_frame"], first)
        end = np.minimum(columns["stop_frame"], last)
        for borders in (begin, end):
            inner = (first < borders) & (borders < last)
            if k + 1 < len(spans):
                borders[inner & (borders >= last - near)] = last
            if k > 0:
                borders[inner & (borders <= first + near)] = first
        inside = np.flatnonzero(begin < end)
        begin, end = begin[inside], end[inside]
        at = span.start + np.rint((begin - first) * ratio).astype(np.int64)
        to = span.start + np.rint((end - first) * ratio).astype(np.int64)
        rows.append(inside)
        starts.append(at)
        stops.append(np.where(end == last, span.stop, to))
        first = last
    row, start, stop = map(np.concatenate, (rows, starts, stops))
    # At low frame rates two borders may fall on the same frame.
    full = start < stop
    cut = {name: column[row[full]] for name, column in columns.items()}
    cut |= {"start_frame": start[full], "stop_frame": stop[full]}
    if "border_confidence" in cut:  # what goes on after a gap does not start there
        at_gap = np.isin(cut["start_frame"], [span.start for span in spans])
        cut["border_confidence"] = np.where(at_gap, np.nan, cut["border_confidence"])
    return _insert_gaps(cut, find_gaps(spans, n_frames))


def find_gaps(spans: Sequence[RecordedSpan], n_frames: int) -> Spans:
    """Return what lies between the spans of the recording: frames [start, stop)."""
    starts = [0, *(span.stop for span in spans)]
    stops = [*(span.start for span in spans), n_frames]
    return [(a, b) for a, b in zip(starts, stops, strict=True) if a < b]


def _insert_gaps(columns: Columns, gaps: Spans) -> Columns:
    """Return columns with a transition in no cluster for each gap, on each level that they have."""
    if not gaps:
        return columns
    present = sorted({"activity", *columns["level"].tolist()})
    rows = [(level, start, stop) for level in present for start, stop in gaps]
    levels, starts, stops = zip(*rows, strict=True)
    n = len(rows)
    more: Columns = {
        "level": np.array(levels),
        "kind": np.full(n, "transition"),
        "start_frame": np.array(starts, np.int64),
        "stop_frame": np.array(stops, np.int64),
        "cluster": np.full(n, -1, np.int64),
    }
    unknown = np.full(n, np.nan)
    return {
        name: np.concatenate([column, more.get(name, unknown)]) for name, column in columns.items()
    }
