"""Segment a recording in one call: compute features, run a method, convert back to frames.

Methods count samples at their working rate; results count frames of the recording.
This module converts between the two.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import partial
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.checks import as_features, check_flag, is_number, warn
from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.features.effectors import Names
from kineme.methods.base import Columns, Found, Leveled, Mirror, Preset, Progress, time_stages
from kineme.methods.prepare import Prepared, RecordedSpan, prepare_motion, prepare_signals
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.recordings import Motion, Signals
from kineme.recordings.samples import as_signals
from kineme.segments.hierarchy import DEFAULT_DETAIL, Hierarchy, check_detail
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import make_segment_table

Spans = Sequence[tuple[int, int]]
FEW_CHANNELS = 20
"""Number of channels up to which a short table is not suspected to be transposed."""
GAP_TOLERANCE = 0.2
"""Borders this close to a gap are moved to it, s. Shorter gaps do not count as gaps."""


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
    """Segment a recording into activities, transitions and primitives.

    Frames and seconds are those of the recording, at any working rate of the preset.
    A gap of the recording becomes a transition; the spans around it are analysed together.

    Parameters
    ----------
    recording : Motion or Signals, or rows of numbers
        At least one frame. A recording that is too short or never repeats becomes one segment.
        Arrays, data frames and xarray objects are converted with `kineme.as_signals`.
    fps : float, optional
        Rows per second, if the recording is rows of numbers.
    times : (rows,) array_like, optional
        Time of each row, if the recording is rows of numbers.
    preset : str or Preset
        ``kineme``, or another of `kineme.PRESETS`.
    effectors : joints, optional
        Joints of a motion to use as head, hands and feet if their names are not recognised. If
        no body is found, features are distances between points.
    detail : float
        Above 1 for more, shorter segments, below 1 for fewer, longer ones. The result keeps the
        other details: see `Segmentation.at_detail`.
    emg : bool
        Compute the envelopes of muscle signals first, see `kineme.features.emg_envelope`.
    features : (rows, dims) array, optional
        Features to use in place of the recording's own, for example an embedding of each frame.
        They are resampled and stacked as channels are, and averaged over time only if
        `smoothing` is given.
    feature_fps : float, optional
        Rows of `features` per second; by default the rate of the recording.
    unit : float, optional
        Length in signals or features that counts as one unit of the preset's lengths; by
        default one standard deviation, or 1 if channels are not standardized.
    standardize : bool, optional
        Whether each channel is divided by its standard deviation; by default signals are and
        features are not.
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
        The named joints are not those of a body, or there is only one point.
    ParameterError
        The preset or constant does not exist, a value is not allowed, the first argument is not
        a recording, or the preset mirrors but left and right are unknown.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> kineme.segment(motion).repetitions()
    {0: 9, 1: 4, ...}
    """
    is_recording = isinstance(recording, Motion | Signals)
    if is_recording and (fps is not None or times is not None):
        raise ParameterError("fps and times are for arrays: a recording has its own")
    if not is_recording and not isinstance(recording, str | PathLike):
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
    """Return the segments, and the results of all stages of the method (for plots).

    Parameters
    ----------
    recording : Motion or Signals
        At least one frame.
    progress : callable, optional
        Called with the name of each stage before it runs.
    **options
        As in `segment`, including constants of the preset.

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
    """Return the same as `segment_and_found`, for options in one object.

    ``details`` are those of the hierarchy; by default those that the method offers.
    """
    start = time.perf_counter()
    if not isinstance(recording, Motion | Signals):
        raise ParameterError(
            f"segment takes a Motion or Signals, not {type(recording).__name__}: "
            f"kineme.read(path) and kineme.as_signals(array) give one"
        )
    if progress is not None:
        progress("features")
    features = options.features
    # The recording itself, or the given features as channels.
    source = (
        recording if features is None else wrap_features(recording, features, options.feature_fps)
    )
    preset = options.resolved(signals=isinstance(source, Signals))
    rate = source.fps
    if isinstance(source, Signals):
        source = replace(source, fps=preset.rate_of(source.values, source.fps))
    pace = source.fps / rate  # seconds of the recording that the preset treats as one second
    preset = preset.at_most(source.fps)
    if isinstance(source, Signals):
        n_frames, n_channels = source.values.shape
        if n_channels > max(n_frames, FEW_CHANNELS):
            warn(
                f"there are more channels ({n_channels}) than samples ({n_frames}); if the table "
                "has a row for each channel, transpose it"
            )
        standardize = features is None if options.standardize is None else options.standardize
        prepared = prepare_signals(
            source, preset, emg=options.emg, standardize=standardize, unit=options.unit or 1.0
        )
    elif preset.unit == "standard deviations":
        raise ParameterError(
            f"{preset.name} is for signals: for a motion choose a preset in metres or body sizes"
        )
    else:
        prepared = prepare_motion(source, preset, options.effectors)
    if features is not None:
        prepared = rescale_spans(prepared, recording, rate)
    if pace != 1:
        prepared = replace(prepared, notes=[*prepared.notes, f"{pace:.4g} s count as a second"])
    timings = {"features": time.perf_counter() - start}
    # Only presets that accept joints have this keyword.
    keywords = {"joints": True} if prepared.joints else {}
    found = preset.analyze(
        np.concatenate(prepared.features), mirror=prepared.mirror, progress=progress, **keywords
    )
    segmentation = _make_segmentation(recording, preset, prepared, found, timings, pace, details)
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
    """Run a method on a sequence of features and return the results of its stages.

    Parameters
    ----------
    features : (samples, dims) array
        At the working rate, in the unit of the preset's lengths.
    preset : str or Preset
    mirror : callable, optional
        Swaps left and right in these features, for presets that mirror;
        `kineme.mirror_features` for features of motions.
    progress : callable, optional
        Called with the name of each stage before it runs.
    **constants
        Constants of the preset to change.

    Returns
    -------
    Found
        Its class depends on the method.

    Raises
    ------
    ParameterError
        The preset does not exist; the features have another shape, are empty or not finite; or
        the preset mirrors but no `mirror` is given.

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
    prepared: Prepared,
    found: Found,
    timings: dict[str, float],
    pace: float,
    details: tuple[float, ...] | None,
) -> Segmentation:
    """Return the result of a method in frames of the recording, with its provenance."""
    n_frames, fps = recording.n_frames, recording.fps
    to_frames = partial(
        convert_to_frames,
        spans=prepared.spans,
        n_frames=n_frames,
        ratio=fps * pace / preset.working_fps,
        near=GAP_TOLERANCE * preset.working_fps,
    )
    sample_columns = found.columns()
    columns = to_frames(sample_columns)
    seconds = {**timings, **found.timings}
    source = recording.provenance
    provenance: dict[str, Any] = {
        "kineme": __version__,
        "preset": preset.name,
        "method": preset.method,
        "parameters": {"unit": preset.unit, **preset.parameters()},
        "input": source.input,
        "notes": [*map(str, source.notes), *prepared.notes, *found.doubts(columns, fps)],
    }
    if gaps := find_gaps(prepared.spans, n_frames):
        provenance["gaps"] = [list(gap) for gap in gaps]
    if source.clock is not None:
        provenance["clock"] = source.clock.to_json()
    table, hierarchy = make_segment_table(columns, fps), None
    if isinstance(found, Leveled):
        with time_stages(seconds, None)("levels"):
            tables = {DEFAULT_DETAIL: table}
            for detail, level in found.levels(sample_columns, details).items():
                tables[detail] = make_segment_table(to_frames(level), fps)
            hierarchy = Hierarchy.of(tables)
    if source.rows is not None:
        finest = table if hierarchy is None else hierarchy.tables[-1]
        borders = np.unique(np.append(finest.start_frame, [0, n_frames]))
        # First row whose time rounds to the border's frame or a later one.
        rows = np.searchsorted(source.rows, (borders - 0.5) / fps)
        provenance["rows"] = {"frames": borders.tolist(), "rows": rows.tolist()}
    return Segmentation(
        table,
        int(n_frames),
        fps=float(fps),
        provenance=provenance,
        timings=seconds,
        hierarchy=hierarchy,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class SegmentOptions:
    """Options of segmentation: the keywords of `kineme.segment`, where each is documented.

    ``constants`` holds constants of the preset by name.

    Raises
    ------
    ParameterError
        An option has an invalid value. Constants are checked when the preset is known.

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
        constants: Any = self.constants
        is_mapping = isinstance(constants, Mapping)
        if not (is_mapping and all(isinstance(name, str) for name in constants)):
            raise ParameterError(
                f"constants must be a mapping of names to values, not {constants!r:.60}"
            )
        check_detail(self.detail)
        check_flag(self.emg, "emg")
        if self.standardize is not None:
            check_flag(self.standardize, "standardize")
        for name, value in (("unit", self.unit), ("feature_fps", self.feature_fps)):
            if value is not None and not (is_number(value) and value > 0):
                raise ParameterError(f"{name} must be a number above 0, not {value!r:.60}")

    @classmethod
    def of(cls, **keywords: Any) -> SegmentOptions:
        """Return the options for keywords of `kineme.segment`: unknown ones are constants.

        Examples
        --------
        >>> SegmentOptions.of(emg=True, min_action=2.0).constants
        {'min_action': 2.0}
        """
        options = {each.name for each in fields(cls)} - {"constants"}
        constants = {name: value for name, value in keywords.items() if name not in options}
        others = {name: value for name, value in keywords.items() if name in options}
        return cls(constants=constants, **others)

    def resolved(self, *, signals: bool = False) -> Preset:
        """Return the preset with its constants, for a motion or for signals.

        Given features are averaged over time only if `smoothing` is given.

        Raises
        ------
        ParameterError
            The preset or constant does not exist, or its value is not allowed.
        """
        constants = dict(self.constants)
        if self.features is not None:
            constants.setdefault("smoothing", 0.0)
        return resolve_preset(self.preset, signals=signals, **constants)


