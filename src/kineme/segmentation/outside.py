"""Features from outside, such as an embedding of each frame, in place of a recording's own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from kineme._checks import as_features
from kineme.errors import ParameterError
from kineme.recordings import Motion, Signals
from kineme.segmentation.views import View


def as_channels(recording: Motion | Signals, features: ArrayLike, fps: float | None) -> Signals:
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


def on_recording(view: View, recording: Motion | Signals, fps: float) -> View:
    """Return the view with its spans, so far in rows at `fps`, in frames of the recording."""
    per_row, n = recording.fps / fps, recording.n_frames
    spans = [
        replace(span, start=round(span.start * per_row), stop=min(round(span.stop * per_row), n))
        for span in view.spans
    ]
    if not recording.gaps or recording.gaps[-1][1] < n:
        spans[-1] = replace(spans[-1], stop=n)
    return replace(view, spans=spans)
