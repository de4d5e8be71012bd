"""Libraries of recordings in hand, and of simulated ones, for the benchmarks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from time import perf_counter

import numpy as np

from _options import few, needed
from kineme import Library, read
from kineme._version import __version__
from kineme.library.compiling import compile_tables
from kineme.library.descriptions import make_analysis
from kineme.library.storage.analyses import Analysis, has_analysis, write_analysis
from kineme.library.storage.index import write_index
from kineme.library.storage.layout import ANALYSES, HEAD, SCHEMA, write_json
from kineme.library.storage.tables import write_tables
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals
from kineme.transfer.clusters import CONSTANTS

SHAKEN = 0.05
"""Deviation of what is added to each feature of a copy."""
LASTS_S = few(360.0, 60.0)
"""Of a simulated recording, seconds."""


def library_of(folder: Path, recordings: Iterable[tuple[str, Motion | Signals]]) -> Library:
    """A library of recordings in hand, by their names."""
    (folder / ANALYSES).mkdir(parents=True, exist_ok=True)
    keys = {}
    for name, recording in recordings:
        keys[name] = f"{len(keys):032x}"
        if not has_analysis(folder / ANALYSES, keys[name]):
            write_analysis(
                folder / ANALYSES, keys[name], *make_analysis(recording, SegmentOptions())
            )
    joined(folder, keys)
    return Library(folder)


def joined(folder: Path, keys: Mapping[str, str]) -> float:
    """Leave head and tables of pieces by the names of their recordings; seconds that it took."""
    start = perf_counter()
    entries = [(name, folder / name, key) for name, key in sorted(keys.items())]
    tables, following = compile_tables(folder, entries, {}, 0, lambda _: None)
    head = {
        "schema": SCHEMA,
        "kineme": __version__,
        "read_options": {},
        "segment_options": {},
        "sources": [],
        "recursive": False,
        "clustering": asdict(CONSTANTS),
        "failed": {},
        "following": following,
        "tables": write_tables(folder, tables),
    }
    write_index(folder, head["tables"], tables["recordings"].to_pydict())
    write_json(folder / HEAD, head)
    return perf_counter() - start


def simulated(folder: Path, hours: float) -> float:
    """A library of shaken pieces of subject 86; seconds that joining its clusters took."""
    (folder / ANALYSES).mkdir(parents=True)
    rng = np.random.default_rng(0)
    made = [
        make_analysis(read(path), SegmentOptions())
        for path in sorted(needed("cmu86").glob("*.amc"))[: few(None, 1)]
    ]
    keys = {}
    for number in range(round(hours * 3600 / LASTS_S)):
        piece, own, _ = made[number % len(made)]
        n = round(LASTS_S * piece.facts["features_fps"])
        parts = [features for _, features, _ in made]
        whole = np.concatenate([own, *parts, *parts])[:n]
        shaken = whole + SHAKEN * rng.normal(size=whole.shape).astype(np.float32)
        shaken /= np.linalg.norm(shaken, axis=1, keepdims=True)
        frames = round(LASTS_S * piece.facts["fps"])
        facts = {**piece.facts, "n_frames": frames, "samples": n}
        key = keys[f"{number:05d}"] = f"{number:032x}"
        write_analysis(
            folder / ANALYSES, key, Analysis(facts, piece.table, piece.embeddings), shaken
        )
    return joined(folder, keys)
