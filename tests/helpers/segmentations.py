"""Segmentations of given rows, and of all shapes for hypothesis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from hypothesis import strategies as st

from kineme.segments.segmentation import Segmentation

LABELS = st.text(st.characters(exclude_categories=("Cc", "Cs", "Zl", "Zp")), max_size=12)
RATES = st.one_of(
    st.sampled_from([25.0, 30.0, 29.97, 60.0, 119.88, 120.0, 30000 / 1001]),
    st.floats(1e-3, 1e5, allow_nan=False),
)
UNKNOWN = st.text(max_size=5).map(lambda name: f"{name}?")
"""Names that a provenance of ours has no meaning for."""
JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=8,
)


def from_rows(
    rows: Sequence[tuple[str, str, int, int, int, str]], *, fps: float = 30.0, **options: Any
) -> Segmentation:
    """Make a segmentation of rows: level, kind, first frame, stop, cluster and label."""
    names = ("level", "kind", "start_frame", "stop_frame", "cluster", "label")
    columns: dict[str, Any] = dict(zip(names, map(list, zip(*rows, strict=True)), strict=True))
    return Segmentation.from_columns(
        columns, n_frames=max(row[3] for row in rows), fps=fps, **options
    )


def one_activity(n_frames: int, fps: float = 30.0, cluster: int = -1) -> Segmentation:
    """Make a single activity."""
    return make_activities(n_frames, fps=fps, cluster=[cluster])


def make_activities(*stops: int, fps: float = 30.0, **columns: Any) -> Segmentation:
    """Make activities that follow each other and stop at these frames; other columns by name."""
    n, provenance = len(stops), columns.pop("provenance", None)
    made = {"level": ["activity"] * n, "kind": ["activity"] * n, "start_frame": [0, *stops[:-1]]}
    columns = {**made, "stop_frame": list(stops), **columns}
    return Segmentation.from_columns(columns, n_frames=stops[-1], fps=fps, provenance=provenance)


@st.composite
def segmentations(draw: st.DrawFn, like: Segmentation | None = None) -> Segmentation:
    """Random cuts of both levels, clusters, labels, confidences, provenance.

    The length and the rate are random, too, or those of another segmentation.
    """
    n_frames = draw(st.integers(1, 60)) if like is None else like.n_frames
    cuts = st.sets(st.integers(1, max(1, n_frames - 1)), max_size=6)
    inner = sorted(cut for cut in draw(cuts) if cut < n_frames)
    finer = sorted({*inner, *(cut for cut in draw(cuts) if cut < n_frames)})
    levels = [("activity", inner)]
    if draw(st.booleans()):
        levels.append(("primitive", finer))
    columns: dict[str, list[Any]] = {"level": [], "start_frame": [], "stop_frame": []}
    for level, borders in levels:
        columns["level"] += [level] * (len(borders) + 1)
        columns["start_frame"] += [0, *borders]
        columns["stop_frame"] += [*borders, n_frames]
    n = len(columns["level"])

    def column(values: st.SearchStrategy[Any]) -> list[Any]:
        return draw(st.lists(values, min_size=n, max_size=n))

    shares = st.floats(allow_infinity=False, allow_nan=False) | st.just(np.nan)
    return Segmentation.from_columns(
        {
            **columns,
            "kind": column(st.sampled_from(["activity", "transition"])),
            "cluster": column(st.integers(-1, 5)),
            "label": column(LABELS),
            "confidence": column(shares),
            "border_confidence": column(shares),
        },
        n_frames=n_frames,
        fps=draw(RATES) if like is None else like.fps,
        provenance=draw(st.dictionaries(UNKNOWN, JSON, max_size=3)),
        timings=draw(st.dictionaries(st.text(max_size=5), st.floats(0, 1e3), max_size=3)),
    )
