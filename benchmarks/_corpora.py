"""All recordings of bodies at hand, by corpus, with what people say of them.

``hdm05``: 188 exercises of three actors, one label each. ``utkinect``: ten people before a Kinect,
labelled spans. ``cmu86``: five trials of one person, labelled throughout. ``others``: takes of
CMU, PyMO, aitviewer and OpenSim as AMC, BVH, C3D and TRC.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

import kineme
from _options import few, needed
from _recordings import ACTORS, by_recording, cuts_of_hdm05, subject_86
from kineme.features.canonical import matching
from kineme.recordings import Motion
from kineme.recordings.operations import resample

WALKS = ("02_01.amc", "02_01.bvh", "02_01.c3d", "PyMO_AV_8Walk.bvh", "subject01_walk.trc")
"""Takes of ``others`` in which people walk from beginning to end."""
OTHERS = (
    *(f"cmu_formats/{name}" for name in (*WALKS[:3], "49_02.amc", "49_02.bvh")),
    *(f"formats/{name}" for name in (*WALKS[3:], "aitviewer_sample.bvh")),
    "formats/cmu_131_01_bvh11.bvh",
)


@dataclass(frozen=True)
class Take:
    """A recording: what it is called, of whom it is, and labelled spans in seconds."""

    name: str
    person: str
    motion: Motion
    spans: tuple[tuple[float, float, str], ...] = ()


@cache
def corpora() -> dict[str, list[Take]]:
    """Every take of every corpus; some of each, where it shall be quick."""
    found = {"hdm05": hdm05(), "utkinect": utkinect(), "cmu86": cmu86(), "others": others()}
    return {name: list(takes) for name, takes in found.items()}


def hdm05() -> Iterator[Take]:
    for actor in ACTORS:
        for name, label, motion in cuts_of_hdm05(actor, every=few(1, 6)):
            yield Take(name, actor, motion, ((0.0, motion.duration, label),))


def utkinect() -> Iterator[Take]:
    folder = needed("sets/utkinect")
    rows = by_recording(folder / "labels.csv")
    for name in sorted(rows)[:: few(1, 5)]:
        motion = kineme.read(folder / "recordings" / f"{name}.parquet")
        spans = ((float(row["start_s"]), float(row["stop_s"]), row["label"]) for row in rows[name])
        yield Take(name, name.split("_")[0], motion, tuple(spans))


def cmu86() -> Iterator[Take]:
    for case in subject_86():
        marks = case.truth.at_means()
        borders = [border / marks.fps for border in marks.borders]
        spans = zip(borders[:-1], borders[1:], marks.labels, strict=True)
        yield Take(case.name, "86", case.motion, tuple(spans))


def others() -> Iterator[Take]:
    for path in OTHERS:
        name = path.rpartition("/")[2]
        yield Take(name, name.partition(".")[0], kineme.read(needed(path)))


def poses_of(take: Take) -> NDArray[np.float64]:
    """The stacked poses of a take, 15 a second."""
    motion = resample(take.motion, matching.POSE_FPS)
    return matching.stack_poses(matching.compute_poses(motion))
