"""Do poses come back within ten seconds? (Vögele, Krüger, Klein 2014, section 1)

The method needs poses that reoccur. The paper counts "all poses of sequences
of length more than 8 seconds which reoccur - after some intermission - within
a time slot not wider than 10 seconds" and reaches 81.89 % on CMU and HDM05. It
does not say what an intermission is. Here a pose reoccurs if, within 10 s on
either side, a frame lies within the search radius, with at least 1/3 s between
them of frames that do not.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme.errors import KinemeError
from kineme.methods.prepare import compute_motion_features
from kineme.methods.region_growing.neighbors import NeighborGraph, neighbor_graph
from kineme.methods.region_growing.preset import VOEGELE2014
from kineme.recordings import Motion
from kineme.segments.display import PALETTE
from kineme_reproduction.figures.style import INK, heading, new_figure, save, tidy

MIN_LENGTH_S = 8.0
SLOT_S = 10.0
INTERMISSION_S = 1 / 3
PUBLISHED = 0.8189


@dataclass(frozen=True)
class Recording:
    """A recording of more than 8 s and the share of its poses that reoccur."""

    path: Path
    frames: int
    share: float


def survey(paths: Iterable[Path]) -> list[Recording]:
    """Return the recordings longer than 8 s; skip unreadable files."""
    found = []
    for path in paths:
        motion = _read(path)
        if motion is not None and motion.duration > MIN_LENGTH_S:
            poses = reoccurring(motion)
            found.append(Recording(path, poses.size, float(poses.mean())))
    return found


def share_of_poses(recordings: Iterable[Recording]) -> float:
    """Return the share of all poses of these recordings that reoccur."""
    rows = list(recordings)
    return float(np.average([r.share for r in rows], weights=[r.frames for r in rows]))


def reoccurring(motion: Motion) -> NDArray[np.bool_]:
    """Return whether each pose reoccurs within 10 s, (frames,) at 30 Hz."""
    fps = VOEGELE2014.working_fps
    graph = neighbor_graph(
        compute_motion_features(motion, VOEGELE2014),
        radius=VOEGELE2014.radius,
        max_lag=round(SLOT_S * fps),
    )
    gap = round(INTERMISSION_S * fps)
    return np.array([_returns(graph, frame, gap) for frame in range(len(graph))])


def plot_reoccurrence(recordings: Sequence[Recording], path: Path) -> Path:
    """Bars, one per recording, by share; lines at the share of all poses and as printed."""
    rows = sorted(recordings, key=lambda r: r.share)
    figure = new_figure(9.2, 3.0)
    axes = figure.subplots()
    axes.bar(range(len(rows)), [r.share for r in rows], 0.75, color=PALETTE[2])
    lines = {"all poses": (share_of_poses(rows), "-"), "as printed": (PUBLISHED, ":")}
    for name, (share, style) in lines.items():
        axes.axhline(share, color=INK, linestyle=style, linewidth=1.2, label=f"{name}: {share:.1%}")
    axes.set_xticks(range(len(rows)), [r.path.stem for r in rows], rotation=40, ha="right")
    axes.set_ylim(0, 1.25)
    axes.set_yticks(np.linspace(0, 1, 6))
    axes.legend(frameon=False, fontsize=8, loc="upper left", ncols=2)
    tidy(axes)
    heading(axes, "share of poses that come back within 10 s, recordings longer than 8 s")
    return save(figure, path)


def _returns(graph: NeighborGraph, frame: int, gap: int) -> bool:
    """Return whether more than ``gap`` consecutive frames are missing from a frame's neighbours."""
    indices = graph.indices[graph.indptr[frame] : graph.indptr[frame + 1]]
    return bool((np.diff(indices) > gap).any())


def _read(path: Path) -> Motion | None:
    from kineme.formats import read_motion

    try:
        return read_motion(path)
    except KinemeError:
        return None