def wrap_features(recording: Motion | Signals, features: ArrayLike, fps: float | None) -> Signals:
    """Wrap given features as channels, with the gaps of the recording at their rate."""
    rows = as_features(features)
    rate = recording.fps if fps is None else fps
    expected = recording.n_frames * rate / recording.fps
    if abs(len(rows) - expected) > 1 + rate / recording.fps:
        raise ParameterError(
            f"features have {len(rows)} rows, but the recording lasts "
            f"{recording.duration:.2f} s: {expected:.0f} rows at {rate:g} a second; give "
            "feature_fps"
        )
    per_frame = rate / recording.fps  # rows per frame
    # Widen gaps to whole rows, so that no row overlaps a gap.
    gaps = [
        (start, stop)
        for start, stop in (
            (int(a * per_frame), min(int(np.ceil(b * per_frame)), len(rows)))
            for a, b in recording.gaps
        )
        if start < stop
    ]
    return Signals(rows, rate, gaps=gaps)


def rescale_spans(prepared: Prepared, recording: Motion | Signals, fps: float) -> Prepared:
    """Convert the spans from rows at `fps` to frames of the recording."""
    per_row, n = recording.fps / fps, recording.n_frames
    spans = [
        replace(span, start=round(span.start * per_row), stop=min(round(span.stop * per_row), n))
        for span in prepared.spans
    ]
    # Rounding must not leave frames after the last span, unless they are a gap.
    if not recording.gaps or recording.gaps[-1][1] < n:
        spans[-1] = replace(spans[-1], stop=n)
    return replace(prepared, spans=spans)


