"""From a recording to its segments, in one call: features, a method, and back to its frames.

Methods count samples of their working rate, results frames of the recording;
they meet here.
"""

from __future__ import annotations

import time
import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kineme._checks import as_features
from kineme._version import __version__
from kineme.errors import KinemeWarning, ParameterError
from kineme.features.effectors import Names
from kineme.methods.base import Columns, Found, Leveled, Mirror, Preset
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.methods.stages import Progress, stopwatch
from kineme.recordings import Motion, Signals
from kineme.segmentation.bodies import view_of_motion
from kineme.segmentation.channels import view_of_signals
from kineme.segmentation.options import SegmentOptions
from kineme.segmentation.outside import as_channels, on_recording
from kineme.segmentation.spans import AT_GAP, gaps_between, in_frames
from kineme.segmentation.views import View
from kineme.segments.hierarchy import DEFAULT_DETAIL, Hierarchy
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import segment_table

FEW_CHANNELS = 20
"""So many channels are no sign of a transposed table, however short it is."""


def segment(
    recording: Motion | Signals,
    *,
    preset: str | Preset = DEFAULT,
    effectors: Names | None = None,
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
    recording : Motion or Signals
        At least one frame. What is too short or never repeats is one segment.
    preset : str or Preset
        ``kineme``, or another of `kineme.PRESETS`.
    effectors : joints, optional
        Of a motion, to take for head, hands and feet where names do not tell. Where these are
        not found either, the distances between points are looked at instead of a body.
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
    options = SegmentOptions(
        preset=preset,
        constants=constants,
        effectors=effectors,
        emg=emg,
        features=features,
        feature_fps=feature_fps,
        unit=unit,
        standardize=standardize,
    )
    return segmented(recording, options, progress=progress)[0]


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
    return segmented(recording, SegmentOptions.of(**options), progress=progress)


def segmented(
    recording: Motion | Signals, options: SegmentOptions, *, progress: Progress | None = None
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

    Returns
    -------
    segmentation : Segmentation
    found : Found
    """
    start = time.perf_counter()
    if not isinstance(recording, Motion | Signals):
        raise ParameterError(
            f"segment takes a Motion or Signals, not {type(recording).__name__}: "
            f"kineme.read(path) gives one; arrays go to Segmenter"
        )
    if progress is not None:
        progress("features")
    given = options.features
    segmented = recording if given is None else as_channels(recording, given, options.feature_fps)
    chosen = options.resolved(signals=isinstance(segmented, Signals)).at_most(segmented.fps)
    if isinstance(segmented, Signals):
        n_frames, n_channels = segmented.values.shape
        if n_channels > max(n_frames, FEW_CHANNELS):
            warnings.warn(
                f"there are more channels ({n_channels}) than samples ({n_frames}); if the table "
                "has a row for each channel, transpose it",
                KinemeWarning,
                stacklevel=2,
            )
        scaled = given is None if options.standardize is None else options.standardize
        view = view_of_signals(
            segmented, chosen, emg=options.emg, standardize=scaled, unit=options.unit
        )
    elif chosen.unit == "standard deviations":
        raise ParameterError(
            f"{chosen.name} is in standard deviations, for signals: a motion takes one in metres "
            f"or body sizes"
        )
    else:
        view = view_of_motion(segmented, chosen, options.effectors)
    if given is not None:
        view = on_recording(view, recording, segmented.fps)
    timings = {"features": time.perf_counter() - start}
    facts = {"joints": True} if view.joints else {}
    found = chosen.analyze(
        np.concatenate(view.features), mirror=view.mirror, progress=progress, **facts
    )
    return _result(recording, chosen, view, found, timings), found


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


def _result(
    recording: Motion | Signals, preset: Preset, view: View, found: Found, timings: dict[str, float]
) -> Segmentation:
    """Return what was found, in frames of the recording, with where it came from."""
    n_frames, fps = recording.n_frames, recording.fps

    def placed(columns: Columns) -> Columns:
        near = AT_GAP * preset.working_fps
        return in_frames(columns, view.spans, n_frames, fps / preset.working_fps, near=near)

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
    if gaps := gaps_between(view.spans, n_frames):
        provenance["gaps"] = [list(gap) for gap in gaps]
    if source.clock is not None:
        provenance["clock"] = source.clock.to_json()
    table, hierarchy = segment_table(columns, fps), None
    if isinstance(found, Leveled):
        with stopwatch(seconds, None)("levels"):
            tables = {DEFAULT_DETAIL: table}
            for detail, level in found.levels(samples).items():
                tables[detail] = segment_table(placed(level), fps)
            hierarchy = Hierarchy.of(tables)
    return Segmentation(table, int(n_frames), float(fps), provenance, seconds, hierarchy)
