"""Build libraries of given and of simulated recordings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from time import perf_counter

import numpy as np

from _options import choose_size, find_data
from kineme import Library, read
from kineme._version import __version__
from kineme.library.descriptions import make_analysis
from kineme.library.gathering import compile_tables
from kineme.library.storage.layout import ANALYSES, HEAD, SCHEMA, write_json
from kineme.library.storage.tables import (
    Analysis,
    has_analysis,
    write_analysis,
    write_index,
    write_tables,
)
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals
from kineme.transfer.clusters import CONSTANTS

SHAKEN = 0.05
"""Standard deviation of the noise added to the features of a copy."""
LASTS_S = choose_size(360.0, 60.0)
"""Duration of a simulated recording in seconds."""


def build_library(folder: Path, recordings: Iterable[tuple[str, Motion | Signals]]) -> Library:
    """Build a library of recordings, given by name."""
    (folder / ANALYSES).mkdir(parents=True, exist_ok=True)
    keys = {}
    for name, recording in recordings:
        keys[name] = f"{len(keys):032x}"
        if not has_analysis(folder / ANALYSES, keys[name]):
            write_analysis(
                folder / ANALYSES, keys[name], *make_analysis(recording, SegmentOptions())
            )
    write_tables_and_head(folder, keys)
    return Library(folder)


def write_tables_and_head(folder: Path, keys: Mapping[str, str]) -> float:
    """Write head and tables of a library; return the seconds that this takes."""
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


def simulate_library(folder: Path, hours: float) -> float:
    """Build a library of noisy pieces of subject 86; return the seconds of joining clusters."""
    (folder / ANALYSES).mkdir(parents=True)
    rng = np.random.default_rng(0)
    made = [
        make_analysis(read(path), SegmentOptions())
        for path in sorted(find_data("cmu86").glob("*.amc"))[: choose_size(None, 1)]
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
    return write_tables_and_head(folder, keys)