def convert_to_frames(
    columns: Columns,
    spans: Sequence[RecordedSpan],
    n_frames: int,
    ratio: float,
    *,
    near: float = 0.0,
) -> Columns:
    """Convert columns from samples to frames; cut at gaps, and fill these with transitions.

    Spans are in time order, and ``ratio`` is the number of frames per sample. Borders at most
    ``near`` samples from a gap are moved to the gap. Borders at a gap have no confidence (nan).
    Rows shorter than one frame are dropped.
    """
    rows: list[NDArray[np.intp]] = []
    starts: list[NDArray[np.int64]] = []
    stops: list[NDArray[np.int64]] = []
    first = 0
    for k, span in enumerate(spans):
        # Samples [first, last) of the concatenated features belong to this span.
        last = first + span.n_samples
        begin = np.maximum(columns["start_frame"], first)
        end = np.minimum(columns["stop_frame"], last)
        # Move borders near a gap to it; the outer ends of the recording have no gap.
        for borders in (begin, end):
            is_inside = (first < borders) & (borders < last)
            if k + 1 < len(spans):
                borders[is_inside & (borders >= last - near)] = last
            if k > 0:
                borders[is_inside & (borders <= first + near)] = first
        inside = np.flatnonzero(begin < end)
        begin, end = begin[inside], end[inside]
        start_frames = span.start + np.rint((begin - first) * ratio).astype(np.int64)
        stop_frames = span.start + np.rint((end - first) * ratio).astype(np.int64)
        rows.append(inside)
        starts.append(start_frames)
        # The last segment ends with the span, whatever the rounding.
        stops.append(np.where(end == last, span.stop, stop_frames))
        first = last
    row, start, stop = map(np.concatenate, (rows, starts, stops))
    # At low frame rates two borders may fall on the same frame.
    is_long = start < stop
    cut = {name: column[row[is_long]] for name, column in columns.items()}
    cut |= {"start_frame": start[is_long], "stop_frame": stop[is_long]}
    if "border_confidence" in cut:  # the confidence is not that of a border at a gap
        at_gap = np.isin(cut["start_frame"], [span.start for span in spans])
        cut["border_confidence"] = np.where(at_gap, np.nan, cut["border_confidence"])
    gaps = find_gaps(spans, n_frames)
    return _insert_gaps(cut, gaps) if gaps else cut


def find_gaps(spans: Sequence[RecordedSpan], n_frames: int) -> Spans:
    """Return the frames [start, stop) of the recording between the spans."""
    starts = [0, *(span.stop for span in spans)]
    stops = [*(span.start for span in spans), n_frames]
    return [(a, b) for a, b in zip(starts, stops, strict=True) if a < b]


def _insert_gaps(columns: Columns, gaps: Spans) -> Columns:
    """Append a transition for each gap to each level of the columns."""
    present = sorted({"activity", *columns["level"].tolist()})
    rows = [(level, start, stop) for level in present for start, stop in gaps]
    levels, starts, stops = zip(*rows, strict=True)
    n = len(rows)
    gap_columns: Columns = {
        "level": np.array(levels),
        "kind": np.full(n, "transition"),
        "start_frame": np.array(starts, np.int64),
        "stop_frame": np.array(stops, np.int64),
        "cluster": np.full(n, -1, np.int64),
    }
    unknown = np.full(n, np.nan)
    return {
        name: np.concatenate([column, gap_columns.get(name, unknown)])
        for name, column in columns.items()
    }
