"""SLEAP: its analysis files in HDF5, and why its own projects are not read.

``tracks`` (tracks, 2, nodes, frames), or (frames, tracks, nodes, 2) in newer files,
are pixels; ``node_names``, ``track_names`` and ``point_scores`` lie beside them. Nodes
less sure than 0.2, SLEAP's own limit for peaks, count as not seen. Of several
tracks ``person`` names one. There is no frame rate in the file: ``fps`` gives it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.formats.arrays.hdf5_file import SIGNATURE, parse_hdf5, texts
from kineme.formats.files import FileContent
from kineme.formats.keypoints.video import Person, Video, video_to_motion
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.tables.pose_tables import SLEAP_SURE
from kineme.recordings import Motion

Floats = NDArray[np.float64]


def read_sleap(content: FileContent, options: ReadOptions) -> Motion:
    """The motion of one animal in an analysis file of SLEAP's."""
    found = parse_hdf5(content)
    tracks, nodes = found.get("tracks"), texts(found.get("node_names"))
    if not isinstance(tracks, np.ndarray) or tracks.ndim != 4 or not nodes:
        raise content.error(
            f"is HDF5, but no analysis file of SLEAP: no 'tracks' and 'node_names' among "
            f"{', '.join(list(found)[:8]) or 'nothing'}; give an analysis file, or a CSV"
        )
    names = texts(found.get("track_names"))
    old = tracks.shape[1:3] == (2, len(nodes)) and len(names) in (0, tracks.shape[0])
    if not old and tracks.shape[2:] != (len(nodes), 2):
        raise content.error(f"tracks of shape {tracks.shape} do not go with {len(nodes)} nodes")
    positions, sure = _arranged(content, tracks, found.get("point_scores"), old=old)
    if len(names) != len(positions):
        names = [str(i) for i in range(len(positions))]
    seen = np.any(np.isfinite(positions).all(axis=3), axis=2)
    people = [
        Person(frame, positions[track, frame].tolist(), sure[track, frame].tolist(), names[track])
        for track, frame in np.argwhere(seen).tolist()
    ]
    frames = range(positions.shape[1])
    video = Video("SLEAP", nodes, people, SLEAP_SURE, frames=frames)
    return video_to_motion(content, video, options)


def _arranged(
    content: FileContent, tracks: Any, scores: Any, *, old: bool
) -> tuple[Floats, Floats]:
    """Positions (tracks, frames, nodes, 2) and how sure they are (tracks, frames, nodes)."""
    if tracks.dtype.kind not in "iuf":
        raise content.error(f"tracks hold {tracks.dtype}, not numbers")
    positions = tracks.transpose((0, 3, 2, 1) if old else (1, 0, 2, 3))
    sure = np.ones(positions.shape[:3])
    if isinstance(scores, np.ndarray) and scores.ndim == 3 and scores.dtype.kind in "iuf":
        given = scores.transpose((0, 2, 1) if old else (1, 0, 2))
        if given.shape == sure.shape:
            sure = np.where(np.isnan(given), 1.0, given)
    return np.asarray(positions, np.float64), sure


FORMAT = Format("SLEAP", (".h5", ".hdf5"), lambda head: head.startswith(SIGNATURE), read_sleap)
