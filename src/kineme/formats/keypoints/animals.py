"""Read trackers of animals: SLEAP's analysis files and tables, and DeepLabCut's tables.

Their files have no frame rate: ``fps`` is required. ``person`` selects one of several animals.

*SLEAP*: analysis files in HDF5, but not its projects. ``tracks`` (tracks, 2, nodes, frames), or
(frames, tracks, nodes, 2) in newer files, are pixels; ``node_names``, ``track_names`` and
``point_scores`` accompany them. Nodes with a score below 0.2, SLEAP's limit for peaks, count as not
seen. Tables have ``track``, ``frame_idx``, ``instance.score`` and ``NODE.x NODE.y NODE.score``,
with a row for each animal in a frame.

*DeepLabCut*: tables below several rows of names: ``scorer``, ``individuals`` (if there are
several), ``bodyparts`` and ``coords`` (x, y, optionally z, likelihood). A row per frame follows.
Keypoints with a likelihood below 0.6, DeepLabCut's limit for plots, count as not seen.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from kineme._util.arrays import Floats
from kineme.formats.arrays.mat import SIGNATURE, collect_texts, parse_hdf5
from kineme.formats.delimited import DelimitedText, split_cells
from kineme.formats.dialects import Dialect
from kineme.formats.files import FileContent
from kineme.formats.keypoints.video import Person, to_frame_numbers, video_to_motion
from kineme.formats.options import ReadOptions, choose_person
from kineme.formats.points import columns_to_motion
from kineme.formats.registry import Format
from kineme.recordings import Motion

LEAST_SCORE, LEAST_LIKELIHOOD = 0.2, 0.6
"""Limits of SLEAP for peaks, and of DeepLabCut for plots."""


def read_sleap(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of one animal in SLEAP's analysis file."""
    variables = parse_hdf5(content)
    tracks, nodes = variables.get("tracks"), collect_texts(variables.get("node_names"))
    if not isinstance(tracks, np.ndarray) or tracks.ndim != 4 or not nodes:
        raise content.error(
            "is HDF5, but not an analysis file of SLEAP: no 'tracks' and 'node_names' "
            f"among {', '.join(list(variables)[:8]) or 'nothing'}; give an analysis file, "
            "or a CSV"
        )
    names = collect_texts(variables.get("track_names"))
    # Old files have tracks, axes, nodes, frames; new ones frames, tracks, nodes, axes.
    is_old = tracks.shape[1:3] == (2, len(nodes)) and len(names) in (0, tracks.shape[0])
    if not is_old and tracks.shape[2:] != (len(nodes), 2):
        raise content.error(
            f"tracks have shape {tracks.shape}, which does not fit {len(nodes)} nodes"
        )
    positions, confidence = _arrange(content, tracks, variables.get("point_scores"), old=is_old)
    if len(names) != len(positions):
        names = [str(i) for i in range(len(positions))]
    # Frames in which at least one node of the track was found.
    visible = np.any(np.isfinite(positions).all(axis=3), axis=2)
    people = [
        Person(frame, positions[track, frame], confidence[track, frame], names[track])
        for track, frame in np.argwhere(visible).tolist()
    ]
    frames = range(positions.shape[1])
    return video_to_motion(
        content, options, "SLEAP", nodes, people, limit=LEAST_SCORE, frames=frames
    )


def read_sleap_table(table: DelimitedText, options: ReadOptions) -> Motion:
    """Return the motion of one animal in SLEAP's table."""
    names, content = list(table.names), table.content
    nodes = [name[:-2] for name in names if name.endswith(".x") and f"{name[:-2]}.y" in names]
    if not nodes:
        raise content.error("no columns NODE.x and NODE.y found", table.head + 1)
    columns = [names.index(f"{node}.{axis}") for node in nodes for axis in "xy"]
    scores = [names.index(f"{node}.score") for node in nodes if f"{node}.score" in names]
    rows = table.numbers([names.index("frame_idx"), *columns, *scores])
    k = len(nodes)
    confidence = rows[:, 1 + 2 * k :] if len(scores) == k else np.ones((len(rows), k))
    points = rows[:, 1 : 1 + 2 * k].reshape(-1, k, 2)
    frames = to_frame_numbers(content, rows[:, 0]).tolist()
    tracks = table.texts(names.index("track")) if "track" in names else []
    has_tracks = any(tracks)
    people = [
        Person(frame, points[i], confidence[i], tracks[i] if has_tracks else None)
        for i, frame in enumerate(frames)
    ]
    start = [0] if 0 <= min(frames) < len(frames) else []  # include the start of the video
    return video_to_motion(
        content, options, "SLEAP", nodes, people, limit=LEAST_SCORE, frames=start
    )


def _arrange(content: FileContent, tracks: Any, scores: Any, *, old: bool) -> tuple[Floats, Floats]:
    """Return positions (tracks, frames, nodes, 2) and confidences (tracks, frames, nodes)."""
    if tracks.dtype.kind not in "iuf":
        raise content.error(f"tracks hold {tracks.dtype}, not numbers")
    positions = tracks.transpose((0, 3, 2, 1) if old else (1, 0, 2, 3))
    confidence = np.ones(positions.shape[:3])
    if isinstance(scores, np.ndarray) and scores.ndim == 3 and scores.dtype.kind in "iuf":
        confidences = scores.transpose((0, 2, 1) if old else (1, 0, 2))
        if confidences.shape == confidence.shape:
            confidence = np.where(np.isnan(confidences), 1.0, confidences)
    return np.asarray(positions, np.float64), confidence


def read_deeplabcut(table: DelimitedText, options: ReadOptions) -> Motion:
    """Return the motion of the keypoints of one individual."""
    content, line = table.content, table.head + 2
    labels: dict[str, list[str]] = {}
    for row in table.lines[table.head : table.head + 4]:
        kind, *cells = split_cells(row, table.separator)
        if kind.lower() in ("scorer", "individuals", "bodyparts", "coords"):
            labels[kind.lower()] = cells
    if not {"bodyparts", "coords"} <= labels.keys():
        raise content.error("rows 'bodyparts' and 'coords' expected under 'scorer'", line)
    parts, coords = labels["bodyparts"], labels["coords"]
    individuals = labels.get("individuals", [""] * len(parts))
    if len({len(parts), len(coords), len(individuals)}) > 1:
        raise content.error("the rows of names differ in length", line)
    unique_individuals = list(dict.fromkeys(individuals))
    individual = choose_person(content.path, unique_individuals, options.person, "individuals")
    names = ["frame", *(f"{part}_{coord}" for part, coord in zip(parts, coords, strict=True))]
    values = replace(table, names=names, first_row=table.head + len(labels)).numbers()[:, 1:]
    columns = {
        name: column
        for name, owner, column in zip(names[1:], individuals, values.T, strict=True)
        if owner == individual
    }
    motion = columns_to_motion(content, "DeepLabCut", columns, options, limit=LEAST_LIKELIHOOD)
    provenance = motion.provenance.of_person(individual, unique_individuals)
    return replace(motion, provenance=provenance)


FORMAT = Format("SLEAP", (".h5", ".hdf5"), lambda head: head.startswith(SIGNATURE), read_sleap)
DIALECTS = (
    Dialect(
        "DeepLabCut",
        lambda names, _: len(names) > 1 and names[0].lower() == "scorer",
        read_deeplabcut,
        channels=False,
        motion=True,
    ),
    Dialect(
        "SLEAP",
        lambda names, _: "frame_idx" in names and any(name.endswith(".score") for name in names),
        read_sleap_table,
        motion=True,
    ),
)
